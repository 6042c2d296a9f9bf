#include "sim/perception/approaching_vehicles.h"

#include "base/containers/index.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

constexpr double kApproach_m = 60.0;  // distance upstream of a connection within which approaching vehicles are checked

}  // namespace

bool approaching_vehicle_cannot_stop(const Model& model, const State& state, int lane, double rear_m) {
    const VehicleArrays& v = state.vehicles;
    const auto is_too_near = [&](int slot, double distance_m) {
        const double gap_m = v.standstill_gap_m[at(slot)];
        return insertion_stopping_distance_m(model.driver_of(v.policy[at(slot)]), v.speed_mps[at(slot)], gap_m) >
               distance_m;
    };
    for (const int connection_lane : model.connections_to.of(lane)) {
        const Lane& connection = model.graph.lanes[at(connection_lane)];
        const LaneBlock& inner = state.blocks[at(connection_lane)];
        for (int slot = inner.first; slot < inner.past_last(); ++slot) {
            if (is_too_near(slot, rear_m + connection.length_m - v.position_m[at(slot)])) return true;
        }
        const LaneBlock& origin_block = state.blocks[at(connection.origin)];
        const double from_m = model.graph.lanes[at(connection.origin)].length_m + connection.length_m;
        for (int slot = origin_block.first; slot < origin_block.past_last(); ++slot) {
            const double distance_m = from_m - v.position_m[at(slot)];
            if (distance_m > connection.length_m + kApproach_m) break;
            if (v.next_lane[at(slot)] == connection_lane && is_too_near(slot, rear_m + distance_m)) return true;
        }
    }
    return false;
}

}  // namespace stopline
