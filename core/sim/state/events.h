// The events of a run, from which travel times, flows and other measures are computed. Event times are interpolated
// within the step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>

namespace stopline {

// The front of a vehicle passes from one lane to the next. The lane index -1 means: outside the network.
struct Passage {
    double time_s;
    int vehicle;
    int policy;
    int from_lane;
    int to_lane;
    float speed_mps;
};

// The front of a vehicle passes a detector.
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
    int lane;  // connection that the vehicle takes
    float gap_s;
    float needed_s;  // smallest gap that the vehicle accepts (needed_time_s() in sim/junction/gap_acceptance.cpp)
};

// A vehicle changes to an adjacent lane.
struct LaneChange {
    double time_s;
    int vehicle;
    int from_lane;
    int to_lane;
    float position_m;  // position of the front on from_lane
    bool for_route;    // true: mandatory change for the route; false: discretionary change for a higher speed
};

// A vehicle with an active V2V channel changes its driving mode (v2v/fallback.h).
struct V2vModeChange {
    double time_s;
    int vehicle;
    int leader;  // id; -1: none
    int from_mode;
    int to_mode;
    float age_s;  // age of the newest message from the leader; below 0: there is no message
    float gap_m;  // net gap
    float speed_mps;
};
inline constexpr std::size_t kV2vModes = 5;

// One observed violation of an invariant.
struct Violation {
    enum class Kind : std::uint8_t { overlap, conflict, red_entry };
    double time_s = -1.0;  // below 0: there is no violation
    Kind kind = Kind::overlap;
    int lane = -1;
    int vehicle = -1;  // id of the vehicle; overlap: id of the follower
    int other = -1;    // id of the second vehicle; overlap: id of the leader; red_entry: -1

    bool precedes(const Violation& b) const {
        return std::tie(time_s, lane, vehicle) < std::tie(b.time_s, b.lane, b.vehicle);
    }
};

// Numbers of violations of each invariant. The invariants are checked in every step of every run.
struct Violations {
    std::int64_t overlaps = 0;            // vehicles with a negative net gap to their leader, summed over all steps
    std::int64_t conflicts = 0;           // pairs of vehicles in the same conflict area, summed over all steps
    std::int64_t red_entries = 0;         // vehicles that passed the stop line on red although they could have stopped
    std::int64_t forced_red_entries = 0;  // vehicles that could not stop and passed on red; this is no violation
    std::int64_t lost_vehicles = 0;       // vehicles that entered, minus those that exited, minus those present
    std::int64_t deadlocks = 0;  // runs in which a vehicle stayed inside a junction for too long (intersection_run.cpp)
    Violation first = {};        // earliest overlap, conflict or red entry

    // Stores `violation` in `first` if it is earlier than the violation stored there. The result does not depend on the
    // order of calls.
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
