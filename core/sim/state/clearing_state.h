// The announcements and bookings of cooperative clearing. Owner: sim/clearing. All vectors are empty if the rule is
// off.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace stopline {

// The joint announcement of the vehicles of a lane with a stop line. The vehicles up to `last_leaver` have booked a
// place beyond the next intersection and will leave the lane in the present green. The vehicle behind them is the first
// one that remains.
struct LaneAnnouncement {
    std::int64_t tick = -1;  // step of the announcement
    int last_leaver = -1;    // id of the last vehicle that will leave; -1: none
    // Place where the front of the first remaining vehicle will come to rest at the latest, from the start of the lane.
    // This is the stopping position at the line, unless the vehicle or its leader may have to wait past the line.
    double rest_m = 0.0;
};

// The room on an exit lane in one step. Each admitted vehicle books its length plus its standstill gap.
struct ExitBooking {
    std::int64_t tick = -1;  // step for which the values are valid
    double room_m = 0.0;     // length that is free after all vehicles have come to rest; below 0: overbooked
    // Length that is free behind the last stopped vehicle (slower than 1 m/s), at its present position.
    double present_room_m = 0.0;
    double start_s = 0.0;   // time until this stopped vehicle starts, at the latest
    int last_slot = -1;     // slot of the last vehicle on the lane; -1: none
    double booked_m = 0.0;  // length that admitted vehicles need, part of both rooms
};

// The constants of a spacing policy. The forecasts of arrivals at a stop line use them.
struct ClearingPolicy {
    bool has_v2v = false;            // false: human drivers, who announce nothing
    double time_gap_s = 0.0;         // mean growth of the net gap per speed, up to the highest speed limit
    double acceleration_mps2 = 0.0;  // acceleration that every vehicle exceeds
};

// The constants of a connection. An approach lane has them too: its `last_yield_m` is 0 if vehicles yield on one of its
// connections.
struct ClearingConnection {
    bool turns = false;          // the connection does not go straight on
    double last_yield_m = -1.0;  // start of the last conflict area where vehicles yield; -1: none
    double first_wait_m = 0.0;   // nearest place where vehicles may wait to yield; below 0: upstream of the connection
};

// The vehicle of a lane that was refused last.
struct Refusal {
    int vehicle = -1;            // id; -1: none
    std::int64_t tick = 0;       // step in which the vehicle was refused first
    bool is_keep_clear = false;  // the keep-clear rule holds the vehicle, because it has received too few messages
};

// The vehicles of a lane that were admitted in the latest step with an admission: `first_vehicle` and those behind it.
struct LatestAdmission {
    int first_vehicle = -1;  // id; -1: none
    std::int64_t tick = -1;
};

struct ClearingState {
    // [lane][number of the announcement modulo 4]. A step that makes announcements reads those before it, so the order
    // of threads does not matter. With a V2V channel, a vehicle may know only an older one of the last second.
    std::vector<std::array<LaneAnnouncement, 4>> announcements;
    std::vector<int> last_admitted;                  // [lane] id of the last admitted vehicle on the lane; -1: none
    std::vector<LatestAdmission> latest_admissions;  // [lane]
    std::vector<ExitBooking> bookings;               // [exit lane]
    std::vector<Refusal> refusals;                   // [lane]
    // [exit lane] Length that vehicles claim which wait at red signals. Vehicles refused in their last green have an
    // urgent claim. Turning vehicles have a claim, too.
    std::vector<double> urgent_claims_m;
    std::vector<double> claims_m;                 // includes the urgent claims
    std::vector<ClearingPolicy> policies;         // [policy]
    std::vector<ClearingConnection> connections;  // [lane]
    double line_margin_m = 0.0;                   // largest distance from a stopped vehicle's front to its stop line
    std::int64_t announcement_ticks = 1;          // interval between two announcements
    std::int64_t claim_ticks = 1;                 // interval at which the claims are determined
};

}  // namespace stopline
