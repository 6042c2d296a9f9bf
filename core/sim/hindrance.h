// What queues that reach back into intersections do to others (Section VI.A of the paper): who waits for whom, why, where and
// since when. Vehicles are looked at every RulesPlan::watch_ticks; below 0.1 m/s they stand.
//
// Who stands waits for one thing: its light, the vehicle ahead, room in its exit, a vehicle in a conflict area that it wants to
// cross, or one with priority. At a red light it waits as well for one that stands close ahead in the intersection, or else for the one
// that kept it out when the light was green last, for as long as this has stood since. Following these from vehicle to vehicle ends
// at a light, at somebody who moves, or in a circle: a gridlock. A vehicle's time is lost to what its own queue waits for:
//
//     signal             its light, or the one that the queue ahead on the same lane waits for
//     priority           vehicles that come first
//     junction_blocking  a vehicle that stands inside the intersection, across its way (situation 1)
//     turn_blocking      the first that stands would turn, and its exit is full (situation 2)
//     spillback          the same of one that would go straight on
//     gridlock           any of these, where it leads into a circle (situation 3)
//     wrong_lane         the first that stands waits for a gap in the lane beside, from which its route goes on
//     start              nothing any more: the one ahead drives already, or crawls up to its queue, and its own start is still to come
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace stopline {

enum class Cause : std::uint8_t {
    none,
    signal,
    priority,
    junction_blocking,
    turn_blocking,
    spillback,
    gridlock,
    wrong_lane,
    start
};
// `none`: of vehicles that drive.
inline constexpr std::array<const char*, 9> kCauseNames{
    "none", "signal", "priority", "junction_blocking", "turn_blocking", "spillback", "gridlock", "wrong_lane", "start"};

// Whether one vehicle stands in another's way; the rest is what lights and queues cost in any case.
inline bool hinders(Cause cause) { return cause >= Cause::junction_blocking && cause != Cause::start; }

// One lane's traffic is held up for one cause, by one vehicle after another, without a break. Of signals, priority and starts: only
// by whom has stood for two cycles.
struct HindranceEpisode {
    Cause cause = Cause::none;
    int lane = -1;          // of the vehicle that is held up first
    int vehicle = -1;       // it, when the episode began
    int blocker = -1;       // who held it up then
    int blocker_lane = -1;  // and where that was
    double from_s = 0.0;
    double to_s = 0.0;  // last time it was seen
    int last = 0;       // vehicles held up when it was seen last
    int most = 0;       // at most
    double lost_s = 0.0;
};

// A circle, from when it was seen first to when it was seen last; it is the same one if somebody is still in it within a cycle.
struct Gridlock {
    double from_s = 0.0;
    double to_s = 0.0;
    std::vector<int> vehicles;  // the circle, from the lowest number on, each waiting for the next; as last seen
    std::vector<int> lanes;     // of each
};

// Use of a rule (driver/hindrance_rules.h).
struct RuleUse {
    enum class Kind : std::uint8_t { taken_out, put_back, passed_blocker, kept_out };
    Kind kind = Kind::taken_out;
    double time_s = 0.0;
    int vehicle = -1;
    int lane = -1;         // where it was or is put, or is kept, or inside which intersection it passes the blocker
    int blocker = -1;      // that it passes, or that is in its way
    double stood_s = 0.0;  // the vehicle that is taken out, or the blocker
};

struct HindranceLog {
    std::vector<HindranceEpisode> episodes;
    std::vector<Gridlock> gridlocks;
    std::vector<RuleUse> rules;
    std::array<double, kCauseNames.size()> lost_s{};  // [cause] vehicle seconds
    double lost_outside_s = 0.0;                      // of all these: before the measured area
    std::int64_t taken_out = 0;
    std::int64_t passed_blockers = 0;
    double longest_stand_s = 0.0;  // of any vehicle, in one go
};

// The first vehicle of a lane that stood when its light was green last, for whom it waited, and where that was.
struct KeptOutLast {
    int vehicle = -1;
    int blocker = -1;
    int blocker_lane = -1;
    int seen = 0;  // tick
};

// Scratch and open records of the watch.
struct HindranceWatch {
    std::vector<int> waits_for;  // [slot] of who stands: another slot, -1 for nobody; it may crawl
    std::vector<Cause> edge;     // [slot] why; none: follows
    std::vector<Cause> cause;    // [slot] of who stands: what its time is lost to
    std::vector<int> owner;      // [slot] of who stands: the first of its queue, which the cause holds up
    std::vector<int> lane;       // [slot] of all
    std::vector<int> vehicle;    // [slot] of all: its number, for those who look on: slots change before the next look
    std::vector<int> mark;       // [slot] of who stands: number of the walk that came by; 0: none
    std::vector<int> walk;       // slots
    std::vector<int> standing;   // slots
    std::vector<KeptOutLast> kept_out;  // [lane]
    std::vector<int> open;              // [lane * causes + cause] episode that goes on; -1: none
    std::vector<int> open_episodes;     // [k] lane * causes + cause
    std::vector<int> open_gridlocks;    // numbers
};

}  // namespace stopline
