// Delays by cause, gridlocks and uses of traffic rules in one run. sim/congestion and sim/junction write the log.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace stopline {

// The cause of the delay of a stopped vehicle. Situations 1 to 3 are those of Massow, Radusch and Shorten (2021),
// Section VI.A. A vehicle in a queue has the cause that stops the first vehicle of the queue.
enum class DelayCause : std::uint8_t {
    none,               // the vehicle is moving, or its cause has not been found yet
    signal,             // the vehicle waits at a red or yellow signal
    yielding,           // the vehicle yields to a vehicle that has priority or is moving across its path
    junction_blocking,  // situation 1: a stopped vehicle blocks a conflict area ahead
    turn_blocking,      // situation 2: the vehicle turns, and its exit lane is full
    spillback,          // the vehicle goes straight on, and its exit lane is full
    gridlock,           // situation 3: a cycle of vehicles that wait for each other contains or blocks the vehicle
    wrong_lane,         // the vehicle waits for a gap in the adjacent lane, to which it must change
    queue_discharge,    // nothing holds the vehicle: its leader has started or is far ahead
    refusal             // cooperative clearing holds the vehicle at its stop line
};
inline constexpr std::array<const char*, 10> kDelayCauseNames{
    "none",      "signal",   "yielding",   "junction_blocking", "turn_blocking",
    "spillback", "gridlock", "wrong_lane", "queue_discharge",   "refusal"};

// Returns true if the cause is a blockage: a blocked junction, a full exit lane, a gridlock, or a lane that is blocked
// by a vehicle waiting for a lane change. Signals, yielding and queue discharge delay vehicles without any blockage.
inline bool is_blocking(DelayCause cause) {
    return cause >= DelayCause::junction_blocking && cause != DelayCause::queue_discharge;
}

// A period in which one cause delays a queue without interruption. The queue begins on the lane of the episode. If the
// cause is a signal, yielding or queue discharge, short stops are normal. The episode then includes only vehicles that
// have been stopped for at least two signal cycles.
struct DelayEpisode {
    DelayCause cause = DelayCause::none;
    int lane = -1;          // lane of the first vehicle of the queue
    int vehicle = -1;       // id of the first vehicle of the queue when the episode began
    int blocker = -1;       // id of the vehicle for which `vehicle` waited when the episode began; -1: none
    int blocker_lane = -1;  // lane of the blocker when the episode began
    double from_s = 0.0;
    double to_s = 0.0;         // time of the latest observation
    int current_vehicles = 0;  // delayed vehicles at the latest observation
    int max_vehicles = 0;
    double delay_s = 0.0;  // total delay, vehicle seconds
};

// A cycle of vehicles in which each vehicle waits for the next one. If two cycles have a vehicle in common and are
// observed at most one signal cycle apart, both count as the same gridlock.
struct Gridlock {
    double from_s = 0.0;        // time of the first observation
    double to_s = 0.0;          // time of the latest observation
    std::vector<int> vehicles;  // ids at the latest observation, lowest id first, then in the order of the cycle
    std::vector<int> lanes;     // lane of each vehicle
};

// A starving vehicle. It is the first vehicle of its queue and has been stopped for at least
// RulesPlan::starvation_ticks. If it has a signal, it has also been stopped for at least two cycles of this signal. In
// this time, no vehicle ahead on its lane or beyond blocked its way. The vehicle only waited for right of way, its
// signal or a lane change.
struct Starvation {
    DelayCause cause = DelayCause::none;  // at the last observation
    int lane = -1;
    int vehicle = -1;     // id of the vehicle
    double from_s = 0.0;  // time at which the vehicle stopped
    double to_s = 0.0;    // time of the last observation
};

// One use of a traffic rule (driver/traffic_rules.h): a vehicle is teleported, is reinserted after its teleport, passes
// a blocker, is held at a green signal by the keep-clear rule, or is refused by cooperative clearing.
struct RuleUse {
    enum class Kind : std::uint8_t { teleported, reinserted, passed_blocker, keep_clear, refused };
    Kind kind = Kind::teleported;
    double time_s = 0.0;
    int vehicle = -1;  // id of the vehicle that uses the rule
    int lane = -1;     // lane of the vehicle; passed_blocker: connection on which it passes the blocker
    int blocker = -1;  // passed_blocker, keep_clear, refused: id of the blocking vehicle; else -1
    // passed_blocker, keep_clear, refused: time for which the blocker has been stopped. teleported, reinserted: time
    // for which the vehicle itself has been stopped.
    double stopped_s = 0.0;
};

struct DelayLog {
    std::vector<DelayEpisode> episodes;
    std::vector<Gridlock> gridlocks;
    std::vector<Starvation> starvations;  // in the order in which they were found
    std::vector<RuleUse> rule_uses;
    std::array<double, kDelayCauseNames.size()> delay_s{};  // [cause] delay in the whole network, vehicle seconds
    double delay_upstream_s = 0.0;     // part of the delay that occurs upstream of the measured area
    std::int64_t teleported = 0;       // number of teleports
    std::int64_t passed_blockers = 0;  // number of times that a vehicle has passed its blocker
    std::int64_t refused = 0;          // number of times that cooperative clearing has begun to hold a vehicle
    std::int64_t refusal_ticks = 0;    // time for which refused vehicles were stopped at their line, ticks
    double refused_stop_s = 0.0;       // the same in s; set at the end of the run
    std::int64_t stops = 0;            // number of times that a vehicle stops
    std::int64_t advised_ticks = 0;    // time for which vehicles follow speed advice, ticks
    double advised_s = 0.0;            // the same in s; set at the end of the run
    double longest_stop_s = 0.0;       // duration of the longest single stop of any vehicle
};

}  // namespace stopline
