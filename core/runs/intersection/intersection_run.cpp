#include "runs/intersection/intersection_run.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "runs/driving/driving_meters.h"
#include "runs/hcm/hcm_sampler.h"
#include "scenario/build_model.h"
#include "scenario/fleets.h"
#include "signals/signal_controller.h"
#include "sim/insertion/insert_vehicles.h"

namespace stopline {

namespace {

// Samples values that cannot be computed from the recorded events of a run: the number of vehicles in the network, the
// queues at the start of green, and the vehicles that were queued.
class QueueSampler {
public:
    explicit QueueSampler(const Model& model, const TimeWindow& window)
        : model_(model),
          window_tick_(to_ticks(window.from_s, model.step_s)),
          second_ticks_(to_ticks(1.0, model.step_s)),
          queue_ticks_(std::max<std::int64_t>(to_ticks(kQueueSample_s, model.step_s), 1)),
          green_starts_(at(model.graph.signal_groups)),
          last_green_start_(at(model.graph.signal_groups), kNoGreen) {}

    void sample(const State& state) {
        if (state.tick % queue_ticks_ == 0) list_queued(state);
        record_green_starts(state);
        if (state.tick < window_tick_) return;
        if ((state.tick - window_tick_) % second_ticks_ == 0) {
            present_ += state.present();
            ++samples_;
        }
        for (int group = 0; group < model_.graph.signal_groups; ++group) {
            if (state.signals.lights[at(group)] != Light::green || state.signals.since_tick[at(group)] != state.tick)
                continue;
            for (const int lane : model_.graph.entries) {
                const Lane& road = model_.graph.lanes[at(lane)];
                if (road.signal_group == group) measure_queue(state, lane, road.stop_line_m);
            }
        }
    }

    // Returns true if the vehicle has driven at kQueuedSpeed_mps or slower upstream of its stop line.
    bool has_queued(int vehicle) const { return at(vehicle) < has_queued_.size() && has_queued_[at(vehicle)]; }

    // Returns the start of the latest green of a signal group at `time_s`; below 0 if no green has begun.
    double latest_green_start_s(int group, double time_s) const {
        const std::vector<std::int64_t>& starts = green_starts_[at(group)];
        const auto tick = static_cast<std::int64_t>(time_s / model_.step_s);
        const auto later = std::upper_bound(starts.begin(), starts.end(), tick);
        return model_.time_s(later == starts.begin() ? -1 : *std::prev(later));
    }

    void finish(IntersectionResult& result) const {
        result.vehicles_present =
            static_cast<double>(present_) / static_cast<double>(std::max<std::int64_t>(samples_, 1));
        result.queue_veh = static_cast<double>(queued_) / static_cast<double>(std::max<std::int64_t>(queues_, 1));
        result.longest_queue_m = longest_m_;
    }

private:
    static constexpr double kQueueSample_s = 0.2;

    void record_green_starts(const State& state) {
        for (std::size_t group = 0; group < green_starts_.size(); ++group) {
            const std::int64_t start = state.signals.green_start_tick[group];
            if (start != last_green_start_[group]) green_starts_[group].push_back(start);
            last_green_start_[group] = start;
        }
    }

    void list_queued(const State& state) {
        const VehicleArrays& v = state.vehicles;
        for (const int lane : model_.graph.entries) {
            const LaneBlock& block = state.blocks[at(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                if (v.speed_mps[at(slot)] > kQueuedSpeed_mps) continue;
                if (v.position_m[at(slot)] > model_.graph.lanes[at(lane)].stop_line_m) continue;
                const std::size_t vehicle = at(v.id[at(slot)]);
                if (vehicle >= has_queued_.size()) has_queued_.resize(2 * vehicle + 1, false);
                has_queued_[vehicle] = true;
            }
        }
    }

    void measure_queue(const State& state, int lane, double line_m) {
        const VehicleArrays& v = state.vehicles;
        const LaneBlock& block = state.blocks[at(lane)];
        ++queues_;
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            if (v.position_m[at(slot)] > line_m) continue;
            if (v.speed_mps[at(slot)] > kQueuedSpeed_mps) break;
            ++queued_;
            longest_m_ = std::max(longest_m_, line_m - v.position_m[at(slot)] + v.length_m[at(slot)]);
        }
    }

