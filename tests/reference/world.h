// The data of the reference engine. The reference engine computes the same model as core/sim, but is written for
// clarity. A vehicle is a struct, a lane is a list of vehicles, and all numbers are doubles. Every vehicle is computed
// in every step. The engine calls no function of core/sim, core/driver/krauss.h, core/driver/acceleration_laws.h,
// core/driver/human.h, core/driver/idm.h or core/vehicle/powertrain_step.h. It reads the settings of the scenario and
// the constant data of the Model: lane graph, signal programmes, demand and rules. It draws the same random numbers as
// core/sim.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

#include "base/random.h"
#include "base/speed_thresholds.h"
#include "network/lane_graph.h"
#include "scenario/scenario.h"
#include "spacing_laws/gap_policy.h"

namespace stopline::reference_engine {

// Gap of a vehicle without leader. It is so long that no law limits the speed because of it.
inline constexpr double kNoLeaderGap_m = 1e6;

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// Returns a value rounded to float, as core/sim stores some values of the mesoscale mode. The reference engine rounds
// the same values, because the mesoscale mode amplifies rounding errors: at a low speed v, one metre of gap changes the
// safe speed by b / v (b: deceleration of the Krauss model), in every step of a stop-and-go wave. All other values are
// double.
inline double stored(double value) { return static_cast<double>(static_cast<float>(value)); }

// A measurement of the radar: the net gap, the own speed minus the speed of the leader, and the own speed.
struct RadarSample {
    double gap_m = kNoLeaderGap_m;
    double closing_mps = 0.0;
    double own_mps = 0.0;
};

// A V2V message to the follower.
struct Message {
    double acceleration_mps2 = 0.0;
    double request_mps2 = 0.0;
    double rate_1ps = 1.0;  // 1 / lag of the sender
};

// Why a vehicle waits before a conflict area, at a stop line or beside another lane.
enum class WaitReason { priority, occupied, intruder, merging, stop_sign, lane_change, deadlock };

struct Vehicle {
    int id = -1;
    int policy = 0;  // also the index of its VehicleKind
    double length_m = 0.0;
    int lane = -1;            // set at the start of each step
    std::size_t index = 0;    // in Lane::vehicles, set at the start of each step
    double position_m = 0.0;  // front, from the start of the lane
    double speed_mps = 0.0;
    double acceleration_mps2 = 0.0;  // in the previous step
    bool is_platoon_leader = true;
    int leader_id = -1;        // the vehicle that this vehicle follows; -1: none
    bool lost_leader = false;  // the leader has just changed lanes or has been left by a lane change

    // Route.
    int route = -1;
    int route_index = 0;               // of the present lane
    int next_lane = -1;                // -1: the vehicle leaves the network, or the lane does not allow its turn
    int previous_lane = -1;            // -1: none
    int second_previous_lane = -1;     // -1: none
    double end_speed_mps = kNoLimit;   // highest speed at the end of the lane, if lower than the limit of the lane
    Turn following_turn = Turn::none;  // at the second intersection ahead
    Turn third_turn = Turn::none;      // at the third intersection ahead
    int trip = -1;                     // -1: the turns are drawn
    int trip_edge = 0;                 // present edge of the trip
    int preferred_offset = 0;          // lanes to the lane that suits the later turns; below 0: to the left
    bool preferred_for_third = false;  // only third_turn is the reason for preferred_offset

    // Intersection.
    std::int64_t entry_tick = 0;    // step in which the vehicle passed a stop line
    std::int64_t yield_tick = -2;   // latest step in which the vehicle had to wait
    double yield_position_m = 0.0;  // position of that wait, from the start of the connection
    WaitReason yield_reason = WaitReason::priority;
    std::int64_t wait_since_tick = 0;  // step in which that wait began
    std::int64_t line_stop_tick = -1;  // step in which the vehicle stopped for a stop sign; -1: not yet
    int accepted_gap_on = -1;          // connection on which the vehicle has accepted a gap; -1: none

    // Lane changes.
    std::int64_t change_tick = -1'000'000;  // step of the latest lane change
    // Steps in which the vehicle, almost at rest, latest let in another vehicle that had to change lanes for its route.
    std::int64_t let_in_waiting_tick = -1'000'000;  // a vehicle that had waited at its waiting position
    std::int64_t let_in_tick = -1'000'000;          // any other vehicle
    double remembered_mps = 0.0;                    // highest recent speed
    double left_gain_mps = 0.0;                     // speed that the left lane would have gained
    double right_gain_mps = 0.0;

    // Human drivers only.
    int start_steps = 1 << 28;    // steps since the vehicle ahead began to move
    bool waits_to_start = false;  // the vehicle ahead has started, but the reaction time has not passed

    // Mesoscale mode only.
    bool is_in_queue = false;        // member of the standing queue of its lane
    bool has_start_message = false;  // received a start message in this step
    int platoon_place = -1;          // number of vehicles ahead in the platoon; -1: not yet known, or no platoon
    int platoon_leader_id = -1;      // the leader when the place was last decided
    bool leads_mini_platoon = false;
    double platoon_time_gap_s = 0.0;
    double platoon_time_gap_rate = 0.0;

