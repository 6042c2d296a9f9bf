#include "experiment/intersection_run.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "experiment/build_model.h"

namespace stopline {

namespace {

constexpr double kStanding_mps = 5.0 / 3.6;  // Highway Capacity Manual: queued below walking speed

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Samples what events do not tell: vehicles present, queues at the start of green.
class Sampler {
public:
    explicit Sampler(const Model& model, const TimeWindow& window)
        : model_(model), first_(to_ticks(window.from_s, model.step_s)), every_(to_ticks(1.0, model.step_s)) {}

    void look(const State& state) {
        if (state.tick < first_) return;
        if ((state.tick - first_) % every_ == 0) {
            present_ += state.present();
            ++samples_;
        }
        for (int group = 0; group < static_cast<int>(model_.signals.size()); ++group) {
            const GroupProgramme& programme = model_.signals[at(group)];
            if (programme.since(state.tick) != state.tick || programme.light(state.tick) != Light::green) continue;
            for (const int lane : model_.graph.entries) {
                const Lane& road = model_.graph.lanes[at(lane)];
                if (road.signal_group == group) measure_queue(state, lane, road.stop_line_m);
            }
        }
    }

    void finish(IntersectionFigures& figures) const {
        figures.vehicles_present =
            static_cast<double>(present_) / static_cast<double>(std::max<std::int64_t>(samples_, 1));
        figures.queue_veh = static_cast<double>(queued_) / static_cast<double>(std::max<std::int64_t>(queues_, 1));
        figures.longest_queue_m = longest_m_;
    }

private:
    void measure_queue(const State& state, int lane, double line_m) {
        const VehicleArrays& v = state.vehicles;
        const LaneBlock& block = state.blocks[at(lane)];
        ++queues_;
        for (int slot = block.first; slot < block.stop(); ++slot) {
            if (v.position_m[at(slot)] > line_m) continue;
            if (v.speed_mps[at(slot)] > kStanding_mps) break;
            ++queued_;
            longest_m_ = std::max(longest_m_, line_m - v.position_m[at(slot)] + v.length_m[at(slot)]);
        }
    }

