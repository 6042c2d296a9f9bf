#include "runs/hcm/hcm_sampler.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/insertion/insert_vehicles.h"

namespace stopline {

namespace {

constexpr double kHcmSample_s = 0.1;
// A vehicle that brakes harder than this on a lane with a stop line slows for this stop line.
constexpr double kSlowing_mps2 = 0.5;

// Returns the name of a lane without the number at its end, such as west_in for west_in_0.
std::string approach_of(const std::string& lane) {
    const std::size_t end = lane.find_last_of('_');
    const bool has_number = end != std::string::npos && end + 1 < lane.size() &&
                            lane.find_first_not_of("0123456789", end + 1) == std::string::npos;
    return has_number ? lane.substr(0, end) : lane;
}

}  // namespace

void HcmSampler::prepare(const Scenario& scenario, Model& model) {
    if (asks_for_hcm(scenario)) model.records_detectors = true;
}

HcmSampler::HcmSampler(const Scenario& scenario, const Model& model)
    : model_(model),
      sample_ticks_(std::max<std::int64_t>(to_ticks(kHcmSample_s, model.step_s), 1)),
      sample_s_(static_cast<double>(sample_ticks_) * model.step_s),
      free_flow_share_(model.meso ? model.leader_speed_share : 1.0),
      record_of_(model.graph.lanes.size(), -1),
      records_of_group_(at(model.graph.signal_groups)),
      cycles_(model) {
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        const Lane& road = model.graph.lanes[at(lane)];
        const int group = road.signal_group;
        if (group < 0 || road.origin >= 0 || !model.signals.place_of(group).is_known) continue;
        record_of_[at(lane)] = static_cast<int>(records_.size());
        records_of_group_[at(group)].push_back(static_cast<int>(records_.size()));
        HcmRecord record;
        record.lane = lane;
        record.approach = approach_of(road.name);
        record.intersection = std::to_string(model.signals.place_of(group).signal);
        records_.push_back(std::move(record));
    }
    for (int inlet = 0; inlet < static_cast<int>(model.demand.inlets.size()); ++inlet) {
        const DemandPlan::Inlet& planned = model.demand.inlets[at(inlet)];
        if (record_of_[at(planned.lane)] < 0) continue;
        records_[at(record_of_[at(planned.lane)])].has_endless_demand =
            scenario.demand.kind == "saturated" && planned.vehicles > 0 && planned.headway_s <= 0.0;
    }
    open_.resize(records_.size());
    lane_cycles_.resize(records_.size());
}

HcmSampler::Track& HcmSampler::track_of(int vehicle) {
    if (at(vehicle) >= tracks_.size()) tracks_.resize(2 * at(vehicle) + 64);
    return tracks_[at(vehicle)];
}

void HcmSampler::sample(const State& state) {
    if (state.tick % sample_ticks_ != 0) return;
    note_passages(state);
    note_teleports(state);
    for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
        if (state.blocks[at(lane)].first < state.blocks[at(lane)].past_last()) visit_lane(state, lane);
    }
    note_lights(state);
    cycles_.update(state);  // a green that ends together with the start of a new cycle belongs to the old cycle
    note_cycles(state);
}

// Moves vehicles that have passed a stop line from their approach to HcmRecord::passages.
void HcmSampler::note_passages(const State& state) {
    for (; next_crossing_ < state.records.crossings.size(); ++next_crossing_) {
        const Crossing& crossing = state.records.crossings[next_crossing_];
        const Detector& detector = model_.detectors[at(crossing.detector)];
        if (detector.kind != Detector::Kind::stop_line || record_of_[at(detector.lane)] < 0) continue;
        const int record = record_of_[at(detector.lane)];
        Track& track = track_of(crossing.vehicle);
        std::vector<HcmPassage>& passages = records_[at(record)].passages;
        passages.push_back({crossing.time_s, track.delay_s, track.stops, track.has_queued});
        const std::size_t passage = passages.size() - 1;
        track = {};
        track.last_record = record;
        track.passage = passage;
    }
}

