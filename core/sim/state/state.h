// All data that change during a run. Concurrent runs share nothing but the Model.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "signals/signal_state.h"
#include "sim/state/clearing_state.h"
#include "sim/state/congestion_state.h"
#include "sim/state/detector_state.h"
#include "sim/state/external_requests.h"
#include "sim/state/gap_requests.h"
#include "sim/state/insertion_state.h"
#include "sim/state/junction_state.h"
#include "sim/state/model.h"
#include "sim/state/partition.h"
#include "sim/state/plan/network_plan.h"
#include "sim/state/prescribed_acceleration.h"
#include "sim/state/queue_state.h"
#include "sim/state/run_records.h"
#include "sim/state/stop_line_state.h"
#include "sim/state/vehicles/delay_rows.h"
#include "sim/state/vehicles/vehicle_arrays.h"

namespace stopline {

// The position of a lane in the lists of the partitions.
struct LaneLocation {
    int partition = 0;
    int index = 0;            // index in Partition::lanes
    int exit_partition = -1;  // partition that has the lane in its list of exits; -1: none
    int exit_index = 0;       // index in Partition::exits
};

struct State {
    std::int64_t tick = 0;
    NetworkPlan plan;
    VehicleArrays vehicles;
    LargeArray<LaneBlock> blocks;  // [lane]
    DelayRows radar;               // rows of the stored radar measurements that this step writes and reads
    DelayRows v2v;                 // rows of the stored V2V messages that this step writes and reads
    // Density of vehicles around each intersection, for channels that read it. Empty: none does.
    std::vector<float> vehicles_per_km;
    std::vector<double> longest_lane_m;  // [intersection] set together with vehicles_per_km
    std::vector<Partition> partitions;
    LargeArray<LaneLocation> location_of;  // [lane] position in the lists of `partitions`
    SignalState signals;
    StopLines stop_lines;
    ClearingState clearing;
    JunctionState junctions;
    LargeArray<int> speed_targets_place;  // [lane] place in Partition::speed_targets
    GapCooperation gap_cooperation;
    QueueState queues;
    DetectorState detectors;
    InsertionState insertion;
    CongestionState congestion;
    ExternalRequests external_requests;  // changed by the program between steps
    PrescribedAcceleration prescribed;   // applies to all later steps, until the program changes it
    RunRecords records;

    explicit State(const Model& model) : plan(model) {}
    // Returns the number of vehicles in the network, including teleported vehicles.
    int present() const { return static_cast<int>(records.entered - records.exited); }
    // Returns true if the data of all vehicles take more than about half of a second-level cache of 1 MiB. A step uses
    // about 150 bytes for each vehicle.
    bool outgrows_cache() const { return present() > 4000; }

    const Partition& partition_of(int lane) const {
        return partitions[static_cast<std::size_t>(location_of[static_cast<std::size_t>(lane)].partition)];
    }
};

inline std::span<const JunctionOccupant> occupants_of(const State& state, int connection) {
    const int place = state.junctions.occupants_place[static_cast<std::size_t>(connection)];
    return place < 0 ? std::span<const JunctionOccupant>() : state.partition_of(connection).occupants.at_place(place);
}

// Returns the state before the first step, without vehicles. Makes at least `threads` partitions if the network has
// enough intersections.
State make_state(const Model& model, int threads);

}  // namespace stopline
