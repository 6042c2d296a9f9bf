#include "sim/insertion/insert_vehicle.h"

#include <algorithm>

#include "base/containers/index.h"
#include "driver/human.h"
#include "sim/perception/reset_leader.h"
#include "sim/state/lane_blocks.h"
#include "sim/state/queries/desired_gap.h"
#include "sim/state/queries/passage.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

double safe_entry_speed_mps(const Model& model, int policy, double gap_m, double leader_mps, double wanted_mps) {
    const auto is_safe = [&](double speed_mps) {
        const double deceleration_mps2 = model.driver_of(policy).tables.stop.deceleration_mps2;
        const double braking_m = braking_distance_m(speed_mps, leader_mps, deceleration_mps2);
        return gap_m >= desired_gap_m(model, policy, speed_mps) + braking_m;
    };
    if (is_safe(wanted_mps)) return wanted_mps;
    double safe_mps = std::min(wanted_mps, leader_mps);
    if (!is_safe(safe_mps)) return -1.0;
    constexpr int kHalvings = 12;  // the error is below 0.01 m/s
    double unsafe_mps = wanted_mps;
    for (int k = 0; k < kHalvings; ++k) {
        const double middle_mps = 0.5 * (safe_mps + unsafe_mps);
        (is_safe(middle_mps) ? safe_mps : unsafe_mps) = middle_mps;
    }
    return safe_mps;
}

int insert_vehicle(const Model& model, State& state, const NewVehicle& vehicle) {
    const int slot = vehicle.behind_last ? append_slot(state, vehicle.lane)
                                         : insert_slot(model, state, vehicle.lane, vehicle.position_m);
    VehicleArrays& v = state.vehicles;
    const std::size_t i = at(slot);
    v.position_m[i] = vehicle.position_m;
    v.speed_mps[i] = vehicle.speed_mps;
    v.acceleration_mps2[i] = 0.0F;
    v.length_m[i] = static_cast<float>(vehicle.length_m);
    v.reset_powertrain(slot, model.vehicle_of(vehicle.policy), vehicle.speed_mps);
    v.is_platoon_leader[i] = 1.0F;
    v.standstill_gap_m[i] = static_cast<float>(model.policies[at(vehicle.policy)].settings.standstill_gap_m);
    v.policy[i] = vehicle.policy;
    limit_to_maximum_speed(state, vehicle.lane, slot);
    if (v.has_several_types) v.type[i] = model.classes[at(vehicle.policy)].vehicle;
    v.id[i] = state.insertion.next_id++;
    v.record[i] = {};
    if (v.has_itineraries) v.itinerary[i] = {};
    if (v.has_lane_changes) v.lane_memory[i] = {};
    if (v.has_human_drivers) v.start_ticks[i] = kStartedLongAgo_ticks;
    v.next_lane[i] = -1;
    v.record[i].route = vehicle.route;
    return slot;
}

void finish_insertion(const Model& model, State& state, int lane, int slot) {
    VehicleArrays& v = state.vehicles;
    v.stopped_since_tick[at(slot)] = static_cast<int>(state.tick);
    initialise_sensors(v, slot, slot == state.blocks[at(lane)].first);
    state.queues.standing[at(lane)].last_external_tick = static_cast<int>(state.tick);
    ++state.records.entered;
    if (model.records_all) record_passage(state.records, v, model.time_s(state.tick + 1), slot, -1, lane);
}

}  // namespace stopline
