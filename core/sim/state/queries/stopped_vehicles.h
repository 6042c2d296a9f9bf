// The stopped vehicles that the latest delay watch has found. The answers stay valid until the next delay watch, also
// for vehicles that have moved since.
#pragma once

#include <cstddef>
#include <optional>

#include "sim/state/state.h"

namespace stopline {

struct StoppedVehicle {
    int vehicle = -1;    // id
    int waits_for = -1;  // id of the vehicle that blocks this vehicle; -1: none
    int lane = -1;
    DelayCause direct_cause = DelayCause::none;  // cause that stops the vehicle itself; see StoppedQueue::direct_cause
    DelayCause cause = DelayCause::none;         // cause to which the delay of the vehicle is attributed
};

// Calls `visit(StoppedVehicle)` for each stopped vehicle, in the order of lanes and slots.
template <class Visit>
void for_each_stopped_vehicle(const State& state, Visit visit) {
    for (const Partition& part : state.partitions) {
        std::size_t index = 0;
        for (const StoppedQueue& queue : part.stopped_queues) {
            StoppedVehicle stopped{-1, queue.blocker_id, queue.lane, queue.direct_cause, queue.cause};
            for (int k = 0; k < queue.count; ++k) {
                stopped.vehicle = part.stopped_ids[index++];
                visit(stopped);
                stopped.waits_for = stopped.vehicle;
                stopped.direct_cause = DelayCause::none;
            }
        }
    }
}

// Returns the stopped vehicle with an id, or nothing if this vehicle was not stopped.
inline std::optional<StoppedVehicle> find_stopped_vehicle(const State& state, int vehicle) {
    std::optional<StoppedVehicle> found;
    for_each_stopped_vehicle(state, [&](const StoppedVehicle& stopped) {
        if (stopped.vehicle == vehicle) found = stopped;
    });
    return found;
}

}  // namespace stopline
