// All that changes during one run. One State per run; runs side by side share nothing but the Model.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/marks.h"
#include "sim/events.h"
#include "sim/hindrance.h"
#include "sim/lane_plan.h"
#include "sim/model.h"
#include "sim/network_part.h"
#include "sim/vehicle_arrays.h"

namespace stopline {

// The stop line at the end of a lane, as its traffic sees it.
struct StopLineState {
    int stopper = -1;     // id of the vehicle that stops at the line; those behind follow it
    bool barely = false;  // it was told so late that it may slide over the line all the same
    int kept_out = -1;    // id of the vehicle that the no-block rule keeps before the line at green
};

// An entry lane. The next vehicle's policy and route are drawn once, when it comes up. Or a link.
struct InletState {
    std::int64_t entered = 0;  // vehicles that got their route here
    int next_policy = -1;
    int next_route = -1;
    double last_entry_s = -1e9;
};

// Rows of a delay line at one tick, as offsets into [row][slot] arrays: where the present sample is written and where the
// delayed ones are read, with their weights.
struct Rows {
    std::size_t now = 0, late = 0, later = 0;
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

// A vehicle that waits: to give way, or to change lanes.
struct Hold {
    int slot = -1;
    double place_m = 0.0;   // from the lane's start
    int blocker = -1;       // slot of the vehicle that it waits for; -1: for a gap in the lane beside
    bool priority = false;  // which comes first; else it is in the conflict area
};

// A vehicle that adapts its speed to a gap in the lane beside, or makes room for one from there.
struct Adapting {
    int slot = -1;
    double most_mps = 0.0;  // to be reached by braking gently

    static constexpr double kBraking_mps2 = 1.0;
};

// The vehicle that a driver at the stop line sees stand beyond it: in the exit, or across its way.
struct KeptOut {
    int blocker = -1;  // slot
    bool in_exit = false;
};

// Those of one lane: the first ones, from the front.
struct Holds {
    static constexpr int kMost = 6;
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

// Room that an exit of an intersection still has for those that want to enter it, in the step it was looked for.
struct ExitRoom {
    std::int64_t tick = -1;
    double room_m = 1e9;  // before the last vehicle that stands within sight, less what those on their way there need
    int standing = -1;    // its slot; of the lane's last one where all have to wait for the light at its end
};

// Vehicles of a lane that stand, one behind the other, and stood in the step before, although nothing but their predecessor kept them
// from driving: all but the first will go on standing in this step, since what they react to has not changed. Counted from
// the lane's first vehicle.
struct Resting {
    int from = 0;
    int to = 0;
    std::int64_t imposed =
        -1;        // last tick at which something else kept one of them, but for the first, or one was put on the lane
    int told = 0;  // those before this place were told in the step before that the queue sets out
};

// Where a lane is listed.
struct ListedLane {
    std::size_t part = 0;
    std::size_t place = 0;  // in its lanes
    int exits_of = -1;      // part that has it among its exits; -1: none
    std::size_t exit = 0;   // place there
};

struct State {
    std::int64_t tick = 0;
    VehicleArrays vehicles;
    Rows radar;  // of this step
    Rows v2v;
    NetworkPlan plan;
    std::vector<NetworkPart> parts;               // one or more for each thread
    std::vector<ListedLane> listed;               // [lane]
    std::vector<LaneBlock> blocks;                // [lane]
    std::vector<Light> lights;                    // [signal group] in this step
    std::vector<StopLineState> stop_lines;        // [lane]
    std::vector<int> stop_slot;                   // [lane] slot of the vehicle that stops at the line; -1: none
    std::vector<Holds> holds;                     // [lane] vehicles that wait to give way or to change lanes
    std::vector<char> has_holds;                  // [lane] 1: there are some
    std::vector<std::vector<Adapting>> adapting;  // [lane]
    std::vector<KeptOut> kept_out;                // [lane] why who stops at the line does so although it is green
    std::vector<ExitRoom> exit_rooms;             // [lane] that leads out of an intersection
    std::vector<std::vector<Insider>> insiders;   // [lane inside an intersection], from the front
    // Lanes inside intersections (NetworkPlan::marked): with insiders, with some that stand, and those on which or before which
    // somebody may have to wait.
    Marks with_insiders;
    Marks with_standing;
    Marks deciding;
    std::vector<std::vector<int>> coming;  // [lane inside an intersection] slots before it that are near
    std::vector<Resting> resting;          // [lane] mesoscale mode
    // [lane] mesoscale mode: the signal group before which its first vehicle rests, so that there is nothing to decide before that is green
    // or somebody comes; -1: awake.
    std::vector<int> sleeps_until_green_of;
    LaneBlock limbo;                             // vehicles that were taken out ...
    std::vector<Removed> removed;                // ... and where each of them goes
    std::vector<std::vector<int>> detectors_of;  // [lane]
    std::vector<int> upstream;                   // [detector] vehicles on its lane that have not passed it
    std::vector<Crossing> crossings;             // of the whole run, in order
    std::vector<GapAccepted> gaps_accepted;
    std::vector<LaneChange> lane_changes;                      // of the whole run, in order
    std::vector<std::array<std::int64_t, kMostTurns>> drawn;   // [approach][Turn] where approach_shares are asked for
    std::vector<std::array<std::int64_t, kMostTurns>> turned;  // [approach][Turn] vehicles that went on from there
    std::vector<InletState> inlets;
    std::vector<int> open_inlets;                 // entries, and links where vehicles are still to enter, in order
    std::vector<int> inlet_of;                    // [lane] -1: no routes begin there
    std::size_t next_trip = 0;                    // the first that is not due yet
    std::vector<std::vector<int>> waiting_trips;  // [approach] due and not entered, in their order
    std::vector<int> waiting_at;                  // approaches where trips wait, in order
    std::int64_t strayed =
        0;  // vehicles on trips that came to the end of a lane that does not serve them, and were moved on
    std::vector<Passage> passages;  // of the whole run, in order
    Violations violations;
    HindranceLog hindrance;
    HindranceWatch watch;
    std::int64_t entered = 0;
    std::int64_t left = 0;
    std::int64_t updates = 0;  // vehicles times steps, those that rest included
    // The longest that any vehicle has been inside an intersection, as an Insider, in ticks.
    std::int64_t longest_inside = 0;
    int next_id = 0;

    explicit State(const Model& model) : plan(model) {}
    int present() const { return static_cast<int>(entered - left); }
    // About 150 bytes of each vehicle are read and written in a step; a second-level cache holds 1 MiB or more.
    bool outgrows_cache() const { return present() > 4000; }
};

// One more that waits on a lane.
void hold(State& state, NetworkPart& part, int lane, const Hold& hold);

// `threads`: into how many parts a step is split at least, where there are as many intersections.
State make_state(const Model& model, int threads);

}  // namespace stopline
