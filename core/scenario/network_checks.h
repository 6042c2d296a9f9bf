// Whether a network is large enough for what drives and is measured on it: checks across several parts of a scenario.
#pragma once

#include "scenario/report.h"
#include "scenario/scenario.h"

namespace stopline {

void check_queue(const Scenario& scenario, Checker& check);  // approach: it fits before the stop line
void check_grid_links(const Scenario& scenario,
                      Checker& check);  // grids: streets between two intersections are long enough
void check_pockets(const Scenario& scenario, Checker& check);        // streets: a vehicle fits into each
void check_entries(const Scenario& scenario, Checker& check);        // who enters can stop before the line
void check_arms(const Scenario& scenario, Checker& check);           // demand.arms: the network has them
void check_measured_area(const Scenario& scenario, Checker& check);  // grids and streets: it ends within the network

}  // namespace stopline
