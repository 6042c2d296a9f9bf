// Finds the leader of a vehicle beyond the end of its lane.
#pragma once

#include "base/containers/index.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// The leader that an observer finds beyond the end of its lane.
struct LeaderAhead {
    int slot = -1;              // slot of the leader; -1: none within the range
    double lane_start_m = 0.0;  // start of the leader's lane, from the start of the observer's lane
};

// Returns the position of the rear of a leader beyond the lane, m from the start of the observer's lane. Precondition:
// there is a leader.
inline double rear_m(const State& state, const LeaderAhead& leader) {
    const VehicleArrays& v = state.vehicles;
    return leader.lane_start_m + v.position_m[at(leader.slot)] - static_cast<double>(v.length_m[at(leader.slot)]);
}

// The position of a vehicle on its route and on its trip. With a trip, the search for the leader continues beyond the
// end of the route, on the later edges of the trip.
struct RoutePosition {
    int route = -1;  // -1: not known, or the vehicle must change lanes
    int route_index = 0;
    int trip = -1;  // -1: no trip
    int trip_edge = 0;
};

// Returns the leader of the vehicle in `slot` beyond the end of `lane`, within `range_m`: the nearest vehicle on the
// route or trip of the vehicle in `slot`, or a nearer vehicle that diverges from this route. The vehicle in `slot` must
// be the first vehicle of the lane.
LeaderAhead leader_ahead(const State& state, int lane, int slot, double range_m);

// Does the same for any observer with its front at `position_m` on `lane`, for example a vehicle that is not inserted
// yet. Ignores the vehicles on `lane` itself. An observer without a route has only a vehicle in the diverge area of
// `lane` as leader.
LeaderAhead leader_ahead(const State& state, int lane, double position_m, const RoutePosition& position,
                         double range_m);

// Returns the nearest vehicle beyond the end of `lane` on the route of the vehicle in `slot`, within `range_m`. Ignores
// vehicles on lanes outside this route, for example vehicles that diverge from it.
LeaderAhead last_vehicle_on_route(const State& state, int lane, int slot, double range_m);

// Returns the vehicle just downstream of the end of `lane` whose rear is furthest upstream, among the vehicles that are
// not clear of `connection`. `connection` begins on `lane`.
LeaderAhead diverging_vehicle(const State& state, int lane, int connection);

// Returns true if the rear of the vehicle in slot `ahead` is still on a lane that merges into the route of the vehicle
// in `slot`. Right of way then prevents contact with this rear, so the vehicle in `slot` need not keep a gap to it.
bool rear_is_on_merging_path(const State& state, int lane, int slot, int ahead);

// Finds the leader of the first vehicle of each lane in Partition::awake (occupied lanes, except those whose first
// vehicle rests at a red signal). Searches all occupied lanes in steps that decide about platoons (platoon_interval.h)
// and in runs with human drivers. Copies this leader to the lane's sentinel slot, the slot before the first vehicle. If
// the leader has changed, makes the first vehicle a platoon leader and resets its radar history. In full dynamics, also
// adds the braking demands due to hidden leaders (hidden_leaders.h).
void find_leaders_beyond_lanes(const Model& model, const State& state, VehicleArrays& vehicles, Partition& part);

}  // namespace stopline
