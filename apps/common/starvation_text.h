// Starving movements as text for the terminal. A movement starves if the first vehicle of its queue is stopped for the
// time `measure.starvation` of the scenario, although no queue or vehicle ahead blocks this vehicle.
#pragma once

#include <string>
#include <vector>

#include "runs/starvation.h"
#include "scenario/scenario.h"

namespace stopline {

// Returns a text that lists the first starving movements of each population, or says that there are none. `lanes` holds
// the name of each lane. Returns "" if measure.starvation is 0.
std::string starvation_text(const Scenario& scenario, const std::vector<PopulationStarvations>& populations,
                            const std::vector<std::string>& lanes);

}  // namespace stopline
