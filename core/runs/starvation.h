// The table of starving movements. A movement starves if the first vehicle of its queue waits for too long, although no
// queue or vehicle ahead blocks its way (Starvation in sim/state/delay_log.h).
#pragma once

#include <string>
#include <vector>

#include "sim/state/delay_log.h"
#include "sim/state/queries/vehicle_names.h"

namespace stopline {

// The starving movements of one population.
struct PopulationStarvations {
    std::string population;
    std::vector<Starvation> starvations;
    VehicleNames vehicle_names = {};
};

// Returns starvations.csv as CSV text. `lanes`: [lane] name of the lane.
std::string starvations_csv(const std::vector<PopulationStarvations>& populations,
                            const std::vector<std::string>& lanes);

}  // namespace stopline
