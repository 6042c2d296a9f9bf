// A vehicle is put on a lane, or gets another predecessor there: what it is, sees and keeps.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace

int put_on_lane(const Model& model, State& state, const Entering& entering) {
    const int slot = entering.behind_last ? append_slot(state, entering.lane)
                                          : insert_slot(model, state, entering.lane, entering.position_m);
    VehicleArrays& v = state.vehicles;
    const std::size_t i = at(slot);
    v.position_m[i] = entering.position_m;
    v.speed_mps[i] = entering.speed_mps;
    v.acceleration_mps2[i] = 0.0F;
    v.length_m[i] = static_cast<float>(entering.length_m);
    v.reset_powertrain(slot, model.vehicles[0], entering.speed_mps);
    v.leads[i] = 1.0F;
    v.standstill_gap_m[i] = static_cast<float>(model.policies[at(entering.policy)].settings.standstill_gap_m);
    v.policy[i] = entering.policy;
    v.type[i] = 0;
    v.id[i] = state.next_id++;
    v.record[i] = {};
    v.next_lane[i] = -1;
    v.record[i].route = entering.route;
    return slot;
}

void begin_to_drive(const Model& model, State& state, int lane, int slot) {
    VehicleArrays& v = state.vehicles;
    const std::size_t i = at(slot);
    const bool first = slot == state.blocks[at(lane)].first;
    v.stands_since[i] = static_cast<int>(state.tick);
    v.record[i].predecessor = first ? -1 : v.id[i - 1];
    const double gap_m = first ? 1e6 : v.position_m[i - 1] - v.length_m[i - 1] - v.position_m[i];
    v.reset_radar(slot, gap_m, first ? 0.0 : v.speed_mps[i] - v.speed_mps[i - 1]);
    v.reset_v2v(slot);
    state.resting[at(lane)].imposed = state.tick;
    ++state.entered;
    if (model.records_all) note_passage(state, model.time_s(state.tick + 1), slot, -1, lane);
}

void follow_anew(State& state, int slot, const LaneBlock& block) {
    if (slot >= block.stop()) return;
    VehicleArrays& v = state.vehicles;
    const bool first = slot == block.first;
    v.record[at(slot)].predecessor = first ? -1 : v.id[at(slot - 1)];
    if (first) return;  // it looks beyond the lane in the next step
    v.leads[at(slot)] = 0.0F;
    const double rear_m = v.position_m[at(slot - 1)] - static_cast<double>(v.length_m[at(slot - 1)]);
    v.reset_radar(slot, rear_m - v.position_m[at(slot)], v.speed_mps[at(slot)] - v.speed_mps[at(slot - 1)]);
}

double stops_from_mps(const Model& model, int lane, double front_m) {
    const Lane& road = model.graph.lanes[at(lane)];
    if (road.signal_group < 0 || front_m > road.stop_line_m) return kAnySpeed_mps;
    const double room_m = std::max(road.stop_line_m - model.driver.stop.margin_m - front_m, 0.0);
    return std::sqrt(2.0 * model.driver.stop.deceleration_mps2 * room_m);
}

double desired_gap_m(const Model& model, int policy_number, double speed_mps) {
    const CompiledPolicy& policy = model.policies[at(policy_number)];
    double gap_m = 0.0;
    double slope_s = 0.0;
    policy.law->evaluate(policy.settings, {&speed_mps, 1}, {&gap_m, 1}, {&slope_s, 1});
    if (!model.meso) return gap_m;
    const Krauss& krauss = model.krauss[at(policy_number)];
    const double more_m = krauss.constant_distance ? gap_m - policy.settings.standstill_gap_m : 0.0;
    return krauss.equilibrium_gap_m(speed_mps) + more_m;
}

}  // namespace stopline
