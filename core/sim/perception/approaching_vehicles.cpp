#include "sim/perception/approaching_vehicles.h"

#include "base/containers/index.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

// Searches upstream of an entry position for a vehicle that cannot stop behind the entering vehicle.
class ApproachSearch {
public:
    ApproachSearch(const Model& model, const State& state) : model_(model), state_(state) {}

    // Returns true if such a vehicle approaches the start of `lane`. `rear_m`: distance from the start of `lane` to the
    // rear of the entering vehicle.
    bool finds_vehicle(int lane, double rear_m, int lanes_upstream = 1) const {
        for (const int connection : model_.connections_to.of(lane)) {
            if (finds_vehicle_on_way(connection, rear_m, lanes_upstream)) return true;
        }
        return false;
    }

private:
    static constexpr double kApproach_m = 60.0;  // distance upstream of a connection within which vehicles are checked
    // Number of lanes upstream that are searched one behind the other. Only lanes shorter than kApproach_m lead to a
    // further one.
    static constexpr int kMaxLanes = 4;

    bool finds_vehicle_on_way(int connection_lane, double rear_m, int lanes_upstream) const {
        const VehicleArrays& v = state_.vehicles;
        const Lane& connection = model_.graph.lanes[at(connection_lane)];
        const LaneBlock& inner = state_.blocks[at(connection_lane)];
        for (int slot = inner.first; slot < inner.past_last(); ++slot) {
            if (is_too_near(slot, rear_m + connection.length_m - v.position_m[at(slot)])) return true;
        }
        const LaneBlock& origin_block = state_.blocks[at(connection.origin)];
        const double origin_m = model_.graph.lanes[at(connection.origin)].length_m;
        const double from_m = origin_m + connection.length_m;
        for (int slot = origin_block.first; slot < origin_block.past_last(); ++slot) {
            const double distance_m = from_m - v.position_m[at(slot)];
            if (distance_m > connection.length_m + kApproach_m) break;
            if (v.next_lane[at(slot)] == connection_lane && is_too_near(slot, rear_m + distance_m)) return true;
        }
        return model_.is_imported() && origin_m < kApproach_m && lanes_upstream < kMaxLanes &&
               finds_vehicle(connection.origin, rear_m + from_m, lanes_upstream + 1);
    }

    bool is_too_near(int slot, double distance_m) const {
        const VehicleArrays& v = state_.vehicles;
        const double gap_m = v.standstill_gap_m[at(slot)];
        return insertion_stopping_distance_m(model_.driver_of(v.policy[at(slot)]), v.speed_mps[at(slot)], gap_m) >
               distance_m;
    }

    const Model& model_;
    const State& state_;
};

}  // namespace

bool approaching_vehicle_cannot_stop(const Model& model, const State& state, int lane, double rear_m) {
    return ApproachSearch(model, state).finds_vehicle(lane, rear_m);
}

}  // namespace stopline
