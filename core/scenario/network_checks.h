// Checks that a network is large enough for its traffic and its measurements. Each check compares several parts of a
// scenario.
#pragma once

#include "scenario/scenario.h"
#include "scenario/schema/report.h"

namespace stopline {

// Checks that the queue of a single light fits between the entry and the stop line.
void check_queue(const Scenario& scenario, Checker& check);
// Checks that the streets between the intersections of a grid are long enough for a vehicle and for stopping.
void check_grid_links(const Scenario& scenario, Checker& check);
// Checks that a vehicle fits into each turning pocket.
void check_pockets(const Scenario& scenario, Checker& check);
// Checks that a vehicle can stop between the entry and the stop line.
void check_entries(const Scenario& scenario, Checker& check);
// Checks that the network has the approaches of demand.approaches.
void check_approaches(const Scenario& scenario, Checker& check);
// Checks that the measured area of a grid or of streets lies inside the network.
void check_measured_area(const Scenario& scenario, Checker& check);

}  // namespace stopline
