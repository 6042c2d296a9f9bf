// The user's settings of a signal: its controller, and the times of an initial red and of cycles of green, yellow and
// red. SI units.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace stopline {

inline constexpr std::size_t kMaxSignalParameters = 32;

// A phase of a signal: the movements with green, and its times. Movements are named by side and turn, such as
// west_left. A phase without movements is a pedestrian phase.
struct PhaseSettings {
    std::vector<std::string> protected_movements;   // green without conflicting traffic that has a protected green
    std::vector<std::string> permissive_movements;  // green that yields to conflicting traffic
    double green_s = 0.0;
    double yellow_s = 3.0;
    double all_red_s = 5.0;
    // For controllers that react to traffic:
    double min_green_s = 5.0;
    double max_green_s = 0.0;  // 0: the same as green_s
    double gap_s = 3.0;        // green ends when no detector of the phase has been occupied for this time
    // minimum: the phase is served in each cycle. maximum: it is served in each cycle for its maximum green.
    std::string recall = "off";  // off | minimum | maximum
    // For controllers with rings (signals/rings/ring_plan.h):
    int ring = 1;
    int barrier = 1;  // phases of both rings with the same number can run together
    // on: served without a call if the other ring has a call for the same barrier number.
    std::string dual_entry = "off";   // off | on
    std::string coordinated = "off";  // off | on

    bool is_coordinated() const { return coordinated == "on"; }
    double longest_green_s() const { return max_green_s > 0.0 ? max_green_s : green_s; }
    double total_s() const { return green_s + yellow_s + all_red_s; }
};

// A programme of phases that is in force from one time of day to the start of the next programme.
struct ProgrammeSettings {
    double from_s = 0.0;  // time of day
    std::vector<PhaseSettings> phases;

    double cycle_s() const {
        double sum_s = 0.0;
        for (const PhaseSettings& phase : phases) sum_s += phase.total_s();
        return sum_s;
    }
};

struct SignalSettings {
    std::string controller = "fixed_time";  // name of a SignalController
    double first_green_s = 120.0;           // start of the first green; until then the signal is red and a queue forms
    double green_s = 60.0;
    double yellow_s = 3.0;
    double all_red_s = 5.0;
    double cross_green_s = 0.0;  // green of the streets from south to north; 0: the same as green_s
    double offset_s = 0.0;       // grid: delay of the green, per column to the east and per row to the north
    // Network kind `approach`: 0: one green, then red until the end. Controllers with rings: background cycle of the
    // coordination; 0: no coordination. Other signals have no such setting.
    double cycle_s = 0.0;

    // The phases of each intersection. They replace green_s, yellow_s, all_red_s and cross_green_s. Either a single
    // programme (`phases`) or several by time of day (`programmes`), or neither.
    std::vector<PhaseSettings> phases;
    std::vector<ProgrammeSettings> programmes;
    double clock_s = 0.0;  // time of day at the start of the run

    // Parameters of controllers in SI units, in the order of signal_parameters() (signals/signal_controller.h).
    std::array<double, kMaxSignalParameters> parameters{};

    bool has_phases() const { return !phases.empty() || !programmes.empty(); }

    // The functions below are for intersections and grids without phases. Even signal groups serve the streets from
    // west to east, and odd signal groups serve the streets from south to north.
    double group_green_s(int group) const { return group % 2 == 1 && cross_green_s > 0.0 ? cross_green_s : green_s; }
    double stage_s(int group) const { return group_green_s(group) + yellow_s + all_red_s; }
    double intersection_cycle_s() const { return stage_s(0) + stage_s(1); }
};

}  // namespace stopline
