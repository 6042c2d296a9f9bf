// The phases of a step (see simulation.h) that are not kernels. Each takes the model and the state and is called once a step.
#pragma once

#include <cstdint>
#include <span>

#include "sim/model.h"
#include "sim/state.h"

namespace stopline {

void read_signals(const Model& model, State& state);
void find_occupied_lanes(const Model& model, State& state);
void find_insiders(const Model& model, State& state);
void decide_stops(const Model& model, State& state);
void give_way(const Model& model, State& state);  // after find_insiders
void look_beyond_lanes(const Model& model, State& state);
void watch_hindrance(const Model& model, State& state);  // hindrance.h
void move_blocked_on(const Model& model, State& state);
void watch_detectors(const Model& model, State& state);
void transfer_vehicles(const Model& model, State& state);
void form_queues(const Model& model, State& state);  // before the first step
void insert_vehicles(const Model& model, State& state);
void verify(State& state);

// Fronts that are beyond the rear of their predecessor on the same lane.
std::int64_t overlaps(const VehicleArrays& vehicles, std::span<const LaneStep> lanes);

// What the kernels need of a lane in this step.
LaneStep lane_step(const Model& model, const State& state, int lane);

// When the front passed `line_m` within the last step.
double passing_time_s(const Model& model, const State& state, int slot, double line_m);

// Appends a free slot at the back of a lane, moving its vehicles up where the block's end is reached. Returns the slot.
int append_slot(State& state, int lane);

// Takes the first vehicle off a lane.
void remove_first(State& state, int lane);

// Gives a vehicle its place in its route.
void put_on_route(const Model& model, VehicleArrays& vehicles, int slot, int route_index);

// On a link the vehicle gets its next route.
void choose_way_on(const Model& model, State& state, int lane, int slot);

// The vehicle ahead of the first one on a lane, along its route: distance in front of the lane's start, and its slot.
struct Ahead {
    int slot = -1;         // -1: none within the range
    double start_m = 0.0;  // start of its lane, measured from the start of the asking vehicle's lane
};
Ahead vehicle_ahead(const Model& model, const State& state, int lane, int slot, double range_m);

}  // namespace stopline
