// A signal without vehicles whose controller reacts to traffic: tests set its detectors. Without another name in the
// settings, the controller is `actuated`.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "signals/signal_controller.h"

namespace stopline {

inline constexpr double kStep_s = 0.1;
inline constexpr double kStopDetector_m = 3.0;  // the defaults of the controller
inline constexpr double kAdvanceDetector_m = 40.0;

// One signal with its state. Each group has a lane of its own unless `lanes` says otherwise.
class Junction {
public:
    Junction(SignalSettings settings, const std::vector<std::string>& movements,
             std::vector<std::uint64_t> lanes = {}) {
        if (settings.controller == "fixed_time") settings.controller = "actuated";
        const std::vector<SignalParameter> parameters = signal_parameters();
        for (std::size_t k = 0; k < parameters.size(); ++k) {
            if (std::string(parameters[k].name) == "stop_detector") settings.parameters[k] = kStopDetector_m;
            if (std::string(parameters[k].name) == "advance_detector") settings.parameters[k] = kAdvanceDetector_m;
        }
        plan_ = make_phase_signal_plan(settings, 0, movements, kStep_s, to_ticks(kDay_s, kStep_s));
        if (lanes.empty()) {
            for (std::size_t k = 0; k < movements.size(); ++k) lanes.push_back(std::uint64_t{1} << k);
        }
        state_.lights.assign(movements.size(), Light::red);
        state_.since_tick.assign(movements.size(), 0);
        state_.green_start_tick.assign(movements.size(), kNoGreen);
        state_.phase = {-1};
        state_.phase_start_tick = {-1};
        state_.memory = {std::vector<std::int64_t>(plan_.controller->memory_size(plan_))};
        state_.detectors.resize(1);
        for (const std::uint64_t groups : lanes) {
            for (const double to_line_m : {0.0, kStopDetector_m, kAdvanceDetector_m})
                state_.detectors[0].push_back({-1, 0, groups, to_line_m});
        }
        SignalView view(plan_, 0, 0, state_);
        next_tick_ = plan_.controller->init(view);
    }

    // The two detectors of a lane that the controller uses.
    SignalDetector& stop_detector(std::size_t lane) { return state_.detectors[0][3 * lane + 1]; }
    SignalDetector& advance_detector(std::size_t lane) { return state_.detectors[0][3 * lane + 2]; }
    const std::vector<SignalDetector>& detectors() const { return state_.detectors[0]; }
    std::size_t lanes() const { return state_.detectors[0].size() / 3; }

    // Goes on by one tick. The test has set the detectors of the present tick.
    void step() {
        ++tick_;
        if (tick_ < next_tick_) return;
        SignalView view(plan_, 0, tick_, state_);
        next_tick_ = plan_.controller->step(view);
    }
    void occupy(SignalDetector& detector, bool is_occupied) const {
        detector.is_occupied = is_occupied;
        if (is_occupied) detector.last_occupied_tick = tick_ + 1;
    }
    void cross(SignalDetector& detector) const {
        detector.last_crossing_tick = detector.last_occupied_tick = tick_ + 1;
    }

    // The green that the controller announces at the present tick.
    GreenWindow next_green(int group) {
        const SignalView view(plan_, 0, tick_, state_);
        return plan_.controller->next_green(view, group, tick_);
    }

    std::int64_t tick() const { return tick_; }
    const SignalState& state() const { return state_; }
    const PhasePlan& phases() const { return plan_.phases; }
    int phase() const { return state_.phase[0]; }  // controllers with rings: index of a pair
    Light light(std::size_t group) const { return state_.lights[group]; }

private:
    SignalPlan plan_;
    SignalState state_;
    std::int64_t tick_ = 0;
    std::int64_t next_tick_ = 0;
};

inline PhaseSettings phase_of(std::vector<std::string> movements, double min_green_s, double max_green_s,
                              const std::string& recall = "off") {
    PhaseSettings phase;
    phase.protected_movements = std::move(movements);
    phase.green_s = max_green_s;
    phase.min_green_s = min_green_s;
    phase.gap_s = 3.0;
    phase.yellow_s = 3.0;
    phase.all_red_s = 2.0;
    phase.recall = recall;
    return phase;
}

inline const std::vector<std::string> kMovements{"west_straight",  "west_left",  "east_straight",  "east_left",
                                                 "south_straight", "south_left", "north_straight", "north_left"};

using Random = std::mt19937_64;

inline double uniform(Random& random, double min, double max) {
    return min + (max - min) * static_cast<double>(random() >> 11) * 0x1p-53;
}

}  // namespace stopline
