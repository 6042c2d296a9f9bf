// What one thread works on at a time in a step: the lanes of some intersections, scratch, and what it has to tell. Whatever the number of parts,
// all their lanes one after the other are in the same order, so that what they tell is too.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/marks.h"
#include "base/number_list.h"
#include "sim/events.h"
#include "sim/full_group.h"
#include "sim/hindrance.h"
#include "sim/lane_step.h"

namespace stopline {

// A vehicle that may pass one that has stood inside an intersection for long.
struct Passing {
    int vehicle = -1;  // by number
    int blocker = -1;
    std::int64_t seen = 0;   // last tick at which it mattered
    std::int64_t stood = 0;  // ticks, the blocker, when that was decided
    bool begun = false;      // both have been in the same area
};

// Two that stood and waited for each other, neither with priority: one goes, the other waits.
struct Agreed {
    int goes = -1;  // by number
    int waits = -1;
    std::int64_t seen = 0;  // last tick at which it mattered
};

struct NetworkPart;

// What is fetched for the next parts while one is decided, and how far that is.
struct Fetching {
    const NetworkPart* next = nullptr;
    const NetworkPart* second = nullptr;  // the one behind
    std::size_t lane = 0;                 // of the next part
    std::size_t line = 0;                 // of the second
};

// Who hears by V2V that its queue sets out, and how fast. Noted while others may still look at it.
struct ToldToStart {
    int slot;
    float mps2;
};

// What a vehicle of full dynamics does about one that it does not follow.
struct Minding {
    int slot;
    double asks_mps2;
};

struct NetworkPart {
    std::vector<int> lanes;      // by intersection
    std::vector<int> inside;     // those of them inside an intersection that meet others
    std::size_t first_word = 0;  // of the marks of these: [first_word, end_word)
    std::size_t end_word = 0;
    std::vector<int> exits;      // where these lead to
    std::vector<int> detectors;  // on the lanes
    // Where somebody has come since it was last looked at without finding anybody.
    Marks may_be_occupied;  // [place in lanes]
    Marks may_reach_back;   // [place in exits]
    // What is known of the lanes, as far as a step needs it in any case: lines of the cache, in the order of memory (fetch.cpp).
    std::vector<const char*> lines;
    Fetching fetching;
    // In this step.
    NumberList occupied;             // lanes with vehicles
    NumberList awake;                // those of them where there is something to decide (State::sleeps_until_green_of)
    NumberList awake_before;         // the same with a stop line
    NumberList awake_inside;         // the same inside an intersection
    std::vector<int> with_insiders;  // lanes inside with vehicles on them, before or behind
    std::vector<Minding> minding;    // full dynamics: in the order of slots of each lane, lanes as they are awake
    std::vector<int> holding;        // lanes where vehicles wait to give way or to change lanes
    std::vector<int> adapting;       // lanes where vehicles adapt their speed to those beside
    NumberList standing;             // slots of vehicles that stand, when hindrance is looked for
    int stands_since = 0;            // tick since which the first of these has stood
    NumberList near_end;             // lanes whose first vehicle may reach the end
    std::vector<int> ended;          // lanes whose first vehicle has reached it
    std::vector<ToldToStart> told;   // mesoscale mode
    std::vector<Passing> passing;
    std::vector<Agreed> agreed;
    // To be told.
    std::int64_t present = 0;
    std::int64_t updates = 0;
    std::int64_t longest_inside = 0;
    std::int64_t passed_blockers = 0;
    Violations violations;
    std::vector<Crossing> crossings;
    std::vector<GapAccepted> gaps_accepted;
    std::vector<RuleUse> rules;
    // Scratch of the kernels: lanes go through them in groups, complete with this many vehicles or more.
    static constexpr int kVehiclesTogether = 128;
    std::array<LaneGroup, 2> groups;  // at work and next
    FullGroupArrays full_group;
    // Mesoscale mode (meso_kernels.h): blocks of slots with vehicles to move, slots on which something is imposed, and MesoMore.
    NumberList blocks;
    std::vector<int> imposed;
    std::vector<double> more;
};

}  // namespace stopline
