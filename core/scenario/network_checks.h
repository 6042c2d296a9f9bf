// Checks that a network is large enough for its traffic and its measurements. Each check compares several parts of a
// scenario.
#pragma once

#include "scenario/scenario.h"
#include "scenario/schema/report.h"

namespace stopline {

// Checks that the queue before a single stop line (network.kind `approach`, demand.vehicles in each lane) fits between
// the entry and the stop line.
void check_queue(const Scenario& scenario, Checker& check);
// Checks that the road between two intersections of a grid has room for a vehicle and is long enough for a vehicle to
// stop.
void check_grid_links(const Scenario& scenario, Checker& check);
// Checks the same for streets.
void check_street_links(const Scenario& scenario, Checker& check);
// Checks that each turn pocket has room for a vehicle.
void check_pockets(const Scenario& scenario, Checker& check);
// Checks that a vehicle that enters the network can stop before the stop line of its entry lane.
void check_entries(const Scenario& scenario, Checker& check);
// Checks that a vehicle that waits at its stop line covers the detector that calls its phase. Otherwise the
// waiting vehicle calls no green until another vehicle reaches the detector.
void check_stop_detector(const Scenario& scenario, Checker& check);
// Checks that each name in demand.approaches belongs to an approach of the network.
void check_approaches(const Scenario& scenario, Checker& check);
// Checks that the measured area of a grid or of streets lies inside the network.
void check_measured_area(const Scenario& scenario, Checker& check);

// Checks that the lane of each induction loop (measure.loops) exists and is long enough.
void check_loops(const Scenario& scenario, Checker& check);

// Returns the number of whole signal cycles of a single intersection from the end of the warm-up to the end of the run.
int cycles_within_duration(const Scenario& scenario);

}  // namespace stopline
