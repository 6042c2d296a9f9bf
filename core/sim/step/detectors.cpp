#include "sim/step/detectors.h"

#include <algorithm>
#include <vector>

#include "base/containers/index.h"
#include "sim/state/events.h"
#include "sim/state/queries/passage.h"

namespace stopline {

namespace {

// Where crossings and violations are recorded.
struct Reports {
    std::vector<Crossing>& crossings;
    Violations& violations;
};

// Returns true if the light of a signal group has been red for longer than the vehicle needs to stop from the speed
// limit of the lane, or from its speed if this is higher. If such a vehicle passes on red, the signal did not surprise
// it.
bool had_time_to_stop(const Model& model, const State& state, int lane, int slot, int group) {
    constexpr double kReserve_s = 2.0;  // our choice
    const DriverTables& driver = model.driver_of(state.vehicles.policy[at(slot)]).tables;
    const double speed_mps = std::max(state.plan.free_speed_mps(lane), state.vehicles.speed_mps[at(slot)]);
    const double stop_s = kBrakingReaction_s + speed_mps / driver.stop.decision_deceleration_mps2;
    return model.time_s(state.tick - state.signals.since_tick[at(group)]) > stop_s + kReserve_s;
}

// Records that a vehicle enters the intersection. Counts a violation if the vehicle passes the stop line on red
// although it could have stopped.
void pass_stop_line(const Model& model, State& state, const Reports& reports, int lane, int slot) {
    VehicleRecord& record = state.vehicles.record[at(slot)];
    record.junction_entry_tick = static_cast<int>(state.tick);
    record.line_stop_tick = -1;
    const int next = state.vehicles.next_lane[at(slot)];
    const int group = state.plan.signal_group_for(lane, next);
    if (state.signals.lights[at(group)] != Light::red) return;
    // A vehicle whose trip ends on this lane, or whose turn the lane does not allow, does not enter the intersection.
    if (next < 0 && state.vehicles.itinerary_of(at(slot)).has_trip()) return;
    // A vehicle is chosen to stop for the signal only if it is able to stop (stop_lines.cpp). If the chosen vehicle
    // passes on red, this is a violation, unless stopping needed almost maximum braking (may_overrun). It is also a
    // violation if any vehicle passes although it had time to stop.
    const StopLineState& line = state.stop_lines.lines[at(lane)];
    const bool was_chosen = line.stopping_vehicle == state.vehicles.id[at(slot)];
    if ((was_chosen && !line.may_overrun) || had_time_to_stop(model, state, lane, slot, group)) {
        ++reports.violations.red_entries;
        reports.violations.record(
            {model.time_s(state.tick + 1), Violation::Kind::red_entry, lane, state.vehicles.id[at(slot)], -1});
    } else {
        ++reports.violations.forced_red_entries;
    }
}

// Records that the vehicle in `slot` has passed a detector in this step.
void pass_detector(const Model& model, State& state, const Reports& reports, int number, int slot) {
    const Detector& detector = model.detectors[at(number)];
    const VehicleArrays& v = state.vehicles;
    state.detectors.last_crossing_tick[at(number)] = state.tick + 1;
    if (model.records_all || model.records_detectors || detector.kind == Detector::Kind::zone) {
        reports.crossings.push_back({passing_time_s(model, state, slot, detector.position_m), v.id[at(slot)],
                                     v.policy[at(slot)], number, static_cast<float>(v.speed_mps[at(slot)]),
                                     v.length_m[at(slot)]});
    }
    if (detector.kind == Detector::Kind::stop_line) pass_stop_line(model, state, reports, detector.lane, slot);
}

}  // namespace

// Vehicles pass a detector in their order on the lane. The search therefore ends at the first vehicle that is still
// upstream of the detector.
void record_detector_crossings(const Model& model, State& state, Partition& part) {
    const VehicleArrays& v = state.vehicles;
    for (const int number : part.detectors) {
        const Detector& detector = model.detectors[at(number)];
        const LaneBlock& block = state.blocks[at(detector.lane)];
        int& upstream = state.detectors.upstream[at(number)];
        for (; upstream > 0; --upstream) {
            const int slot = block.past_last() - upstream;
            if (v.position_m[at(slot)] < detector.position_m) break;
            pass_detector(model, state, {part.crossings, part.violations}, number, slot);
        }
    }
}

void record_crossings_on_arrival(const Model& model, State& state, int lane, int slot) {
    for (const int number : state.detectors.on_lane.of(lane)) {
        if (state.vehicles.position_m[at(slot)] < model.detectors[at(number)].position_m) continue;
        --state.detectors.upstream[at(number)];
        pass_detector(model, state, {state.records.crossings, state.records.violations}, number, slot);
    }
}

}  // namespace stopline
