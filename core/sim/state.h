// All that changes during one run. One State per run; runs side by side share nothing but the Model.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/events.h"
#include "sim/full_group.h"
#include "sim/hindrance.h"
#include "sim/lane_step.h"
#include "sim/meso_kernels.h"
#include "sim/model.h"
#include "sim/vehicle_arrays.h"

namespace stopline {

// The stop line at the end of a lane, as its traffic sees it.
struct StopLineState {
    int stopper = -1;  // id of the vehicle that stops at the line; those behind follow it
};

// An entry lane. The next vehicle's policy and route are drawn once, when it comes up. Or a link.
struct InletState {
    std::int64_t entered = 0;  // vehicles that got their route here
    int next_policy = -1;
    int next_route = -1;
    double last_entry_s = -1e9;
};

// Rows of a delay line at one tick, as offsets into [row][slot] arrays: where the present sample is written and where the
// delayed ones are read, with their weights; `before` is one tick ago.
struct Rows {
    std::size_t now = 0, before = 0, late = 0, later = 0;
    double late_share = 1.0, later_share = 0.0;
};
Rows rows_at(const DelayLine& line, std::int64_t tick, int slots);

// A vehicle on its way through an intersection, past the stop line and not yet wholly on the exit lane.
struct Insider {
    int slot;
    double front_m;  // along the lane inside, below 0 on its origin
    double rear_m;
    std::int64_t since;  // tick at which it passed the stop line
};

// A vehicle that waits to give way.
struct Hold {
    int slot = -1;
    double place_m = 0.0;   // from the lane's start
    int blocker = -1;       // slot of the vehicle that it waits for
    bool priority = false;  // which comes first; else it is in the conflict area
};

// The vehicle that a driver at the stop line sees stand beyond it: in the exit, or across its way.
struct KeptOut {
    int blocker = -1;  // slot
    bool in_exit = false;
};

// Those of one lane: the first ones, from the front.
struct Holds {
    static constexpr int kMost = 3;
    std::array<Hold, kMost> each = {};
    int count = 0;

    void add(const Hold& hold);
    const Hold* of(int slot) const {
        for (int k = 0; k < count; ++k) {
            if (each[static_cast<std::size_t>(k)].slot == slot) return &each[static_cast<std::size_t>(k)];
        }
        return nullptr;
    }
};

// A vehicle that was taken out and waits for room to be put back.
struct Removed {
    int lane = -1;           // where it shall be put back
    std::int64_t since = 0;  // tick from which it has waited for room there
};

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

struct State {
    std::int64_t tick = 0;
    VehicleArrays vehicles;
    Rows radar;  // of this step
    Rows v2v;
    std::vector<LaneBlock> blocks;          // [lane]
    std::vector<int> occupied;              // lanes with vehicles, in lane order
    std::vector<Light> lights;              // [signal group] in this step
    std::vector<StopLineState> stop_lines;  // [lane]
    std::vector<int> stop_slot;             // [lane] slot of the vehicle that stops at the line; -1: none
    std::vector<Holds> holds;               // [lane] vehicles that wait to give way
    std::vector<KeptOut> kept_out;          // [lane] why who stops at the line does so although it is green
    std::vector<Passing> passing;
    std::vector<Agreed> agreed;
    LaneBlock limbo;                             // vehicles that were taken out ...
    std::vector<Removed> removed;                // ... and where each of them goes
    std::vector<double> sine;                    // [lane] of the slope
    std::vector<std::vector<Insider>> insiders;  // [lane inside an intersection], from the front
    std::vector<std::vector<int>> detectors_of;  // [lane]
    std::vector<int> upstream;                   // [detector] vehicles on its lane that have not passed it
    std::vector<Crossing> crossings;             // of the whole run, in order
    std::vector<GapAccepted> gaps_accepted;
    std::vector<InletState> inlets;
    std::vector<int> inlet_of;      // [lane] -1: no routes begin there
    std::vector<Passage> passages;  // of the whole run, in order
    Violations violations;
    HindranceLog hindrance;
    HindranceWatch watch;
    std::int64_t entered = 0;
    std::int64_t left = 0;
    std::int64_t updates = 0;  // vehicle updates computed
    // The longest that any vehicle has been inside an intersection, as an Insider, in ticks. Two cycles or more: a deadlock.
    std::int64_t longest_inside = 0;
    int next_id = 0;
    // Scratch of the kernels: lanes go through them in groups, complete with this many vehicles or more.
    static constexpr int kVehiclesTogether = 128;
    std::vector<LaneStep> lane_steps;
    FullGroupArrays group;
    MesoGroupArrays meso_group;

    int present() const { return static_cast<int>(entered - left); }
    // About 150 bytes of each vehicle are read and written in a step; a second-level cache holds 1 MiB or more.
    bool outgrows_cache() const { return present() > 4000; }
};

State make_state(const Model& model);

}  // namespace stopline
