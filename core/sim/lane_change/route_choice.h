// Chooses the routes of vehicles. A turn is drawn at random or given by a trip, and the route must fit the vehicle's
// lane.
#pragma once

#include <cstdint>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Sets the route index of a vehicle, its next lane and the speed limit at the end of its lane.
void set_route_index(const Model& model, State& state, int slot, int route_index);

// Returns the route of the k-th vehicle of an inlet, drawn at random. An inlet is a lane on which vehicles get a route.
// `chose_lane`: true if the vehicle has chosen this lane because of its turn. Other shares of the routes then apply
// (DemandPlan::Inlet::lane_shares).
int draw_route(const Model& model, State& state, int inlet, std::int64_t k, bool chose_lane);

// Draws the turns of a vehicle at the second and third intersection ahead, as far as they are not known yet. Sets the
// preferred lane for them. A turn stays Turn::none if there is no such intersection or if the driver does not look
// ahead. `chose_lane`: see draw_route().
void draw_later_turns(const Model& model, State& state, int lane, int slot, bool chose_lane);

// Returns the index in DemandPlan::path_routes of the route after the one at `index`; -1: the path ends there.
int next_in_path(const DemandPlan& demand, int index);

// Gives a vehicle that has reached the start of `lane` its next route. Does nothing if no route begins on this lane.
void choose_next_route(const Model& model, State& state, int lane, int slot);

// Replaces the vehicle's route by a route with the same turn that begins on `lane`. If there is no such route, the
// vehicle keeps its route but has no next lane, and must change lanes.
void adopt_lane_route(const Model& model, State& state, int lane, int slot);

// Gives a vehicle with a trip the route that begins on edge `trip_edge` of the trip. `lane`: the lane of the vehicle.
void enter_trip_edge(const Model& model, State& state, int lane, int slot, int trip_edge);

}  // namespace stopline
