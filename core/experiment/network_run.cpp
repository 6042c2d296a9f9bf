#include "experiment/network_run.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "experiment/build_model.h"
#include "measure/steady_state.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Whether vehicles get to the lane from outside of the network: they enter it there, or on a lane beside it.
bool from_outside(const LaneGraph& graph, int lane) {
    const int approach = graph.lanes[at(lane)].approach;
    return std::any_of(graph.entries.begin(), graph.entries.end(), [&](int entry) {
        return entry == lane || (approach >= 0 && graph.lanes[at(entry)].approach == approach);
    });
}

// The whole network is measured: vehicles come where their trips begin, and leave where they end.
void watch_trips(Model& model) {
    model.trips_begin = static_cast<int>(model.detectors.size());
    model.detectors.push_back({-1, 0.0, Detector::Kind::zone, 0, false});
    model.trips_end = static_cast<int>(model.detectors.size());
    model.detectors.push_back({-1, 0.0, Detector::Kind::zone, 0, true});
}

// Vehicles that enter between two intersections are in the area from then on; all others on those lanes came into it before.
void watch_inner_inlets(Model& model) {
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        if (inlet.vehicles == 0 || from_outside(model.graph, inlet.lane)) continue;
        model.detectors.push_back({inlet.lane, 0.0, Detector::Kind::zone, 0, false});
    }
}

// Where vehicles come into the area that is measured, or leave it: on the lanes by which they enter and leave the network. Pockets that
// lie in it wholly are entered from lanes beside them.
void watch_area(const Scenario& scenario, Model& model) {
    if (scenario.network.is_sumo()) return watch_trips(model);
    std::erase_if(model.detectors, [](const Detector& d) { return d.kind != Detector::Kind::stop_line; });
    const double outside_m = scenario.measure.outside_m;
    model.area_begins_m.assign(model.graph.lanes.size(), 0.0);
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        const Lane& road = model.graph.lanes[at(lane)];
        if (road.origin >= 0) continue;
        const bool within = road.begin_m > 0.0 && road.stop_line_m <= outside_m;
        if (road.signal_group < 0) {
            model.detectors.push_back({lane, outside_m, Detector::Kind::zone, 0, true});
        } else if (from_outside(model.graph, lane) && !within) {
            model.area_begins_m[at(lane)] = road.stop_line_m - outside_m;
            model.detectors.push_back({lane, model.area_begins_m[at(lane)], Detector::Kind::zone, 0, false});
        }
    }
    watch_inner_inlets(model);
}

// Of all lanes in the area; an intersection counts once for each lane that leads to it, straight across.
double area_lane_m(const Scenario& scenario, const Model& model) {
    double sum_m = 0.0;
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        const Lane& road = model.graph.lanes[at(lane)];
        if (road.origin >= 0) continue;
        if (scenario.network.is_sumo()) {
            sum_m += road.length_m;
        } else if (road.signal_group < 0) {
            sum_m += scenario.measure.outside_m;
        } else {
            const bool within = road.begin_m > 0.0 && road.stop_line_m <= scenario.measure.outside_m;
            sum_m += from_outside(model.graph, lane) && !within ? scenario.measure.outside_m : road.stop_line_m;
            sum_m += 2.0 * radius_beyond_m(scenario.network, road);
        }
    }
    return sum_m;
}

// Notes at the end of each interval what has come up to then.
class Sampler {
public:
    Sampler(const Scenario& scenario, const Model& model)
        : every_(to_ticks(scenario.measure.interval_s, model.step_s)), second_(to_ticks(1.0, model.step_s)) {}

    void look(const State& state) {
        if (state.tick % second_ == 0) present_.push_back(state.present());
        if (state.tick % every_ != 0 || state.tick == 0) return;
        NetworkInterval interval;
        for (std::size_t cause = 0; cause < interval.lost_s.size(); ++cause) {
            interval.lost_s[cause] = state.hindrance.lost_s[cause] - lost_s_[cause];
        }
        interval.taken_out = state.hindrance.taken_out - taken_out_;
        lost_s_ = state.hindrance.lost_s;
        taken_out_ = state.hindrance.taken_out;
        series_.push_back(interval);
    }

