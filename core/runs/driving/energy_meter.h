// Measures the energy use of all vehicles of a run (measure.energy). The meter looks at the state between the steps and
// changes nothing. It sums vehicle by vehicle, in the order of time, so the number of threads does not matter.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runs/driving/energy_results.h"
#include "scenario/scenario.h"
#include "sim/state/state.h"

namespace stopline {

class EnergyMeter {
public:
    // The meter keeps a reference to the model.
    EnergyMeter(const Scenario& scenario, std::size_t population, const Model& model);

    // Call before each step, and once after the last step.
    void observe(const State& state);
    // Returns the results. The totals cover the vehicles that leave the network in the window; without a window, all
    // vehicles.
    EnergyResult finish(const State& state, const std::optional<TimeWindow>& window) const;

private:
    // A vehicle that is or was in the network.
    struct Track {
        VehicleEnergy sums;
        PowertrainReading reading;  // at `last_tick`
        double sine = 0.0;          // slope of the lane at `last_tick`
        std::int64_t entered_tick = -1;
        std::int64_t last_tick = -1;  // -1: never seen
        bool may_stop = true;         // the next standstill counts as a stop
    };

    void observe(const State& state, int lane, std::size_t slot);
    void add_step(Track& track, const PowertrainReading& now);
    void add_step_at_rest(Track& track, const PowertrainReading& now);

    const Model& model_;
    std::vector<EnergySettings> settings_;  // [policy]
    std::vector<EnergyUse> rest_use_;       // [policy] energy use of a step at rest
    std::vector<std::string> policy_names_;
    std::vector<Track> tracks_;  // [id]
    StepWork work_;
    std::int64_t tick_ = 0;
    std::int64_t interval_ticks_ = 1;
    std::vector<double> fuel_g_;     // [interval]
    std::vector<double> battery_J_;  // [interval]
};

}  // namespace stopline
