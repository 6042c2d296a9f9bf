// Finds the leader of a vehicle beyond the end of its lane.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// A vehicle found ahead.
struct LeaderAhead {
    int slot = -1;              // -1: none within the range
    double lane_start_m = 0.0;  // start of its lane, from the start of the observer's lane
};

// A place on the route of a vehicle. With a trip, the search continues on the edges after the route.
struct RoutePosition {
    int route = -1;
    int route_index = 0;
    int trip = -1;  // -1: none
    int trip_edge = 0;
};

// Return the nearest vehicle beyond the end of a lane, for the first vehicle of the lane, or for a front at
// `position_m`.
LeaderAhead leader_ahead(const State& state, int lane, int slot, double range_m);
LeaderAhead leader_ahead(const State& state, int lane, double position_m, int route, int route_index, double range_m);
LeaderAhead leader_ahead(const State& state, int lane, double position_m, const RoutePosition& position,
                         double range_m);

// Returns the last vehicle on the lanes of the route beyond the vehicle's own lane. Ignores vehicles on other lanes.
LeaderAhead last_vehicle_on_route(const State& state, int lane, int slot, double range_m);

// Returns true if the rear of the vehicle in slot `ahead` is still on a path that merges with the own route further on.
// Until then contact is prevented by right of way, not by following.
bool rear_is_on_merging_path(const State& state, int lane, int slot, int ahead);

// Copies the leader beyond each awake lane to the lane's sentinel slot. Resets the sensors of a first vehicle whose
// leader has changed.
void find_leaders_beyond_lanes(const Model& model, const State& state, VehicleArrays& vehicles, Partition& part);

}  // namespace stopline
