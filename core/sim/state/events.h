// The events of a run, from which everything is measured. Times are interpolated within the step.
#pragma once

#include <cstdint>
#include <tuple>

namespace stopline {

// A vehicle's front passes from one lane to the next. Lane -1 stands for outside the network.
struct Passage {
    double time_s;
    int vehicle;
    int policy;
    int from_lane;
    int to_lane;
    float speed_mps;
};

// A vehicle's front passes a detector.
struct Crossing {
    double time_s;
    int vehicle;
    int policy;
    int detector;
    float speed_mps;
    float length_m;
};

// A vehicle without priority accepts a gap: the next vehicle with priority arrives after `gap_s` at the earliest.
struct GapAccepted {
    double time_s;
    int vehicle;
    int lane;  // connection on which the vehicle crosses
    float gap_s;
    float needed_s;
};

// A vehicle changes to an adjacent lane.
struct LaneChange {
    double time_s;
    int vehicle;
    int from_lane;
    int to_lane;
    float position_m;  // front, on the lane that the vehicle left
    bool for_route;    // mandatory change for the route; false: discretionary change for speed
};

// One observed violation of an invariant.
struct Violation {
    enum class Kind : std::uint8_t { overlap, conflict, red_entry };
    double time_s = -1.0;  // below 0: no violation
    Kind kind = Kind::overlap;
    int lane = -1;
    int vehicle = -1;  // vehicle id
    int other = -1;    // id of the second vehicle; -1: none

    bool precedes(const Violation& b) const {
        return std::tie(time_s, lane, vehicle) < std::tie(b.time_s, b.lane, b.vehicle);
    }
};

// Counts of violated invariants. Every step of every run is checked.
struct Violations {
    std::int64_t overlaps = 0;            // vehicle-steps with a negative net gap
    std::int64_t conflicts = 0;           // steps of vehicle pairs in the same conflict area
    std::int64_t red_entries = 0;         // vehicles that passed the stop line on red although they could stop
    std::int64_t forced_red_entries = 0;  // vehicles that passed on red and could not stop; not a violation
    std::int64_t lost_vehicles = 0;       // entered minus exited minus present
    std::int64_t deadlocks = 0;           // runs in which a vehicle stayed in a junction too long (intersection_run.h)
    Violation first = {};                 // earliest overlap, conflict or red entry

    // Keeps the earlier of `violation` and the first one so far. The result does not depend on the order of calls.
    void record(const Violation& violation) {
        if (violation.time_s >= 0.0 && (first.time_s < 0.0 || violation.precedes(first))) first = violation;
    }
    void add(const Violations& other) {
        record(other.first);
        overlaps += other.overlaps;
        conflicts += other.conflicts;
        red_entries += other.red_entries;
        forced_red_entries += other.forced_red_entries;
        lost_vehicles += other.lost_vehicles;
        deadlocks += other.deadlocks;
    }
    bool none() const {
        return overlaps == 0 && conflicts == 0 && red_entries == 0 && lost_vehicles == 0 && deadlocks == 0;
    }
};

}  // namespace stopline
