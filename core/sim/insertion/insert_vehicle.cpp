#include "sim/insertion/insert_vehicle.h"

#include "base/containers/index.h"
#include "driver/human.h"
#include "sim/perception/reset_leader.h"
#include "sim/state/lane_blocks.h"
#include "sim/state/queries/passage.h"

namespace stopline {

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
    v.stopped_since[at(slot)] = static_cast<int>(state.tick);
    initialise_sensors(v, slot, slot == state.blocks[at(lane)].first);
    state.queues.standing[at(lane)].last_external_tick = static_cast<int>(state.tick);
    ++state.records.entered;
    if (model.records_all) record_passage(state.records, v, model.time_s(state.tick + 1), slot, -1, lane);
}

}  // namespace stopline
