// A copy of those parts of the state that a recording needs. The run continues while another thread encodes the copy.
//
// The copy is small, because the run must wait while the copy is made. A slot is the index of a vehicle in the arrays
// of the simulation. The copy names the vehicle in a slot only if the vehicle or its next lane is another one than in
// the previous copy. Positions and speeds are in the units of the recording.
#pragma once

#include <cstdint>
#include <vector>

#include "record/recording/recording_header.h"
#include "record/recording/vehicle_links.h"
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
    // A vehicle in a slot that was empty or held another vehicle in the previous snapshot, or a vehicle with a new next
    // lane.
    struct Placement {
        int slot = -1;
        int lane = -1;
        int vehicle = -1;
        int policy = -1;
        int next_lane = -1;
        float length_m = 0.0F;
    };
    struct StoppedVehicle {
        int vehicle = -1;
        int waited_for = -1;  // vehicle for which the stopped vehicle waits; -1: none
        DelayCause cause = DelayCause::none;
    };

    std::int64_t tick = 0;
    std::int64_t entered = 0;   // vehicles that entered since the beginning of the run
    std::int64_t exited = 0;    // vehicles that exited since the beginning of the run
    std::vector<Light> lights;  // [signal group]
    std::vector<Slots> lanes;   // [lane] slots of the lane
    std::vector<Placement> placements;
    // Position (low 16 bits) and speed (high 16 bits) of every vehicle, in the order of lanes and slots. The units are
    // FrameGrid::position_unit_m and kSpeedUnit_mps. The position is the distance of the front from the start of the
    // lane.
    std::vector<std::uint32_t> motion;
    std::vector<StoppedVehicle> stopped;  // vehicles that were stopped at the latest update of the delay causes
    std::vector<VehicleLink> links;
};

constexpr std::uint32_t position_of(std::uint32_t motion) { return motion & 0xFFFFU; }
constexpr std::uint32_t speed_of(std::uint32_t motion) { return motion >> 16U; }

class SnapshotTaker {
public:
    SnapshotTaker(const Model& model, const FrameGrid& grid);

    // Begins a new section of the recording. The next snapshot will contain a Placement for every vehicle.
    void start_section();
    // Copies the state into `snapshot`. The list of stopped vehicles is copied only if `with_stopped` is true. The
    // caller can set `with_stopped` to false while the delay causes are the same as in the previous snapshot.
    void take(const State& state, bool with_stopped, Snapshot& snapshot);

private:
    std::size_t update_lanes(const State& state, Snapshot& snapshot);
    void add_placements(const VehicleArrays& vehicles, int lane, Snapshot& snapshot);

    double positions_per_m_;
    std::vector<const LinkKind*> link_kinds_;
    std::vector<Snapshot::Slots> lanes_;  // [lane] slots in the previous snapshot
    std::vector<int> vehicle_in_slot_;    // [slot] vehicle in the slot in the previous snapshot; -1: none
    std::vector<int> next_lane_in_slot_;  // [slot] next lane of this vehicle
};

// Returns the tick of the latest update of the delay causes before `tick`, or -1 if there was no update. The simulation
// updates the delay causes every `interval_ticks` ticks.
inline std::int64_t last_cause_tick(std::int64_t interval_ticks, std::int64_t tick) {
    return interval_ticks <= 0 || tick == 0 ? -1 : (tick - 1) / interval_ticks * interval_ticks;
}

}  // namespace stopline