    // Full dynamics only.
    double request_mps2 = 0.0;
    double torque_Nm = 0.0;
    double brake_N = 0.0;
    double gear_time_s = 0.0;  // time since the last gear change
    double lag_s = 1.0;
    int gear = 0;
    std::deque<RadarSample> radar;  // the newest sample first
    std::deque<Message> sent;       // the newest message first

    bool is_at_rest() const { return speed_mps == 0.0 && acceleration_mps2 == 0.0; }
    bool is_slow() const { return speed_mps < kCrawlingSpeed_mps; }
    double rear_m() const { return position_m - length_m; }
};

// The leader of a vehicle at the start of a step, before sensor delays.
struct Leader {
    int id = -1;  // -1: there is no leader
    double gap_m = kNoLeaderGap_m;
    double speed_mps = 0.0;
    double acceleration_mps2 = 0.0;
    const Vehicle* vehicle = nullptr;
};

// A position where a vehicle must stop.
struct YieldStop {
    std::size_t index = 0;    // the vehicle, as an index in Lane::vehicles
    double position_m = 0.0;  // from the start of the lane
    int blocker_id = -1;      // the vehicle that goes first; -1: none
    WaitReason reason = WaitReason::lane_change;
};

// A vehicle that adapts its speed to a gap in the adjacent lane.
struct Alignment {
    std::size_t index = 0;
    double target_mps = 0.0;
};

// A lane of the lane graph, with its vehicles.
struct Lane : stopline::Lane {
    int number = -1;
    int exit = -1;              // connection: its exit lane
    double next_limit_m = 0.0;  // position from which the speed limit of the next lane applies
    double entry_mps = 0.0;     // highest speed at the start of the lane that allows braking to all limits ahead
    double sine = 0.0;          // sine of the slope angle
    double first_conflict_m = 1e9;
    bool yields = false;  // connection: must yield in some conflict area, at least in some signal phase
    bool has_movement_signals = false;
    int index = 0;                    // in its approach, from the left
    std::vector<Conflict> conflicts;  // connection: its conflict areas, in driving order
    std::deque<Vehicle> vehicles;     // the vehicle furthest downstream first

    // Decisions of the present step.
    int stopping_id = -1;                // the vehicle that stops at the line for the signal; -1: none
    std::ptrdiff_t stop_index = -1;      // the vehicle that stops at the line, as an index in `vehicles`; -1: none
    int stop_id = -1;                    // the same vehicle by its id, kept until the next decision on this lane
    bool is_held = false;                // the keep-clear rule is the reason for stop_index
    std::vector<YieldStop> yield_stops;  // in the order of the vehicles
    std::vector<Alignment> alignments;

    // Mesoscale mode: tick at which the standing queue was disturbed for the last time (queue.h).
    std::int64_t disturbed_tick = -1;

    bool is_connection() const { return origin >= 0; }
    // Returns the vehicle furthest upstream that stops at the line or at a yield stop, as an index; -1: none.
    std::ptrdiff_t last_stop_index() const {
        const auto last = yield_stops.empty() ? -1 : static_cast<std::ptrdiff_t>(yield_stops.back().index);
        return std::max(stop_index, last);
    }
    // Adds a yield stop. Keeps only the stops of the first six vehicles, as core/sim does.
    void add_yield_stop(const YieldStop& stop) {
        constexpr std::size_t kCapacity = 6;
        const auto is_behind = [&](const YieldStop& other) { return other.index > stop.index; };
        yield_stops.insert(std::find_if(yield_stops.begin(), yield_stops.end(), is_behind), stop);
        if (yield_stops.size() > kCapacity) yield_stops.pop_back();
    }
};

// A vehicle has passed the end of a lane.
struct LanePassage {
    double time_s = 0.0;
    int vehicle = -1;
    int policy = 0;
    int from_lane = 0;
};

// Counts how often each situation has occurred. The tests assert that their scenarios cover the situations.
struct Situations {
    std::int64_t stopped_at_red = 0;  // vehicles that stopped at the line at red
    std::int64_t passed_at_yellow = 0;
    std::int64_t passed_at_red = 0;     // vehicles that could not stop
    std::int64_t became_follower = 0;   // platoon leaders that closed up to the vehicle ahead
    std::int64_t started_in_queue = 0;  // followers that started from standstill
    std::int64_t start_messages = 0;    // start messages received
    std::int64_t time_gap_steps = 0;    // vehicle steps in which the leader of a mini-platoon keeps a time gap
    std::int64_t entered_late = 0;      // vehicles that found no room when they were due
    std::int64_t exited = 0;
    std::int64_t held_at_green = 0;      // vehicle steps in which the keep-clear rule holds a vehicle
    std::int64_t deadlocks = 0;          // steps in which slow vehicles waited for each other in a cycle
    std::int64_t yielded = 0;            // vehicles that began to wait before a conflict area
    std::int64_t gaps_accepted = 0;      // vehicles that accepted a gap between vehicles with priority
    std::int64_t gaps_refused = 0;       // vehicle steps in which a vehicle with priority arrives too soon
    std::int64_t merged = 0;             // vehicle steps in which a vehicle follows one that merges ahead of it
    std::int64_t stops_beyond_lane = 0;  // vehicle steps in which a vehicle must be able to stop beyond its lane
    std::int64_t stop_signs = 0;         // vehicles that stopped at a stop sign
    std::int64_t mandatory_changes = 0;
    std::int64_t let_in_waiting = 0;  // queued vehicles that let in a vehicle at its waiting position
    std::int64_t discretionary_changes = 0;
    std::int64_t alignments = 0;      // vehicle steps in which a vehicle aligns with a gap in the adjacent lane
    std::int64_t hidden_leaders = 0;  // vehicle steps in which a vehicle brakes for a hidden leader
    std::int64_t human_steps = 0;     // vehicle steps of human drivers in motion
    std::int64_t gear_changes = 0;
    std::int64_t emergency_brakings = 0;
    std::int64_t slowed_before_limit = 0;  // steps in which a lower limit ahead slowed a vehicle