    std::vector<NetworkInterval> series() const { return series_; }
    int most_present() const { return present_.empty() ? 0 : *std::max_element(present_.begin(), present_.end()); }
    double mean_present(const TimeWindow& window) const {
        double sum = 0.0;
        int samples = 0;
        for (std::size_t s = 0; s < present_.size(); ++s) {
            if (!window.contains(static_cast<double>(s))) continue;
            sum += present_[s];
            ++samples;
        }
        return samples > 0 ? sum / samples : std::numeric_limits<double>::quiet_NaN();
    }

private:
    std::int64_t every_;
    std::int64_t second_;
    std::array<double, kCauseNames.size()> lost_s_{};
    std::int64_t taken_out_ = 0;
    std::vector<NetworkInterval> series_;
    std::vector<int> present_;  // [second]
};

// Mean over whole intervals from `from_s` on; NaN where there is none.
AreaFigures mean_of(const std::vector<NetworkInterval>& series, double from_s) {
    AreaFigures mean;
    double travel_s = 0.0;
    int intervals = 0;
    for (const NetworkInterval& each : series) {
        if (each.area.window.from_s < from_s) continue;
        if (intervals == 0) mean.window.from_s = each.area.window.from_s;
        mean.window.to_s = each.area.window.to_s;
        ++intervals;
        mean.left += each.area.left;
        if (each.area.left > 0) travel_s += each.area.left * each.area.travel_time_s;
        mean.vehicles += each.area.vehicles;
        mean.occupied += each.area.occupied;
    }
    const double none = std::numeric_limits<double>::quiet_NaN();
    mean.vehicles = intervals > 0 ? mean.vehicles / intervals : none;
    mean.occupied = intervals > 0 ? mean.occupied / intervals : none;
    mean.travel_time_s = mean.left > 0 ? travel_s / mean.left : none;
    return mean;
}

// A circle that the rules have not dissolved, and that is still there.
bool stays(const Gridlock& gridlock, double end_s, double cycle_s) {
    constexpr double kLasting_cycles = 6.0;  // twice the teleport's three
    return end_s - gridlock.to_s <= cycle_s && gridlock.to_s - gridlock.from_s >= kLasting_cycles * cycle_s;
}

// Whether and when a run breaks down, from what leaves the area in each cycle of the lights: what is chosen for the series has no say.
class StabilityVerdict {
public:
    StabilityVerdict(NetworkFigures& figures, const std::vector<AreaFigures>& cycles, double cycle_s)
        : figures_(figures), cycles_(cycles), cycle_s_(cycle_s), filled_(filled()) {}

    void pass(double end_s) {
        figures_.full_cycles = static_cast<int>(cycles_.size() - filled_);
        const HindranceLog& log = figures_.hindrance;
        if (const auto fall_s = log.gridlocks.empty() ? std::nullopt : falls_at()) {
            return unstable(Breakdown::fall, fall_s);
        }
        const auto moved_on = static_cast<double>(log.taken_out);
        if (log.taken_out > 0 && moved_on >= kSemiStableShare * static_cast<double>(figures_.left_network)) {
            return unstable(Breakdown::moved_on, moves_on_from());
        }
        for (const Gridlock& gridlock : log.gridlocks) {
            if (stays(gridlock, end_s, cycle_s_)) return unstable(Breakdown::gridlock, gridlock.from_s);
        }
        const bool semi = !log.gridlocks.empty() || log.taken_out > 0;
        figures_.stability = semi ? Stability::semi_stable : Stability::stable;
    }

private:
    void unstable(Breakdown by, std::optional<double> since_s) {
        figures_.stability = Stability::unstable;
        figures_.breakdown = by;
        figures_.collapse_s = since_s;
    }

    // The first cycle in which it has filled; by means of five, since single ones scatter.
    std::size_t filled() const {
        constexpr std::size_t kTogether = 5;
        std::vector<double> means;
        for (std::size_t k = 0; k + kTogether <= cycles_.size(); k += kTogether) {
            double sum = 0.0;
            for (std::size_t i = 0; i < kTogether; ++i) sum += cycles_[k + i].left;
            means.push_back(sum / static_cast<double>(kTogether));
        }
        return first_full(means) * kTogether;
    }

    std::optional<double> falls_at() const {
        std::vector<double> flow;
        for (const AreaFigures& cycle : cycles_) flow.push_back(cycle.left);
        const std::optional<Collapse> collapse = find_collapse(std::span(flow).subspan(filled_), kCollapseShare);
        if (!collapse) return std::nullopt;
        return cycles_[filled_ + collapse->at].window.from_s;
    }

    // The end of the last cycle in which the share of those that were moved on was still below the limit.
    double moves_on_from() const {
        double since_s = 0.0;
        double left = 0.0;
        double moved_on = 0.0;
        auto use = figures_.hindrance.rules.begin();
        for (const AreaFigures& cycle : cycles_) {
            left += cycle.left;
            for (; use != figures_.hindrance.rules.end() && use->time_s < cycle.window.to_s; ++use) {
                moved_on += use->kind == RuleUse::Kind::taken_out ? 1.0 : 0.0;
            }
            if (moved_on < kSemiStableShare * left) since_s = cycle.window.to_s;
        }
        return since_s;
    }

