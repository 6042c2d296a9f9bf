// The data of the reference engine. The reference engine computes the same model as core/sim, but is written for
// clarity. A vehicle is a struct, a lane is a list of vehicles, and all numbers are doubles. Every vehicle is computed
// in every step. The engine calls no function of core/sim, core/driver/krauss.h, core/driver/acceleration_laws.h or
// core/vehicle/powertrain_step.h. It reads the same settings and draws the same random numbers.
//
// With `network.kind: approach`, the network is a straight road with one or several lanes. With `intersection`, two
// streets cross, with one lane for each direction, and all vehicles go straight on. No vehicle changes lanes. Every
// stop line is at the end of its lane.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

#include "base/random.h"
#include "network/lane_graph.h"
#include "scenario/scenario.h"
#include "signals/programme.h"
#include "spacing_laws/gap_policy.h"

namespace stopline::reference_engine {

// Gap of a vehicle without leader. It is so long that no law limits the speed because of it.
inline constexpr double kNoLeaderGap_m = 1e6;

// Returns a value rounded to float, as core/sim stores some values of the mesoscale mode. The reference engine rounds
// the same values, because the mesoscale mode amplifies rounding errors: at a low speed v, one metre of gap changes the
// safe speed by b / v (b: deceleration of the Krauss model), in every step of a stop-and-go wave. All other values are
// double.
inline double stored(double value) { return static_cast<double>(static_cast<float>(value)); }

// A measurement of the radar: the net gap, and the own speed minus the speed of the leader.
struct RadarSample {
    double gap_m = kNoLeaderGap_m;
    double closing_mps = 0.0;
};

// A V2V message to the follower.
struct Message {
    double acceleration_mps2 = 0.0;
    double request_mps2 = 0.0;
    double rate_1ps = 1.0;  // 1 / lag of the sender
};

struct Vehicle {
    int id = -1;
    int policy = 0;
    double position_m = 0.0;  // front, from the start of the lane
    double speed_mps = 0.0;
    double acceleration_mps2 = 0.0;  // in the previous step
    bool is_platoon_leader = true;
    int leader_id = -1;                // the vehicle that this vehicle follows; -1: none
    std::int64_t entry_tick = 0;       // step in which the vehicle passed a stop line
    std::int64_t yield_tick = -2;      // latest step in which the vehicle had to wait before a conflict area
    std::int64_t wait_since_tick = 0;  // step in which that wait began
    bool is_in_queue = false;          // mesoscale mode: member of the standing queue of its lane
    bool has_start_message = false;    // mesoscale mode: received a start message in this step

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
};

// The leader of a vehicle at the start of a step, before sensor delays.
struct Leader {
    int id = -1;  // -1: there is no leader
    double gap_m = kNoLeaderGap_m;
    double speed_mps = 0.0;
    double acceleration_mps2 = 0.0;
    const Vehicle* vehicle = nullptr;
};

// A place before a conflict area where a vehicle must stop.
struct YieldPlace {
    std::ptrdiff_t index = -1;  // the vehicle, as an index in Lane::vehicles
    double position_m = 0.0;    // from the start of the lane
    int blocker_id = -1;        // the vehicle that goes first
};

struct Lane {
    double length_m = 0.0;
    double limit_mps = 0.0;
    double end_speed_mps = 0.0;       // highest speed at the end of the lane, if lower than limit_mps; else 0
    int signal = -1;                  // signal of the stop line at the end of the lane; -1: no stop line
    int next = -1;                    // next lane; -1: vehicles leave the network
    int origin = -1;                  // lane inside an intersection: the lane before it; else -1
    std::vector<Conflict> conflicts;  // lane inside an intersection: its conflict areas, in driving order
    double sine = 0.0;                // sine of the slope angle
    std::deque<Vehicle> vehicles;     // the vehicle furthest downstream first

    // Signal.
    int stopping_id = -1;                 // the vehicle that stops at the line for the signal; -1: none
    std::ptrdiff_t stop_index = -1;       // the vehicle that stops in this step, as an index in `vehicles`; -1: none
    std::vector<YieldPlace> yield_stops;  // in this step, in the order of the vehicles
    // Mesoscale mode: tick at which the standing queue was disturbed for the last time (queue.h).
    std::int64_t disturbed_tick = -1;

    // Returns the vehicle furthest upstream that stops at the line or yields, as an index; -1: none.
    std::ptrdiff_t last_stop_index() const {
        return yield_stops.empty() ? stop_index : std::max(stop_index, yield_stops.back().index);
    }

    // Insertion.
    std::int64_t entered = 0;
    double last_entry_s = -1e9;
    std::int64_t blocked_number = -1;  // number of the vehicle that last found no room
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
    std::int64_t entered_late = 0;      // vehicles that found no room when they were due
    std::int64_t exited = 0;
    std::int64_t held_at_green = 0;  // vehicle steps in which the keep-clear rule holds a vehicle
    std::int64_t deadlocks = 0;      // steps in which slow vehicles waited for each other in a cycle
    std::int64_t yielded = 0;        // vehicles that began to wait before a conflict area
    std::int64_t gear_changes = 0;
    std::int64_t emergency_brakings = 0;
    std::int64_t slowed_before_limit = 0;  // steps in which a lower limit ahead slowed a vehicle

    void add(const Situations& other) {
        stopped_at_red += other.stopped_at_red;
        passed_at_yellow += other.passed_at_yellow;
        passed_at_red += other.passed_at_red;
        became_follower += other.became_follower;
        started_in_queue += other.started_in_queue;
        start_messages += other.start_messages;
        entered_late += other.entered_late;
        exited += other.exited;
        held_at_green += other.held_at_green;
        deadlocks += other.deadlocks;
        yielded += other.yielded;
        gear_changes += other.gear_changes;
        emergency_brakings += other.emergency_brakings;
        slowed_before_limit += other.slowed_before_limit;
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
};

// Random noise that is added to each speed (mesoscale mode), or to each acceleration and request (full dynamics). It
// shows how a run depends on rounding.
struct Noise {
    double amplitude = 0.0;  // m/s or m/s2
    std::uint64_t seed = 0;
    std::uint64_t drawn = 0;

    double draw() { return amplitude * (2.0 * random_uniform(seed, ++drawn, 0, Purpose::dawdle) - 1.0); }
};

// A property of the network that no field of a scenario sets.
struct Road {
    double exit_limit_mps = 0.0;  // speed limit of the exit lanes; 0: that of the other lanes
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