// Counts the vehicles that a teleport has removed before their stop line.
void HcmSampler::note_teleports(const State& state) {
    const std::vector<RuleUse>& uses = state.congestion.delays.rule_uses;
    for (; next_rule_use_ < uses.size(); ++next_rule_use_) {
        const RuleUse& use = uses[next_rule_use_];
        if (use.kind != RuleUse::Kind::teleported || record_of_[at(use.lane)] < 0) continue;
        Track& track = track_of(use.vehicle);
        if (track.record != record_of_[at(use.lane)]) continue;  // beyond the stop line
        ++open_[at(track.record)].interval.teleported_veh;
        track = {};
    }
}

void HcmSampler::visit_lane(const State& state, int lane) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    const Lane& road = model_.graph.lanes[at(lane)];
    const int record = record_of_[at(lane)];
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (v.id[at(slot)] < 0) continue;  // free slot
        Track& track = track_of(v.id[at(slot)]);
        const double speed_mps = v.speed_mps[at(slot)];
        const double free_mps = free_flow_share_ * state.plan.free_speed_mps(lane, v.policy[at(slot)]);
        const double lost_s = std::max(sample_s_ * (1.0 - speed_mps / free_mps), 0.0);
        const bool is_before_line = record >= 0 && v.position_m[at(slot)] <= road.stop_line_m;
        if (track.last_record >= 0) {
            const bool slows = is_before_line && v.acceleration_mps2[at(slot)] < -kSlowing_mps2;
            if (speed_mps >= kFreeFlowShare * free_mps || slows) {
                track.last_record = -1;
            } else {
                records_[at(track.last_record)].passages[track.passage].delay_s += lost_s;
            }
        }
        if (is_before_line) {
            approach_line(track, record, road.stop_line_m - v.position_m[at(slot)], speed_mps, lost_s,
                          v.length_m[at(slot)]);
        }
    }
}

// Adds the delay of a vehicle before its stop line, and notes stops and queues. `to_line_m`: distance of its front.
void HcmSampler::approach_line(Track& track, int record, double to_line_m, double speed_mps, double lost_s,
                               double length_m) {
    track.record = record;  // after a lane change, the vehicle keeps its delay
    if (track.last_record < 0) track.delay_s += lost_s;
    if (speed_mps > 2.0 * kQueuedSpeed_mps) track.is_slow = false;
    if (speed_mps > kQueuedSpeed_mps) return;
    HcmInterval& interval = open_[at(record)].interval;
    if (!track.is_slow) ++track.stops;
    if (!track.has_queued) ++interval.back_veh;
    track.is_slow = true;
    track.has_queued = true;
    interval.back_m = std::max(interval.back_m, to_line_m + length_m);
}

// Begins and ends intervals and greens.
void HcmSampler::note_lights(const State& state) {
    if (lights_.empty()) lights_.assign(records_of_group_.size(), Light::red);
    for (std::size_t group = 0; group < records_of_group_.size(); ++group) {
        const Light light = state.signals.lights[group];
        if (light == lights_[group]) continue;
        const double since_s = model_.time_s(state.signals.since_tick[group]);
        for (const int record : records_of_group_[group]) {
            HcmInterval& interval = open_[at(record)].interval;
            if (light == Light::green) {
                interval.green_from_s = since_s;
                records_[at(record)].green_starts_s.push_back(since_s);
            } else if (lights_[group] == Light::green) {
                interval.green_to_s = since_s;
                interval.is_used = queued_before_line(state, record) > 0;
                lane_cycles_[at(record)].of_last_green = cycles_.number(static_cast<int>(group));
            }
            if (light == Light::red) end_green_interval(state, record, since_s);
        }
        lights_[group] = light;
    }
}

