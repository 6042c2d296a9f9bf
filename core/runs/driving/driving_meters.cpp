#include "runs/driving/driving_meters.h"

namespace stopline {

DrivingMeters::DrivingMeters(const Scenario& scenario, std::size_t population, const Model& model) {
    if (scenario.measure.energy == "on") energy_ = std::make_unique<EnergyMeter>(scenario, population, model);
    if (scenario.measure.surrogate_safety == "on") safety_ = std::make_unique<SafetyMeter>(model);
}

DrivingResults DrivingMeters::finish(const State& state, const std::optional<TimeWindow>& window) const {
    DrivingResults results;
    if (energy_) results.energy = energy_->finish(state, window);
    if (safety_) results.safety = safety_->result();
    return results;
}

}  // namespace stopline
