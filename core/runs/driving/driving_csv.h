// Tables of energy, comfort and surrogate safety.
#pragma once

#include <string>
#include <vector>

#include "runs/driving/driving_results.h"
#include "sim/state/queries/vehicle_names.h"

namespace stopline {

struct PopulationDriving {
    std::string population;
    const DrivingResults& driving;
    VehicleNames vehicle_names = {};
};

// Returns the parts of a report that the tables of this folder need. `Result` has the members `population`,
// `driving` and `vehicle_names`.
template <class Result>
std::vector<PopulationDriving> driving_of(const std::vector<Result>& results) {
    std::vector<PopulationDriving> all;
    for (const Result& result : results) all.push_back({result.population, result.driving, result.vehicle_names});
    return all;
}

// Returns energy.csv as CSV text: one row for each vehicle. Empty without measure.energy.
std::string energy_csv(const std::vector<PopulationDriving>& populations);

// Returns safety_distributions.csv as CSV text: one row for each bin with samples. Empty without
// measure.surrogate_safety.
std::string safety_distributions_csv(const std::vector<PopulationDriving>& populations);

}  // namespace stopline
