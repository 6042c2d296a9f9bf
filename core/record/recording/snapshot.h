// A copy of the state that a recording needs. The run continues while another thread encodes the copy.
//
// The copy is the only cost for the run, so it is small. It lists the vehicle in a slot only if the slot did not have
// this vehicle in the copy before, and it holds positions and speeds in the units of the recording.
#pragma once

#include <cstdint>
#include <vector>

#include "record/recording/recording_header.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

struct Snapshot {
    struct Slots {
        int first = 0;
        int count = 0;

        int past_last() const { return first + count; }
        bool operator==(const Slots&) const = default;
    };
    // A vehicle that was not in this slot in the snapshot before.
    struct Placement {
        int slot = -1;
        int lane = -1;
        int vehicle = -1;
        int policy = -1;
        int next_lane = -1;
        float length_m = 0.0F;
    };
    // A vehicle beyond the stop line of its lane.
    struct BeyondStopLine {
        int slot = -1;
        int lane = -1;
        int next_lane = -1;
    };
    struct StoppedVehicle {
        int vehicle = -1;
        int waited_for = -1;  // the vehicle that causes the stop; -1: none
        DelayCause cause = DelayCause::none;
    };

    std::int64_t tick = 0;
    std::int64_t entered = 0;  // vehicles since the beginning of the run
    std::int64_t exited = 0;   // vehicles since the beginning of the run
    std::vector<Slots> lanes;  // [lane]
    std::vector<Placement> placements;
    std::vector<BeyondStopLine> beyond_stop_line;
    // Position (low 16 bits) and speed (high 16 bits) of every vehicle in units of the header, in the order of lanes
    // and slots. The position is the distance of the front from the start of the lane.
    std::vector<std::uint32_t> motion;
    std::vector<StoppedVehicle> stopped;  // at the last update of the delay causes
};

constexpr std::uint32_t position_of(std::uint32_t motion) { return motion & 0xFFFFU; }
constexpr std::uint32_t speed_of(std::uint32_t motion) { return motion >> 16U; }

class SnapshotTaker {
public:
    SnapshotTaker(const Model& model, const FrameGrid& grid);

    // Makes the next snapshot list the placement of every vehicle.
    void start_section();
    // Copies the state into `snapshot`. The stopped vehicles change less often, so they are copied only on request.
    void take(const State& state, bool with_stopped, Snapshot& snapshot);

private:
    std::size_t update_lanes(const State& state, Snapshot& snapshot);
    void add_placements(const VehicleArrays& vehicles, int lane, Snapshot& snapshot);
    void add_beyond_stop_line(const VehicleArrays& vehicles, int lane, const std::uint32_t* motion,
                              Snapshot& snapshot) const;

    double positions_per_m_;
    std::vector<std::uint32_t> stop_line_;  // [lane] in position units
    std::vector<Snapshot::Slots> lanes_;    // [lane] in the snapshot before
    std::vector<int> vehicle_in_slot_;      // [slot] in the snapshot before; -1: none
};

// Returns the tick of the last update of the delay causes before the state at `tick`, or -1 if there was none. The
// causes are updated every `interval_ticks`.
inline std::int64_t last_cause_tick(std::int64_t interval_ticks, std::int64_t tick) {
    return interval_ticks <= 0 || tick == 0 ? -1 : (tick - 1) / interval_ticks * interval_ticks;
}

}  // namespace stopline