    NetworkFigures& figures_;
    const std::vector<AreaFigures>& cycles_;
    double cycle_s_;
    std::size_t filled_;
};

void measure(const Scenario& scenario, const Model& model, const State& state, const Sampler& sampler,
             NetworkFigures& figures) {
    const double end_s = model.time_s(state.tick);
    figures.series = sampler.series();
    const std::vector<AreaFigures> areas =
        area_series(model.detectors, state.crossings, scenario.measure.interval_s, end_s, area_lane_m(scenario, model));
    figures.series.resize(std::min(figures.series.size(), areas.size()));
    std::vector<double> vehicles;
    for (std::size_t k = 0; k < figures.series.size(); ++k) {
        figures.series[k].area = areas[k];
        vehicles.push_back(areas[k].vehicles);
    }
    figures.warm_up_s = static_cast<double>(warm_up(vehicles)) * scenario.measure.interval_s;
    const double steady_s = end_s - scenario.measure.steady_s;
    figures.steady = mean_of(figures.series, steady_s > 0.0 ? steady_s : figures.warm_up_s);
    if (model.trips_begin < 0) figures.ways = way_figures(model, state.crossings, figures.steady.window);
}

// From so many vehicles on, whose step takes some tens of microseconds, a second thread is worth it.
constexpr int kSharedFromMeso = 4000;
constexpr int kSharedFromFull = 500;

}  // namespace

Model network_model(const Scenario& scenario, std::size_t population) {
    Model model = build_model(scenario, population);
    watch_area(scenario, model);
    model.records_all = false;
    model.rules.watch_ticks = std::max<std::int64_t>(to_ticks(1.0, model.step_s), 1);
    return model;
}

NetworkFigures run_network(const Scenario& scenario, std::size_t population,
                           const std::function<bool(const Simulation&)>& on_step, int threads,
                           const Observation& observation) {
    Model model = network_model(scenario, population);
    observation.prepare(model);
    Simulation simulation(model, threads);
    simulation.share_from(model.meso ? kSharedFromMeso : kSharedFromFull);
    NetworkFigures figures;
    figures.population = scenario.populations.at(population).name;
    figures.complete = true;
    Sampler sampler(scenario, model);
    StreetWatch street(scenario, model);
    BacklogWatch backlog(model, scenario.measure.interval_s);
    const std::int64_t last = to_ticks(scenario.duration_s, model.step_s);
    while (simulation.state().tick < last) {
        if (on_step && !on_step(simulation)) {
            figures.complete = false;
            break;
        }
        sampler.look(simulation.state());
        street.look(simulation.state());
        backlog.look(simulation.state());
        observation.call(population, simulation);
        simulation.step();
    }
    const State& state = simulation.state();
    sampler.look(state);
    if (figures.complete) observation.call(population, simulation);
    measure(scenario, model, state, sampler, figures);
    figures.hindrance = state.hindrance;
    figures.violations = state.violations;
    figures.longest_inside_s = model.time_s(state.longest_inside);
    figures.vehicles_present = sampler.mean_present(figures.steady.window);
    figures.most_present = sampler.most_present();
    figures.entered = state.entered;
    figures.left_network = state.left;
    figures.updates = state.updates;
    figures.state_hash = simulation.state_hash();
    const double cycle_s = model.time_s(model.rules.gridlock_ticks);
    const double end_s = model.time_s(state.tick);
    StabilityVerdict(
        figures, area_series(model.detectors, state.crossings, cycle_s, end_s, area_lane_m(scenario, model)), cycle_s)
        .pass(end_s);
    figures.street = street.trace();
    backlog.look(state);
    figures.backlog = backlog.backlog();
    figures.strayed = state.strayed;
    figures.waiting = waiting_outside(model, state);
    if (model.trips_begin < 0)
        figures.inflow = inflow_series(model, state.crossings, scenario.measure.interval_s, model.time_s(state.tick));
    figures.turned = state.turned;
    figures.changes_for_route = std::count_if(state.lane_changes.begin(), state.lane_changes.end(),
                                              [](const LaneChange& change) { return change.for_route; });
    figures.changes_for_speed = static_cast<std::int64_t>(state.lane_changes.size()) - figures.changes_for_route;
    return figures;
}

}  // namespace stopline
