// Delay by cause, gridlocks and uses of traffic rules in one run. Written by sim/congestion and by right of way.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace stopline {

// The reason why a vehicle is stopped (Section VI.A of the paper, situations 1 to 3).
enum class DelayCause : std::uint8_t {
    none,               // moving
    signal,             // red or yellow signal, ahead of the vehicle or of its queue
    yielding,           // vehicles with priority
    junction_blocking,  // situation 1: a vehicle stopped in a conflict area of the connection
    turn_blocking,      // situation 2: full exit lane of a turning vehicle
    spillback,          // full exit lane of a vehicle that goes straight on
    gridlock,           // situation 3: a cycle of vehicles that wait for each other
    wrong_lane,         // gap in the adjacent lane from which the route continues
    queue_discharge     // the leader drives already, or the vehicle closes up to its queue
};
inline constexpr std::array<const char*, 9> kDelayCauseNames{
    "none",      "signal",   "yielding",   "junction_blocking", "turn_blocking",
    "spillback", "gridlock", "wrong_lane", "queue_discharge"};

// Returns true if the cause is a blocked junction or lane. Signals, yielding and queue discharge cost time in any case.
inline bool is_blocking(DelayCause cause) {
    return cause >= DelayCause::junction_blocking && cause != DelayCause::queue_discharge;
}

// A period in which the traffic of one lane is delayed by one cause without interruption. For signals, yielding and
// queue discharge only vehicles that have been stopped for two cycles count.
struct DelayEpisode {
    DelayCause cause = DelayCause::none;
    int lane = -1;          // lane of the first delayed vehicle
    int vehicle = -1;       // id of the first delayed vehicle when the episode began
    int blocker = -1;       // id of the vehicle that it waited for then; -1: none
    int blocker_lane = -1;  // lane of the blocker then
    double from_s = 0.0;
    double to_s = 0.0;         // time of the last observation
    int current_vehicles = 0;  // delayed vehicles at the last observation
    int max_vehicles = 0;
    double delay_s = 0.0;  // vehicle seconds
};

// A cycle of vehicles that wait for each other. A cycle that shares a vehicle with one seen within the last signal
// cycle continues it.
struct Gridlock {
    double from_s = 0.0;        // first observation
    double to_s = 0.0;          // last observation
    std::vector<int> vehicles;  // ids at the last observation, each waiting for the next; the lowest id first
    std::vector<int> lanes;     // lane of each vehicle
};

// One use of a traffic rule (driver/traffic_rules.h).
struct RuleUse {
    enum class Kind : std::uint8_t { teleported, reinserted, passed_blocker, keep_clear };
    Kind kind = Kind::teleported;
    double time_s = 0.0;
    int vehicle = -1;
    int lane = -1;           // lane of the vehicle; for passed_blocker the connection
    int blocker = -1;        // vehicle that is passed or that blocks the way; -1: none
    double stopped_s = 0.0;  // time for which the teleported vehicle or the blocker has been stopped
};

struct DelayLog {
    std::vector<DelayEpisode> episodes;
    std::vector<Gridlock> gridlocks;
    std::vector<RuleUse> rule_uses;
    std::array<double, kDelayCauseNames.size()> delay_s{};  // [cause] vehicle seconds, whole network
    double delay_upstream_s = 0.0;                          // part of the sum that occurs upstream of the measured area
    std::int64_t teleported = 0;
    std::int64_t passed_blockers = 0;
    double longest_stop_s = 0.0;  // longest single stop of any vehicle
};

}  // namespace stopline
