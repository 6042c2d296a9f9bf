// What a recording needs of the state of a run, copied between two steps so that it can be encoded while the run goes on. The
// copy is what a recording costs the run, so it is small: who sits where is told only where it has changed since the copy before,
// positions and speeds as they are recorded.
#pragma once

#include <cstdint>
#include <vector>

#include "record/recording_header.h"
#include "sim/model.h"
#include "sim/state.h"

namespace stopline {

struct Snapshot {
    struct Slots {
        int first = 0;
        int count = 0;

        int stop() const { return first + count; }
        bool operator==(const Slots&) const = default;
    };
    // A vehicle that was not in that slot in the snapshot before.
    struct Guest {
        int slot = -1;
        int lane = -1;
        int vehicle = -1;  // its number
        int policy = -1;
        int next_lane = -1;
        float length_m = 0.0F;
    };
    // A vehicle past the stop line of its lane.
    struct PastLine {
        int slot = -1;
        int lane = -1;
        int next_lane = -1;
    };
    struct Standing {
        int vehicle = -1;     // its number
        int waited_for = -1;  // that of another; -1: none
        Cause cause = Cause::none;
    };

    std::int64_t tick = 0;
    std::int64_t entered = 0;  // vehicles so far
    std::int64_t left = 0;
    std::vector<Slots> lanes;  // [lane]
    std::vector<Guest> guests;
    std::vector<PastLine> past_line;
    // Of every vehicle, lane by lane and each in the order of its slots: position of the front from the lane's start, and speed
    // above it, 16 bits each, in units of the header.
    std::vector<std::uint32_t> motion;
    std::vector<Standing> standing;  // at the last look at hindrance
};

constexpr std::uint32_t position_of(std::uint32_t motion) { return motion & 0xFFFFU; }
constexpr std::uint32_t speed_of(std::uint32_t motion) { return motion >> 16U; }

class SnapshotTaker {
public:
    SnapshotTaker(const Model& model, const FrameGrid& grid);

    // The next snapshot tells of every vehicle where it is, not only of those that were elsewhere.
    void start_afresh();
    // Standing only if asked for: it changes less often than the rest.
    void take(const State& state, bool with_standing, Snapshot& shot);

private:
    std::size_t note_lanes(const State& state, Snapshot& shot);
    void note_guests(const VehicleArrays& vehicles, int lane, Snapshot& shot);
    void note_past_line(const VehicleArrays& vehicles, int lane, const std::uint32_t* motion, Snapshot& shot) const;

    double positions_per_m_;
    std::vector<std::uint32_t> stop_line_;  // [lane] behind it vehicles are drawn on the lane that follows
    std::vector<Snapshot::Slots> lanes_;    // [lane] in the snapshot before
    std::vector<int> guest_;                // [slot] in the snapshot before; -1: nobody
};

// The tick of the last look at hindrance, which is so often, before a state at that tick; -1: none.
inline std::int64_t look_tick_before(std::int64_t every_ticks, std::int64_t tick) {
    return every_ticks <= 0 || tick == 0 ? -1 : (tick - 1) / every_ticks * every_ticks;
}

}  // namespace stopline
