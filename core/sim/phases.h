// The phases of a step (see simulation.h) that are not kernels. Each takes the model and the state and is called once a step.
#pragma once

#include <cstdint>
#include <span>

#include "base/arithmetic.h"
#include "sim/full_dynamics.h"
#include "sim/model.h"
#include "sim/state.h"

namespace stopline {

// For each part by itself, in this order: what is decided and seen from the state at the beginning of the step.
// Mesoscale mode: brings into the cache what the next parts, up to `end`, need, a little each time (fetch.cpp).
void begin_to_fetch(State& state, std::size_t number, std::size_t end);
void fetch_more(const State& state, Fetching& fetching);
inline void fetch_on(const State& state, Fetching& fetching) {
    if (fetching.next != nullptr) fetch_more(state, fetching);
}
void list_lines(const Model& model, State& state, NetworkPart& part);  // what there is to fetch
void find_occupied_lanes(State& state, NetworkPart& part);
void look_beyond_lanes(const Model& model, State& state, NetworkPart& part);
void find_insiders(State& state, NetworkPart& part);
void decide_stops(const Model& model, State& state, NetworkPart& part);
void give_way(const Model& model, State& state, NetworkPart& part);
void count_conflicts(const Model& model, State& state, NetworkPart& part);  // the last part of give_way
void wait_to_change(const Model& model, State& state, NetworkPart& part);
void collect_moves(const Model& model, State& state,
                   NetworkPart& part);  // mesoscale mode: who has to be moved (meso_blocks.cpp)
// Then, when all parts are done: everybody moves.
void move_vehicles(const Model& model, const FullTables& tables, State& state, NetworkPart& part);
void watch_detectors(const Model& model, State& state, NetworkPart& part);

// For all parts together, before and after.
void read_signals(const Model& model, State& state);
// Hindrance (hindrance.h), in the steps in which it is looked for, before anybody moves: for all, for each part by itself, again for each
// part when all have been noted, for all.
bool looks_for_hindrance(const Model& model, const State& state);
void prepare_watch(const Model& model, State& state);
void note_standing(State& state, NetworkPart& part);
void find_waits(const Model& model, State& state, const NetworkPart& part);
void attribute_hindrance(const Model& model, State& state);
void watch_hindrance(const Model& model, State& state);  // all of it
void gather_reports(State& state);                       // what the parts have to tell
void transfer_vehicles(const Model& model, State& state);
void form_queues(const Model& model, State& state);  // before the first step
void insert_vehicles(const Model& model, State& state);
// Vehicles that have come by now, where they do at a rate or at times of their own, and found no room to enter yet.
std::int64_t waiting_outside(const Model& model, const State& state);
void insert_trips(const Model& model, State& state);  // trips.cpp
void move_blocked_on(const Model& model, State& state);
void change_lanes(const Model& model, State& state);
void verify(State& state);

// Whether a vehicle's trip ends on the edge that it is on; there it minds no stop line.
inline bool trip_ends(const State& state, int slot) {
    const auto i = static_cast<std::size_t>(slot);
    if (state.vehicles.next_lane[i] >= 0) return false;
    const VehicleRecord& record = state.vehicles.record[i];
    return record.trip >= 0 && state.plan.turn_of(record.route) == Turn::none;
}

// Fronts that are beyond the rear of their predecessor on the same lane.
std::int64_t overlaps(const VehicleArrays& vehicles, std::span<const LaneStep> lanes);

// Notes which, if it is the first of a run. For when there are any.
void see_overlap(const Model& model, const State& state, NetworkPart& part);

// A vehicle this near to a conflict area must know whether it can go on.
inline double decides_within_m(const Model& model, double speed_mps) {
    return 0.5 * square(speed_mps) / model.driver.stop.deceleration_mps2 + 1.5 * speed_mps + 3.0;
}

// Whether a vehicle leaves its lane: at its end, or at the stop line where its trip ends.
inline bool has_ended(const State& state, int lane, int slot) {
    const LanePlan& plan = state.plan.lane(lane);
    const double position_m = state.vehicles.position_m[static_cast<std::size_t>(slot)];
    if (position_m >= plan.length_m) return true;
    if (plan.signal_group < 0 || position_m < plan.stop_line_m) return false;
    return trip_ends(state, slot);
}

// When the front passed `line_m` within the last step.
double passing_time_s(const Model& model, const State& state, int slot, double line_m);
// Notes that a vehicle goes from one lane to another; -1: it comes from outside or leaves.
void note_passage(State& state, double time_s, int slot, int from, int to);

// Before the first step: where the vehicles of each lane are in memory.
void lay_out_blocks(const Model& model, State& state);

// Appends a slot at the back of a lane and returns it. Slots of all vehicles may change, but for those of lanes with room.
int append_slot(State& state, int lane);
// The same for a vehicle whose front is at `front_m`, between those that are there. It has not passed the detectors before that.
int insert_slot(const Model& model, State& state, int lane, double front_m);

// Slower than this a vehicle stands.
inline constexpr double kStands_mps = 0.1;

double shortest_vehicle_m(const Model& model);

// Before vehicles are put there: how many each lane is about to get, [lane].
void expect_vehicles(State& state, const std::vector<int>& expected);

// Makes sure that the next vehicle can be appended; slots of all vehicles may change. A lane that sleeps knows slots: it wakes up.
void make_room(State& state, int lane);
void make_room_in_limbo(State& state);

// Takes the first vehicle off a lane.
void remove_first(State& state, int lane);

// Moves the vehicle at place `from` of a lane, counted from its first, to place `place` of another one, its front at `front_m`. Slots of
// all vehicles may change. Returns its new slot.
int put_beside(const Model& model, State& state, int lane, int from, int other, int place, double front_m);

// A vehicle as it enters.
struct Entering {
    int lane = -1;
    double position_m = 0.0;
    double speed_mps = 0.0;
    double length_m = 0.0;
    int policy = 0;
    int route = -1;
    bool behind_last = true;  // of its lane, else anywhere on it
};
// Puts it on its lane, without a way on, and returns its slot.
int put_on_lane(const Model& model, State& state, const Entering& entering);
// When it has its way: what it sees, and that it came.
void begin_to_drive(const Model& model, State& state, int lane, int slot);
// What a vehicle sees whose predecessor is another one now.
void follow_anew(State& state, int slot, const LaneBlock& block);

// Takes the first vehicle of a lane out, to be put back behind the intersection; false: that is not possible.
bool take_out(const Model& model, State& state, int lane);
// Whether a vehicle on its way to the lane could not stop behind one that is put there, its rear at `rear_m` from the start.
bool somebody_comes(const Model& model, const State& state, int lane, double rear_m = 0.0);

// A vehicle on a trip comes to the leg-th edge of it, on one of its lanes.
void follow_trip(const Model& model, State& state, int lane, int slot, int leg);
// Notes that a trip begins or ends there.
void note_trip(State& state, int detector, int slot, double time_s);

// Gives a vehicle its place in its route.
void put_on_route(State& state, int slot, int route_index);

// The way of an inlet's k-th vehicle. `chose_lane`: it is on a lane from which it gets there.
int draw_route(const Model& model, State& state, int inlet, std::int64_t k, bool chose_lane);
// Where it will turn at the next intersection but one, drawn as if it were there.
void look_ahead(const Model& model, State& state, int slot, bool chose_lane);

// On a link the vehicle gets its next route.
void choose_way_on(const Model& model, State& state, int lane, int slot);

// On a lane of an approach the vehicle takes the lane's own route with the turn of the one that it has; where there is none it
// keeps that, to know where it wants to go, and has no next lane.
void take_way_of_lane(const Model& model, State& state, int lane, int slot);

// The vehicle ahead of the first one on a lane, along its route: distance in front of the lane's start, and its slot.
struct Ahead {
    int slot = -1;         // -1: none within the range
    double start_m = 0.0;  // start of its lane, measured from the start of the asking vehicle's lane
};
Ahead vehicle_ahead(const State& state, int lane, int slot, double range_m);
// The same as it would be from a place on a lane, the index-th of a route.
Ahead vehicle_ahead(const State& state, int lane, double position_m, int route, int index, double range_m);
// The same beyond the route too, on the edges of a trip that follow; -1: there is no trip.
struct OnTrip {
    int route = -1;
    int route_index = 0;
    int trip = -1;
    int leg = 0;
};
Ahead vehicle_ahead(const State& state, int lane, double position_m, const OnTrip& on_trip, double range_m);
// Full dynamics: who minds whom that it does not follow, on one lane. `hidden`: who is on the way of its first vehicle, behind one that goes
// another way; -1: nobody.
void look_past(const Model& model, const State& state, int lane, const Ahead& hidden, NetworkPart& part);
// The last vehicle on the lanes of its route beyond its own, whoever is beside them.
Ahead last_on_way(const State& state, int lane, int slot, double range_m);
// Whether the rear of the vehicle ahead is still on a way that joins that of this one further on. Whether they touch before is a matter of
// conflict areas (right_of_way.cpp).
bool comes_by_another_way(const State& state, int lane, int slot, int ahead);

// The highest speed of a vehicle that is put on a lane from which it stops comfortably before the stop line; any, where there is none ahead.
double stops_from_mps(const Model& model, int lane, double front_m);

// The net gap that a vehicle with this policy keeps at a speed.
double desired_gap_m(const Model& model, int policy, double speed_mps);

}  // namespace stopline
