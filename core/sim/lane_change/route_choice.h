// The routes of vehicles: turns drawn at random, turns of trips, and the route that fits the present lane.
#pragma once

#include <cstdint>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Sets the place of a vehicle on its route, its next lane and the speed limit at the end of its lane.
void set_route_index(State& state, int slot, int route_index);

// Returns the route of an inlet's k-th vehicle. `chose_lane`: the route must start on the inlet's lane.
int draw_route(const Model& model, State& state, int inlet, std::int64_t k, bool chose_lane);

// Draws the turn at the next intersection but one. `chose_lane`: see draw_route().
void draw_following_turn(const Model& model, State& state, int slot, bool chose_lane);

// Gives a vehicle that has reached the start of a link its next route.
void choose_next_route(const Model& model, State& state, int lane, int slot);

// Replaces the route by a route with the same turn from the vehicle's lane. Without one the vehicle keeps its route and
// has no next lane: it must change lanes.
void adopt_lane_route(const Model& model, State& state, int lane, int slot);

// Gives a vehicle on a trip the route of an edge of the trip.
void enter_trip_edge(const Model& model, State& state, int lane, int slot, int trip_edge);

}  // namespace stopline