// Ends the interval of a lane at the start of a red. Does nothing if the interval has had no green. The first red of a
// run begins the first interval.
void HcmSampler::end_green_interval(const State& state, int record, double now_s) {
    const bool has_begun = open_[at(record)].has_begun;
    std::int64_t& cycle = lane_cycles_[at(record)].of_last_green;
    if (has_begun && !open_[at(record)].interval.has_green()) return;
    if (cycle == SignalCycles::kNoCycle) cycle = cycles_.number(group_of(record));  // the run began with yellow
    begin_interval(state, record, now_s, cycle);
}

// Called when a signal may have begun a new cycle. Ends the interval of each lane in whose last cycle no green ended.
void HcmSampler::note_cycles(const State& state) {
    for (int record = 0; record < static_cast<int>(records_.size()); ++record) {
        const int group = group_of(record);
        LaneCycles& cycles = lane_cycles_[at(record)];
        const std::int64_t ended = std::exchange(cycles.present, cycles_.number(group));
        records_[at(record)].last_cycle = cycles.present;
        if (cycles.present == ended || ended == SignalCycles::kNoCycle) continue;
        if (cycles.of_last_green == ended) continue;
        const double now_s = model_.time_s(cycles_.start_tick(group));
        const bool is_green = lights_[at(group)] == Light::green;
        if (is_green && !open_[at(record)].has_begun) continue;
        HcmInterval& interval = open_[at(record)].interval;
        if (is_green) {
            interval.green_to_s = now_s;
            interval.green_goes_on = true;
        }
        begin_interval(state, record, now_s, ended);
        if (is_green) open_[at(record)].interval.green_from_s = now_s;
    }
}

// Ends the open interval of a lane, which belongs to a cycle, and begins the next one.
void HcmSampler::begin_interval(const State& state, int record, double now_s, std::int64_t cycle) {
    OpenInterval& open = open_[at(record)];
    const int residual = queued_before_line(state, record);
    HcmInterval& ended = open.interval;
    ended.to_s = now_s;
    ended.residual_veh = residual;
    ended.present_veh = present_before_line(state, record);
    ended.cycle = cycle;
    if (open.has_begun) {
        records_[at(record)].intervals.push_back(ended);
    } else {
        records_[at(record)].first_cycle = cycle;
    }
    const int present = ended.present_veh;
    open = {true, {}};
    open.interval.from_s = now_s;
    open.interval.residual_before_veh = residual;
    open.interval.present_before_veh = present;
    open.interval.back_veh = residual;
}

// Returns the number of queued vehicles before the stop line.
int HcmSampler::queued_before_line(const State& state, int record) const {
    const int lane = records_[at(record)].lane;
    const LaneBlock& block = state.blocks[at(lane)];
    int queued = 0;
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (state.vehicles.position_m[at(slot)] > model_.graph.lanes[at(lane)].stop_line_m) continue;
        const int vehicle = state.vehicles.id[at(slot)];
        if (vehicle >= 0 && at(vehicle) < tracks_.size() && tracks_[at(vehicle)].has_queued) ++queued;
    }
    return queued;
}

// Returns the number of vehicles before the stop line, with those that wait to enter the lane.
int HcmSampler::present_before_line(const State& state, int record) const {
    const int lane = records_[at(record)].lane;
    const LaneBlock& block = state.blocks[at(lane)];
    std::int64_t present = 0;
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        const bool is_before = state.vehicles.position_m[at(slot)] <= model_.graph.lanes[at(lane)].stop_line_m;
        present += is_before && state.vehicles.id[at(slot)] >= 0 ? 1 : 0;
    }
    const int inlet = state.insertion.inlet_of[at(lane)];
    if (inlet >= 0 && !records_[at(record)].has_endless_demand) {
        present += departure_delays(model_, state, inlet).vehicles - state.insertion.inlets[at(inlet)].delays.vehicles;
    }
    return static_cast<int>(present);
}

std::vector<HcmRow> HcmSampler::rows(const TimeWindow& window) const {
    return hcm_rows(model_.graph, records_, window);
}

}  // namespace stopline
