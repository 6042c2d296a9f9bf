#include "sim/state/queries/passage.h"

#include <algorithm>

#include "base/containers/index.h"

namespace stopline {

double passing_time_s(const Model& model, const State& state, int slot, double line_m) {
    const VehicleArrays& v = state.vehicles;
    const double speed_mps = v.speed_mps[at(slot)];
    // In the mesoscale mode a vehicle drives the whole step at its new speed.
    const double speed_before = model.meso ? speed_mps : speed_mps - v.acceleration_mps2[at(slot)] * model.step_s;
    const double mean_mps = std::max(0.5 * (speed_before + speed_mps), 1e-6);
    const double since_s = (v.position_m[at(slot)] - line_m) / mean_mps;
    return model.time_s(state.tick + 1) - std::clamp(since_s, 0.0, model.step_s);
}

void record_passage(RunRecords& records, const VehicleArrays& v, double time_s, int slot, int from, int to) {
    records.passages.push_back(
        {time_s, v.id[at(slot)], v.policy[at(slot)], from, to, static_cast<float>(v.speed_mps[at(slot)])});
}

void record_trip_crossing(RunRecords& records, const VehicleArrays& v, double time_s, int slot, int detector) {
    if (detector < 0) return;
    records.crossings.push_back({time_s, v.id[at(slot)], v.policy[at(slot)], detector,
                                 static_cast<float>(v.speed_mps[at(slot)]), v.length_m[at(slot)]});
}

}  // namespace stopline
