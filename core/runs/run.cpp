#include "runs/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "base/containers/index.h"
#include "runs/driving/driving_meters.h"
#include "runs/hcm/hcm_sampler.h"
#include "scenario/build_model.h"
#include "sim/insertion/insert_vehicles.h"
#include "sim/perception/look_ahead.h"
#include "sim/state/queries/gap.h"

namespace stopline {

namespace {

// Returns the distance from the start of a route to the start of its lane number `route_index`, m.
double lane_start_m(const Model& model, int route, int route_index) {
    double distance_m = 0.0;
    for (int k = 0; k < route_index; ++k) {
        distance_m += model.graph.lanes[at(model.graph.routes[at(route)].lanes[at(k)])].length_m;
    }
    return distance_m;
}

struct LeaderGap {
    double net_gap_m = std::numeric_limits<double>::quiet_NaN();  // NaN: there is no leader
    double leader_length_m = 0.0;
};

// Returns the net gap to the leader. The first vehicle on a lane has its leader on another lane. This leader is
// searched within the range of the radar.
LeaderGap leader_gap(const Model& model, const State& state, int lane, int slot) {
    const VehicleArrays& v = state.vehicles;
    const bool first = slot == state.blocks[at(lane)].first;
    const LeaderAhead ahead =
        first ? leader_ahead(state, lane, slot, model.common_driver().cacc.radar_range_m) : LeaderAhead{slot - 1, 0.0};
    if (ahead.slot < 0) return {};
    return {rear_m(state, ahead) - v.position_m[at(slot)], model.vehicles[at(v.type_of(at(ahead.slot)))].length_m};
}

// Returns the gaps between the vehicles of the first lane.
std::vector<QueueGap> queue_gaps(const State& state) {
    std::vector<QueueGap> gaps;
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[0];
    for (std::size_t i = at(block.first) + 1; i < at(block.past_last()); ++i)
        gaps.push_back({net_gap_m(v, i - 1, i), v.standstill_gap_m[i]});
    return gaps;
}

void finish(const Simulation& simulation, RunResult& result) {
    const State& state = simulation.state();
    const std::vector<Lane>& lanes = simulation.model().graph.lanes;
    for (const Passage& passage : state.records.passages) {
        if (passage.from_lane < 0 || lanes[at(passage.from_lane)].signal_group < 0) continue;
        result.stop_line_times_s.push_back(passage.time_s - result.green_start_s);
    }
    std::sort(result.stop_line_times_s.begin(), result.stop_line_times_s.end());
    result.passages = state.records.passages;
    result.violations = state.records.violations;
    result.v2v = v2v_result(state.records, simulation.model().v2v_plan);
    result.vehicle_names = VehicleNames(simulation.model(), state);
    result.departure = departure_delays(simulation.model(), state);
    result.backlog = insertion_backlog(simulation.model(), state);
    result.vehicles_entered = state.records.entered;
    result.vehicles_exited = state.records.exited;
    result.updates = state.records.updates;
    result.state_hash = simulation.state_hash();
}

}  // namespace

void sample_vehicles(const Simulation& simulation, std::vector<TrajectoryPoint>& points) {
    const State& state = simulation.state();
    const VehicleArrays& v = state.vehicles;
    for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
        const LaneBlock& block = state.blocks[at(lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const std::size_t i = at(slot);
            const VehicleRecord& record = v.record[i];
            const double start_m = lane_start_m(simulation.model(), record.route, record.route_index);
            const bool full = v.has_powertrain();
            const LeaderGap gap = leader_gap(simulation.model(), state, lane, slot);
            points.push_back({simulation.time_s(), v.id[i], v.policy[i], lane, start_m + v.position_m[i],
                              v.position_m[i], v.speed_mps[i], v.acceleration_mps2[i],
                              full ? v.request_mps2[i] : v.acceleration_mps2[i], gap.net_gap_m,
                              full ? static_cast<int>(v.gear[i]) + 1 : 0, gap.leader_length_m});
        }
    }
}

int RunResult::passed_within(double green_s) const {
    const auto end = std::upper_bound(stop_line_times_s.begin(), stop_line_times_s.end(), green_s);
    return static_cast<int>(end - stop_line_times_s.begin());
}

RunResult run_population(const Scenario& scenario, std::size_t population, const RunOptions& options) {
    Model model = build_model(scenario, population);
    options.observation.prepare(model);
    HcmSampler::prepare(scenario, model);
    Simulation simulation(model);
    std::optional<HcmSampler> hcm;
    if (asks_for_hcm(scenario)) hcm.emplace(scenario, model);
    RunResult result;
    result.population = scenario.populations[population].name;
    result.green_start_s = scenario.signal.first_green_s;
    const std::int64_t end_tick = to_ticks(scenario.duration_s, scenario.tick_s());
    const std::int64_t green_tick = to_ticks(scenario.signal.first_green_s, scenario.tick_s());
    const std::int64_t sample_ticks =
        std::max<std::int64_t>(1, to_ticks(options.trajectory_interval_s, scenario.tick_s()));
    DrivingMeters driving(scenario, population, model);
    constexpr std::int64_t kProgressSteps = 1000;
    bool has_started = false;  // the first green has begun
    const auto begin = std::chrono::steady_clock::now();
    result.complete = true;
    while (simulation.state().tick < end_tick) {
        const std::int64_t tick = simulation.state().tick;
        if (!has_started && simulation.state().signals.green_start_tick[0] == tick) {
            has_started = true;
            result.queue_gaps = queue_gaps(simulation.state());
            if (tick != green_tick) result.green_start_s = simulation.time_s();
        }
        const double now_s = simulation.time_s();
        const bool is_sampled = options.trajectory_interval_s > 0.0 && now_s >= options.trajectory_from_s &&
                                now_s <= options.trajectory_until_s;
        if (is_sampled && tick % sample_ticks == 0) sample_vehicles(simulation, result.trajectory);
        if (options.on_progress && tick % kProgressSteps == 0) {
            result.complete = options.on_progress(static_cast<double>(tick) / static_cast<double>(end_tick));
            if (!result.complete) break;
        }
        driving.observe(simulation.state());
        if (hcm) hcm->sample(simulation.state());
        options.observation.call(population, simulation);
        simulation.step();
    }
    if (result.complete) options.observation.call(population, simulation);
    result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    finish(simulation, result);
    driving.observe(simulation.state());
    result.driving = driving.finish(simulation.state(), std::nullopt);
    if (hcm) {
        hcm->sample(simulation.state());
        result.hcm = hcm->rows({0.0, simulation.time_s() + scenario.tick_s()});
    }
    return result;
}

}  // namespace stopline
