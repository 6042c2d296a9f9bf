// The meters of a run that a scenario asks for: energy (measure.energy) and surrogate safety
// (measure.surrogate_safety). Without them, a step costs two comparisons.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "runs/driving/driving_results.h"
#include "runs/driving/energy_meter.h"
#include "runs/driving/safety_meter.h"

namespace stopline {

class DrivingMeters {
public:
    // The meters keep references to the model.
    DrivingMeters(const Scenario& scenario, std::size_t population, const Model& model);

    // Call before each step, and once after the last step.
    void observe(const State& state) {
        if (energy_) energy_->observe(state);
        if (safety_) safety_->observe(state);
    }
    // Returns the results. Means for vehicles cover those that leave the network in the window; without a window, all
    // vehicles.
    DrivingResults finish(const State& state, const std::optional<TimeWindow>& window) const;

private:
    // Null: the scenario does not ask for the meter.
    std::unique_ptr<EnergyMeter> energy_;
    std::unique_ptr<SafetyMeter> safety_;
};

}  // namespace stopline