    const Model& model_;
    std::int64_t window_tick_;
    std::int64_t second_ticks_;
    std::int64_t queue_ticks_;
    std::vector<std::vector<std::int64_t>> green_starts_;  // [signal group] ticks
    std::vector<std::int64_t> last_green_start_;           // [signal group] tick, or kNoGreen
    std::vector<bool> has_queued_;                         // [vehicle]
    std::int64_t present_ = 0;
    std::int64_t samples_ = 0;
    std::int64_t queued_ = 0;
    std::int64_t queues_ = 0;
    double longest_m_ = 0.0;
};

// Returns the coordinates of all vehicles. An approach lane continues beyond its stop line to the point where its
// movements diverge. A vehicle with its front on this part of the lane is placed on its connection through the
// intersection.
std::vector<DrawnVehicle> snapshot_of(const Model& model, const State& state) {
    const VehicleArrays& v = state.vehicles;
    std::vector<DrawnVehicle> vehicles;
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        const LaneBlock& block = state.blocks[at(lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const Lane* road = &model.graph.lanes[at(lane)];
            double front_m = road->shape_start_m + v.position_m[at(slot)];
            if (road->signal_group >= 0 && v.position_m[at(slot)] > road->stop_line_m) {
                front_m = v.position_m[at(slot)] - road->stop_line_m;
                road = &model.graph.lanes[at(model.graph.routes[at(v.record[at(slot)].route)].lanes[1])];
            }
            const Point front = pose_at(road->shape, front_m).point;
            const Point rear = pose_at(road->shape, front_m - v.length_m[at(slot)]).point;
            vehicles.push_back({rear, front, v.policy[at(slot)]});
        }
    }
    return vehicles;
}

void take_snapshot(const Simulation& simulation, IntersectionResult& result) {
    const State& state = simulation.state();
    result.snapshot_s = simulation.time_s();
    result.snapshot = snapshot_of(simulation.model(), state);
    result.snapshot_lights = state.signals.lights;
}

void count_turns(const Model& model, const State& state, IntersectionResult& result) {
    int all = 0;
    for (const Passage& passage : state.records.passages) {
        if (passage.from_lane < 0 || passage.time_s < result.window.from_s || passage.time_s >= result.window.to_s) {
            continue;
        }
        const Lane& from = model.graph.lanes[at(passage.from_lane)];
        if (from.origin < 0) continue;
        ++all;
        double& share = from.turn == Turn::left    ? result.left_share
                        : from.turn == Turn::right ? result.right_share
                                                   : result.straight_share;
        share += 1.0;
    }
    result.throughput_veh_h = all * 3600.0 / result.window.length_s();
    for (double* share : {&result.straight_share, &result.right_share, &result.left_share}) *share /= std::max(all, 1);
}

void measure_zones(const Scenario& scenario, const Model& model, const State& state, IntersectionResult& result) {
    const auto lanes = static_cast<double>(model.graph.entries.size());
    for (std::size_t zone = 0; zone < scenario.measure.zone_radius_m.size(); ++zone) {
        const double path_m = 2.0 * scenario.measure.zone_radius_m[zone];
        result.zones.push_back(measure_zone(model.detectors, state.records.crossings, static_cast<int>(zone),
                                            result.window, lanes * path_m));
        const double free_s = path_m / scenario.network.intersection.speed_limit_mps;
        result.delay_s.push_back(result.zones.back().travel_time_s - free_s);
    }
}

// Returns the length of all lanes, m. For each entry lane, the function counts the approach, the straight way through
// the intersection, and one exit lane.
double road_m(const Scenario& scenario, const Model& model) {
    const IntersectionSettings& layout = scenario.network.intersection;
    const double lane_m = layout.approach_length_m + 2.0 * layout.radius_m + layout.exit_length_m;
    return static_cast<double>(model.graph.entries.size()) * lane_m;
}

double cycle_of(const Scenario& scenario) { return scenario.nominal_cycle().cycle_s; }

// Returns the time that an unobstructed vehicle needs to cross the intersection on the slowest connection, s. The time
// begins with the front at the stop line and ends with the rear on the exit lane. The vehicle drives at the speed limit
// of the connection.
double slowest_crossing_s(const Model& model) {
    double longest_m = 0.0;
    for (const PowertrainTables& vehicle : model.vehicles) longest_m = std::max(longest_m, vehicle.length_m);
    double slowest_s = 0.0;
    for (const Lane& connection : model.graph.lanes) {
        if (connection.origin < 0) continue;
        const Lane& origin = model.graph.lanes[at(connection.origin)];
        const double crossing_m = origin.length_m - origin.stop_line_m + connection.length_m + longest_m;
        slowest_s = std::max(slowest_s, crossing_m / connection.limit_mps);
    }
    return slowest_s;
}

// Returns the sum of the phases that follow one another if each green lasts as long as possible, s. Phases of several
// rings run at the same time, from barrier to barrier.
double longest_cycle_s(const std::vector<PhaseSettings>& phases) {
    std::map<int, std::map<int, double>> rings_s;  // [barrier][ring]
    for (const PhaseSettings& phase : phases) {
        rings_s[phase.barrier][phase.ring] += phase.longest_green_s() + phase.yellow_s + phase.all_red_s;
    }
    double sum_s = 0.0;
    for (const auto& [barrier, ring_s] : rings_s) {
        double longest_s = 0.0;
        for (const auto& [ring, phases_s] : ring_s) longest_s = std::max(longest_s, phases_s);
        sum_s += longest_s;
    }
    return sum_s;
}

// Returns the longest possible cycle of the signal, s. A controller that reacts to traffic can extend each green up to
// its max_green.
double longest_cycle_s(const Scenario& scenario) {
    double longest_s = cycle_of(scenario);
    if (find_signal_controller(scenario.signal.controller).follows_programme) return longest_s;
    longest_s = std::max(longest_s, longest_cycle_s(scenario.signal.phases));
    for (const ProgrammeSettings& programme : scenario.signal.programmes) {
        longest_s = std::max(longest_s, longest_cycle_s(programme.phases));
    }
    return longest_s;
}

// Returns the shortest stay in the intersection that counts as a deadlock, s.
double deadlock_limit_s(const Scenario& scenario, const Model& model) {
    return std::max(2.0 * longest_cycle_s(scenario), kMinDeadlock_s) + slowest_crossing_s(model);
}

}  // namespace

TimeWindow first_cycle(const Scenario& scenario) {
    const double cycle_s = cycle_of(scenario);
    const double from_s = scenario.signal.first_green_s + scenario.measure.warmup_cycles * cycle_s;
    return {from_s, from_s + cycle_s};
}

TimeWindow measured_window(const Scenario& scenario) {
    const double from_s = first_cycle(scenario).from_s;
    if (scenario.duration_s == 0.0) return {from_s, from_s + scenario.measure.cycles * cycle_of(scenario)};
    return {from_s, scenario.duration_s};
}

IntersectionResult run_intersection(const Scenario& scenario, std::size_t population,
                                    const std::function<bool(const Simulation&)>& on_step,
                                    const Observation& observation) {
    Model model = build_model(scenario, population);
    observation.prepare(model);
    HcmSampler::prepare(scenario, model);
    // The simulation checks once a second for starving movements.
    model.rules.watch_ticks = std::max<std::int64_t>(to_ticks(1.0, model.step_s), 1);
    Simulation simulation(model);
    IntersectionResult result;
    result.population = scenario.populations.at(population).name;
    result.window = measured_window(scenario);
    result.complete = true;
    QueueSampler sampler(model, result.window);
    DrivingMeters driving(scenario, population, model);
    DeadlockSearch deadlocks(model, deadlock_limit_s(scenario, model));
    std::optional<HcmSampler> hcm;
    if (asks_for_hcm(scenario)) hcm.emplace(scenario, model);
    const std::int64_t end_tick = to_ticks(result.window.to_s, model.step_s);
    const std::int64_t snapshot_tick =
        to_ticks(result.window.from_s + second_green_middle_s(scenario.signal), model.step_s);
    while (simulation.state().tick < end_tick) {
        if (on_step && !on_step(simulation)) {
            result.complete = false;
            break;
        }
        if (simulation.state().tick == snapshot_tick) take_snapshot(simulation, result);
        sampler.sample(simulation.state());
        driving.observe(simulation.state());
        if (hcm) hcm->sample(simulation.state());
        observation.call(population, simulation);
        simulation.step();
        deadlocks.observe(simulation.state());
    }
    const State& state = simulation.state();
    if (result.complete) observation.call(population, simulation);
    sampler.finish(result);
    driving.observe(state);
    result.driving = driving.finish(state, result.window);
    if (hcm) {
        hcm->sample(state);
        result.hcm = hcm->rows(result.window);
    }
    const double mean_length_m = mean_vehicle_m(scenario, scenario.populations.at(population));
    result.occupied = result.vehicles_present * mean_length_m / road_m(scenario, model);
    count_turns(model, state, result);
    measure_zones(scenario, model, state, result);
    const auto latest_green_start_s = [&](int signal_group, double time_s) {
        return sampler.latest_green_start_s(signal_group, time_s);
    };
    result.discharge = discharge(model.graph, model.detectors, state.records.crossings, result.window,
                                 latest_green_start_s, model.time_s(model.signals[0].nominal_cycle_ticks),
                                 [&](int vehicle) { return sampler.has_queued(vehicle); });
    result.gaps_accepted = static_cast<std::int64_t>(state.records.gaps_accepted.size());
    result.longest_in_junction_s = model.time_s(state.records.longest_in_junction_ticks);
    result.starvations = state.congestion.delays.starvations;
    result.violations = state.records.violations;
    result.v2v = v2v_result(state.records, model.v2v_plan);
    result.vehicle_names = VehicleNames(model, state);
    result.departure = departure_delays(model, state);
    result.backlog = insertion_backlog(model, state);
    result.deadlock = deadlocks.deadlock();
    result.violations.deadlocks = result.deadlock ? 1 : 0;
    result.entered = state.records.entered;
    result.exited = state.records.exited;
    result.updates = state.records.updates;
    result.state_hash = simulation.state_hash();
    return result;
}

}  // namespace stopline