    void add(const Situations& other) {
        for (std::int64_t Situations::*count :
             {&Situations::stopped_at_red,  &Situations::passed_at_yellow,   &Situations::passed_at_red,
              &Situations::became_follower, &Situations::started_in_queue,   &Situations::start_messages,
              &Situations::time_gap_steps,  &Situations::entered_late,       &Situations::exited,
              &Situations::held_at_green,   &Situations::deadlocks,          &Situations::yielded,
              &Situations::gaps_accepted,   &Situations::gaps_refused,       &Situations::merged,
              &Situations::stop_signs,      &Situations::mandatory_changes,  &Situations::discretionary_changes,
              &Situations::alignments,      &Situations::hidden_leaders,     &Situations::human_steps,
              &Situations::gear_changes,    &Situations::emergency_brakings, &Situations::slowed_before_limit,
              &Situations::let_in_waiting,  &Situations::stops_beyond_lane}) {
            this->*count += other.*count;
        }
    }
};

// Rules of core/sim that its documents do not state. The reference engine follows them, so that it can be compared with
// core/sim. A rule that core/sim gives up can be switched off here.
struct UndocumentedRules {
    // The insertion of a vehicle on a lane ends the start messages of the queue on this lane, even of a distant queue.
    bool insertion_ends_start_messages = true;
    // If the speed limit is above the calibrated limit, the acceleration has a lower bound. For followers this bound
    // applies only if at least one policy has a constant-power speed below 100 m/s.
    bool power_bound_needs_power_limit = true;
    // A vehicle whose leader has left it by a lane change, and that has no other leader, stays a follower and keeps the
    // radar history of the old leader. In all other cases, it would become a platoon leader with a new history.
    bool lost_leader_stays_on_radar = true;
};

// Random noise that is added to each speed (mesoscale mode), or to each acceleration and request (full dynamics). It
// shows how a run depends on rounding.
struct Noise {
    double amplitude = 0.0;  // m/s or m/s2
    std::uint64_t seed = 0;
    std::uint64_t drawn = 0;

    double draw() { return amplitude * (2.0 * random_uniform(seed, ++drawn, 0, Purpose::dawdle) - 1.0); }
};

// A curve on a uniform grid that begins at 0: linear between the nodes, constant beyond the last node.
class GridCurve {
public:
    GridCurve() = default;
    GridCurve(double end, std::size_t nodes) : nodes_per_x_(static_cast<double>(nodes - 1) / end), value_(nodes) {}

    double x_of(std::size_t node) const { return static_cast<double>(node) / nodes_per_x_; }
    std::vector<double>& values() { return value_; }
    double at(double x) const {
        const double position = std::clamp(x * nodes_per_x_, 0.0, static_cast<double>(value_.size() - 1));
        const std::size_t low = std::min(static_cast<std::size_t>(position), value_.size() - 2);
        return value_[low] + (position - static_cast<double>(low)) * (value_[low + 1] - value_[low]);
    }

private:
    double nodes_per_x_ = 0.0;
    std::vector<double> value_;
};

// Returns the linear interpolation of y over x, constant beyond the ends.
inline double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
    if (at <= x.front()) return y.front();
    for (std::size_t k = 1; k < x.size(); ++k) {
        if (at < x[k]) return y[k - 1] + (at - x[k - 1]) / (x[k] - x[k - 1]) * (y[k] - y[k - 1]);
    }
    return y.back();
}

// The gap of a spacing law at a speed, and its slope over speed.
struct LawGap {
    double gap_m = 0.0;
    double slope_s = 0.0;
};
inline LawGap law_gap(const GapPolicy& policy, double speed_mps) {
    LawGap result;
    policy.evaluate({&speed_mps, 1}, {&result.gap_m, 1}, {&result.slope_s, 1});
    return result;
}

}  // namespace stopline::reference_engine