    const Model& model_;
    std::int64_t first_;
    std::int64_t every_;
    std::int64_t present_ = 0;
    std::int64_t samples_ = 0;
    std::int64_t queued_ = 0;
    std::int64_t queues_ = 0;
    double longest_m_ = 0.0;
};

// Where vehicles are; behind the stop line they are on their own path already.
std::vector<DrawnVehicle> picture_of(const Model& model, const State& state) {
    const VehicleArrays& v = state.vehicles;
    std::vector<DrawnVehicle> vehicles;
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        const LaneBlock& block = state.blocks[at(lane)];
        for (int slot = block.first; slot < block.stop(); ++slot) {
            const Lane* road = &model.graph.lanes[at(lane)];
            double front_m = road->shape_start_m + v.position_m[at(slot)];
            if (road->signal_group >= 0 && v.position_m[at(slot)] > road->stop_line_m) {
                front_m = v.position_m[at(slot)] - road->stop_line_m;
                road = &model.graph.lanes[at(model.graph.routes[at(v.record[at(slot)].route)].lanes[1])];
            }
            const Point front = place_at(road->shape, front_m).point;
            const Point rear = place_at(road->shape, front_m - v.length_m[at(slot)]).point;
            vehicles.push_back({rear, front, v.policy[at(slot)]});
        }
    }
    return vehicles;
}

void take_picture(const Simulation& simulation, IntersectionFigures& figures) {
    const State& state = simulation.state();
    figures.picture_s = simulation.time_s();
    figures.picture = picture_of(simulation.model(), state);
    for (const GroupProgramme& programme : simulation.model().signals) {
        figures.picture_lights.push_back(programme.light(state.tick));
    }
}

void count_turns(const Model& model, const State& state, IntersectionFigures& figures) {
    int all = 0;
    for (const Passage& passage : state.passages) {
        if (passage.from_lane < 0 || passage.time_s < figures.window.from_s || passage.time_s >= figures.window.to_s) {
            continue;
        }
        const Lane& from = model.graph.lanes[at(passage.from_lane)];
        if (from.origin < 0) continue;
        ++all;
        double& share = from.turn == Turn::left    ? figures.left
                        : from.turn == Turn::right ? figures.right
                                                   : figures.straight;
        share += 1.0;
    }
    figures.throughput_veh_h = all * 3600.0 / figures.window.length_s();
    for (double* share : {&figures.straight, &figures.right, &figures.left}) *share /= std::max(all, 1);
}

void measure_zones(const Scenario& scenario, const Model& model, const State& state, IntersectionFigures& figures) {
    const auto lanes = static_cast<double>(model.graph.entries.size());
    for (std::size_t zone = 0; zone < scenario.measure.zone_radius_m.size(); ++zone) {
        const double path_m = 2.0 * scenario.measure.zone_radius_m[zone];
        figures.zones.push_back(
            zone_figures(model.detectors, state.crossings, static_cast<int>(zone), figures.window, lanes * path_m));
        const double free_s = path_m / scenario.network.intersection.speed_limit_mps;
        figures.delay_s.push_back(figures.zones.back().travel_time_s - free_s);
    }
}

// Length of all lanes, those through the intersection counted once, straight.
double road_m(const Scenario& scenario, const Model& model) {
    const IntersectionSettings& layout = scenario.network.intersection;
    const double lane_m = layout.approach_length_m + 2.0 * layout.radius_m + layout.exit_length_m;
    return static_cast<double>(model.graph.entries.size()) * lane_m;
}

double cycle_of(const Scenario& scenario) { return scenario.signal.both_stages_s(); }

// From the stop line until wholly on the exit, at the limits of the way.
double slowest_crossing_s(const Model& model) {
    double slowest_s = 0.0;
    for (const Lane& way : model.graph.lanes) {
        if (way.origin < 0) continue;
        const Lane& origin = model.graph.lanes[at(way.origin)];
        const double way_m = origin.length_m - origin.stop_line_m + way.length_m + model.vehicles[0].length_m;
        slowest_s = std::max(slowest_s, way_m / way.limit_mps);
    }
    return slowest_s;
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

IntersectionFigures run_intersection(const Scenario& scenario, std::size_t population,
                                     const std::function<bool(const Simulation&)>& on_step,
                                     const Observation& observation) {
    Model model = build_model(scenario, population);
    observation.prepare(model);
    Simulation simulation(model);
    IntersectionFigures figures;
    figures.population = scenario.populations.at(population).name;
    figures.window = measured_window(scenario);
    figures.complete = true;
    Sampler sampler(model, figures.window);
    const std::int64_t last = to_ticks(figures.window.to_s, model.step_s);
    const double second_s = figures.window.from_s + scenario.signal.stage_s(0);  // green of the streets that cross
    const std::int64_t picture = to_ticks(second_s + 0.5 * scenario.signal.green_of_s(1), model.step_s);
    while (simulation.state().tick < last) {
        if (on_step && !on_step(simulation)) {
            figures.complete = false;
            break;
        }
        if (simulation.state().tick == picture) take_picture(simulation, figures);
        sampler.look(simulation.state());
        observation.call(population, simulation);
        simulation.step();
    }
    const State& state = simulation.state();
    if (figures.complete) observation.call(population, simulation);
    sampler.finish(figures);
    figures.occupied = figures.vehicles_present * scenario.vehicle.length_m / road_m(scenario, model);
    count_turns(model, state, figures);
    measure_zones(scenario, model, state, figures);
    figures.discharge = discharge(model, state.crossings, figures.window);
    figures.gaps_accepted = static_cast<std::int64_t>(state.gaps_accepted.size());
    figures.longest_inside_s = model.time_s(state.longest_inside);
    figures.violations = state.violations;
    const double too_long_s = 2.0 * cycle_of(scenario) + slowest_crossing_s(model);
    figures.violations.deadlocks = figures.longest_inside_s >= too_long_s ? 1 : 0;
    figures.entered = state.entered;
    figures.left_network = state.left;
    figures.updates = state.updates;
    figures.state_hash = simulation.state_hash();
    return figures;
}

}  // namespace stopline
