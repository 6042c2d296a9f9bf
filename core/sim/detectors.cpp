// Fronts that pass detectors. The vehicles of a lane pass in order, so each detector has one to look at: the first of those
// upstream of it.
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

void pass_stop_line(const Model& model, State& state, NetworkPart& part, int lane, int slot) {
    VehicleRecord& record = state.vehicles.record[at(slot)];
    record.inside_since = static_cast<int>(state.tick);
    const int next = state.vehicles.next_lane[at(slot)];
    if (state.lights[at(state.plan.light_before(lane, next))] != Light::red) return;
    if (record.trip >= 0 && next < 0) return;  // it does not go into the intersection
    // Whoever was told to stop was told so because it could, unless barely.
    const StopLineState& line = state.stop_lines[at(lane)];
    if (line.stopper == state.vehicles.id[at(slot)] && !line.barely) {
        ++part.violations.red_entries;
        part.violations.see(
            {model.time_s(state.tick + 1), Sighting::Kind::red_entry, lane, state.vehicles.id[at(slot)], -1});
    } else {
        ++part.violations.forced_red_entries;
    }
}

}  // namespace

void watch_detectors(const Model& model, State& state, NetworkPart& part) {
    const VehicleArrays& v = state.vehicles;
    for (const int number : part.detectors) {
        const Detector& detector = model.detectors[at(number)];
        const LaneBlock& block = state.blocks[at(detector.lane)];
        int& upstream = state.upstream[at(number)];
        for (; upstream > 0; --upstream) {
            const int slot = block.stop() - upstream;
            if (v.position_m[at(slot)] < detector.position_m) break;
            const bool recorded = model.records_all || model.records_detectors || detector.kind == Detector::Kind::zone;
            if (recorded)
                part.crossings.push_back({passing_time_s(model, state, slot, detector.position_m), v.id[at(slot)],
                                          v.policy[at(slot)], number, static_cast<float>(v.speed_mps[at(slot)]),
                                          v.length_m[at(slot)]});
            if (detector.kind == Detector::Kind::stop_line) pass_stop_line(model, state, part, detector.lane, slot);
        }
    }
}

}  // namespace stopline
