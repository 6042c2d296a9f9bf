// The constant data of the signals of a network: one SignalPlan for each intersection.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "signals/programme.h"
#include "signals/signal_phases.h"
#include "signals/signal_settings.h"

namespace stopline {

struct SignalController;  // signals/signal_controller.h

// A detector that an imported programme gives for a lane and some phases. It takes the place of the detectors that the
// parameters of a controller describe.
struct LaneDetector {
    int lane = -1;             // lane of the graph
    double to_line_m = 0.0;    // distance from the upstream end of the detector to the stop line
    double length_m = 0.0;     // length of the detection zone
    std::uint64_t phases = 0;  // phases that the detector calls and extends; bit k: phase k
};

// The signal of one intersection. The groups of a signal are numbered from 0. SignalPlan::groups maps these numbers to
// the signal groups of the lane graph.
struct SignalPlan {
    const SignalController* controller = nullptr;
    std::vector<int> groups;
    // [group of the signal] The fixed-time programme of the settings. The controller `fixed_time` follows it. Other
    // controllers may use its times.
    std::vector<GroupProgramme> programmes;
    SignalSettings settings;     // as in the scenario; not used by `fixed_time`
    std::vector<double> values;  // parameters in the order of SignalController::parameters, SI units
    double step_s = 0.0;
    std::vector<LaneDetector> lane_detectors;  // empty: SignalController::detectors_m says where the detectors are
    PhasePlan phases;                          // empty: the signal has no phases
    Timeline<int> phase_at;                // phase of the fixed-time programme, see PhaseTimelines; empty: no phases
    std::int64_t nominal_cycle_ticks = 0;  // cycle for measures and rules that need one; see NominalCycle
};

// All signals of a network. Every signal group belongs to one signal.
class SignalPlans {
public:
    void add(SignalPlan plan);

    std::size_t size() const { return plans_.size(); }
    const SignalPlan& operator[](std::size_t signal) const { return plans_[signal]; }
    auto begin() const { return plans_.begin(); }
    auto end() const { return plans_.end(); }

    // Returns the highest signal group that has a signal, plus one. Signal groups are those of the lane graph.
    // `is_complete()` is false if a lower group has no signal.
    int groups() const { return static_cast<int>(places_.size()); }
    bool is_complete() const;
    // The signal to which a signal group belongs, and the number of the group within this signal.
    struct Place {
        std::size_t signal = 0;
        std::size_t index = 0;
        bool is_known = false;
    };
    const Place& place_of(int group) const { return places_[static_cast<std::size_t>(group)]; }
    const SignalPlan& plan_of(int group) const { return plans_[place_of(group).signal]; }
    // Returns the fixed-time programme of the settings for a signal group.
    const GroupProgramme& programme(int group) const {
        return plan_of(group).programmes[places_[static_cast<std::size_t>(group)].index];
    }
    // Returns true if the light of a signal group is always the same. In imported networks, the lanes without a signal
    // belong to a group with constant green.
    bool never_changes(int group) const;

private:
    std::vector<SignalPlan> plans_;
    std::vector<Place> places_;  // [signal group of the lane graph]
};

// Makes the plan of a signal with the controller `fixed_time`. The programme k belongs to the group `first_group` + k.
SignalPlan fixed_time_plan(int first_group, std::vector<GroupProgramme> programmes);
// As above, for any groups. `groups` and `programmes` have the same size.
SignalPlan fixed_time_plan(std::vector<int> groups, std::vector<GroupProgramme> programmes);

// Makes the plan of a signal with the controller that the settings name. Throws InputError for an unknown name.
SignalPlan make_signal_plan(const SignalSettings& settings, int first_group, std::vector<GroupProgramme> programmes,
                            double step_s);

// As above, for a signal with phases. `movements`: the name of a movement of each group. `end_tick`: end of the run.
SignalPlan make_phase_signal_plan(const SignalSettings& settings, int first_group,
                                  std::span<const std::string> movements, double step_s, std::int64_t end_tick);

}  // namespace stopline
