// What a run tells the outside: everything that is measured comes from these. Times are interpolated within the step.
#pragma once

#include <cstdint>
#include <tuple>

namespace stopline {

// A vehicle's front passed from one lane to the next, entered the network (from -1) or left it (to -1).
struct Passage {
    double time_s;
    int vehicle;
    int policy;
    int from_lane;
    int to_lane;
    float speed_mps;
};

// A vehicle's front passed a detector.
struct Crossing {
    double time_s;
    int vehicle;
    int policy;
    int detector;
    float speed_mps;
    float length_m;
};

// A vehicle went ahead although others have priority: it expects the next of them after `gap_s`.
struct GapAccepted {
    double time_s;
    int vehicle;
    int lane;  // inside the intersection
    float gap_s;
    float needed_s;
};

// A vehicle changed to the lane beside.
struct LaneChange {
    double time_s;
    int vehicle;
    int from_lane;
    int to_lane;
    float position_m;  // of its front, on the lane that it came from
    bool for_route;    // else for speed
};

// Something that must never happen, as it was seen.
struct Sighting {
    enum class Kind : std::uint8_t { overlap, conflict, red_entry };
    double time_s = -1.0;  // below 0: nothing was seen
    Kind kind = Kind::overlap;
    int lane = -1;
    int vehicle = -1;  // by number
    int other = -1;    // -1: none

    bool is_before(const Sighting& b) const {
        return std::tie(time_s, lane, vehicle) < std::tie(b.time_s, b.lane, b.vehicle);
    }
};

// Counts of what must never happen; checked in every step of every run.
struct Violations {
    std::int64_t overlaps = 0;            // vehicle-steps with a negative net gap
    std::int64_t conflicts = 0;           // vehicle pairs and steps in the same conflict area
    std::int64_t red_entries = 0;         // passed a stop line on red although stopping had been possible
    std::int64_t forced_red_entries = 0;  // passed on red because stopping was not possible (no violation by itself)
    std::int64_t lost_vehicles = 0;       // entered minus left minus present
    std::int64_t deadlocks = 0;  // runs in which a vehicle was inside an intersection for too long (intersection_run.h)
    Sighting first = {};         // of all but lost vehicles and deadlocks

    // In any order: parts of the network are looked at one by one.
    void see(const Sighting& sighting) {
        if (sighting.time_s >= 0.0 && (first.time_s < 0.0 || sighting.is_before(first))) first = sighting;
    }
    void add(const Violations& more) {
        see(more.first);
        overlaps += more.overlaps;
        conflicts += more.conflicts;
        red_entries += more.red_entries;
        forced_red_entries += more.forced_red_entries;
        lost_vehicles += more.lost_vehicles;
        deadlocks += more.deadlocks;
    }
    bool none() const {
        return overlaps == 0 && conflicts == 0 && red_entries == 0 && lost_vehicles == 0 && deadlocks == 0;
    }
};

}  // namespace stopline
