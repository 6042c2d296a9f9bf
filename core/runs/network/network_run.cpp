#include "runs/network/network_run.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "base/containers/index.h"
#include "measure/steady_state.h"
#include "runs/driving/driving_meters.h"
#include "runs/hcm/hcm_sampler.h"
#include "scenario/build_model.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/make_network.h"
#include "sim/insertion/insert_vehicles.h"

namespace stopline {

namespace {

// Returns true if the lane is an entry lane of the network, or belongs to the same approach as an entry lane.
bool is_fed_from_outside(const LaneGraph& graph, int lane) {
    const int approach = graph.lanes[at(lane)].approach;
    return std::any_of(graph.entries.begin(), graph.entries.end(), [&](int entry) {
        return entry == lane || (approach >= 0 && graph.lanes[at(entry)].approach == approach);
    });
}

// Adds two detectors for an imported network, whose measured area is the whole network. A vehicle passes one detector
// when its trip starts, and the other one when its trip ends.
void add_trip_detectors(Model& model) {
    model.trips_begin = static_cast<int>(model.detectors.size());
    model.detectors.push_back({-1, 0.0, Detector::Kind::zone, 0, false});
    model.trips_end = static_cast<int>(model.detectors.size());
    model.detectors.push_back({-1, 0.0, Detector::Kind::zone, 0, true});
}

// Adds a detector at the start of each lane inside the measured area on which vehicles can enter the network. The
// detector also counts vehicles that come from upstream. The functions in measure/area.h ignore such a passage, because
// the vehicle has entered the area before.
void add_inner_inlet_detectors(Model& model) {
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        if (inlet.vehicles == 0 || is_fed_from_outside(model.graph, inlet.lane)) continue;
        model.detectors.push_back({inlet.lane, 0.0, Detector::Kind::zone, 0, false});
    }
}

// Removes all detectors except those at stop lines, those of signal controllers, and induction loops. Adds detectors at
// the boundary of the measured area and at inlets inside it. The boundary lies on the entry
// approaches and exit lanes of the network. Turn pockets wholly inside the area get no detector, because vehicles reach
// them from the adjacent lane. An imported network gets trip detectors instead.
void add_area_detectors(const Scenario& scenario, Model& model) {
    if (network_kind(scenario.network).has_trips) return add_trip_detectors(model);
    std::erase_if(model.detectors, [](const Detector& d) {
        return d.kind != Detector::Kind::stop_line && d.kind != Detector::Kind::signal &&
               d.kind != Detector::Kind::loop;
    });
    const double margin_m = scenario.measure.area_margin_m;
    model.area_begins_m.assign(model.graph.lanes.size(), 0.0);
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        const Lane& road = model.graph.lanes[at(lane)];
        if (road.origin >= 0) continue;
        const bool is_inner_pocket = road.start_offset_m > 0.0 && road.stop_line_m <= margin_m;
        if (road.signal_group < 0) {
            model.detectors.push_back({lane, margin_m, Detector::Kind::zone, 0, true});
        } else if (is_fed_from_outside(model.graph, lane) && !is_inner_pocket) {
            model.area_begins_m[at(lane)] = road.stop_line_m - margin_m;
            model.detectors.push_back({lane, model.area_begins_m[at(lane)], Detector::Kind::zone, 0, false});
        }
    }
    add_inner_inlet_detectors(model);
}

// Returns the length of all lanes in the measured area, m. Except in imported networks, the length of a lane that leads
// to an intersection includes the straight way across this intersection.
double area_lane_m(const Scenario& scenario, const Model& model) {
    double sum_m = 0.0;
    const bool measures_whole_network = network_kind(scenario.network).has_trips;
    const double margin_m = scenario.measure.area_margin_m;
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        const Lane& road = model.graph.lanes[at(lane)];
        if (road.origin >= 0) continue;
        if (measures_whole_network) {
            sum_m += road.length_m;
        } else if (road.signal_group < 0) {
            sum_m += margin_m;
        } else {
            const bool is_inner_pocket = road.start_offset_m > 0.0 && road.stop_line_m <= margin_m;
            sum_m += is_fed_from_outside(model.graph, lane) && !is_inner_pocket ? margin_m : road.stop_line_m;
            sum_m += 2.0 * radius_beyond_m(scenario.network, road);
        }
    }
    return sum_m;
}

// Samples values that cannot be computed from the recorded events of a run: delay and number of teleported vehicles in
// each interval, and number of vehicles in the network in each second.
class IntervalSampler {
public:
    IntervalSampler(const Scenario& scenario, const Model& model)
        : interval_ticks_(to_ticks(scenario.measure.interval_s, model.step_s)),
          second_ticks_(to_ticks(1.0, model.step_s)) {}

    void sample(const State& state) {
        if (state.tick % second_ticks_ == 0) present_.push_back(state.present());
        if (state.tick % interval_ticks_ != 0 || state.tick == 0) return;
        const DelayLog& delays = state.congestion.delays;
        NetworkInterval interval;
        for (std::size_t cause = 0; cause < interval.delay_s.size(); ++cause) {
            interval.delay_s[cause] = delays.delay_s[cause] - last_delay_s_[cause];
        }
        interval.teleported = delays.teleported - last_teleported_;
        last_delay_s_ = delays.delay_s;
        last_teleported_ = delays.teleported;
        series_.push_back(interval);
    }

    std::vector<NetworkInterval> series() const { return series_; }
    int max_present() const { return present_.empty() ? 0 : *std::max_element(present_.begin(), present_.end()); }
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
    std::int64_t interval_ticks_;
    std::int64_t second_ticks_;
    std::array<double, kDelayCauseNames.size()> last_delay_s_{};  // [cause] total at the end of the previous interval
    std::int64_t last_teleported_ = 0;
    std::vector<NetworkInterval> series_;
    std::vector<int> present_;  // [second] number of vehicles in the network
};

// Returns one result for all intervals that begin at `from_s` or later: their common time window, the total number of
// exits, and the means of all other values. Values without data are NaN.
AreaResult mean_from(const std::vector<NetworkInterval>& series, double from_s) {
    AreaResult mean;
    double travel_s = 0.0;
    int intervals = 0;
    for (const NetworkInterval& interval : series) {
        const AreaResult& area = interval.area;
        if (area.window.from_s < from_s) continue;
        if (intervals == 0) mean.window.from_s = area.window.from_s;
        mean.window.to_s = area.window.to_s;
        ++intervals;
        mean.exited += area.exited;
        if (area.exited > 0) travel_s += area.exited * area.travel_time_s;
        mean.vehicles += area.vehicles;
        mean.occupied += area.occupied;
    }
    const double none = std::numeric_limits<double>::quiet_NaN();
    mean.vehicles = intervals > 0 ? mean.vehicles / intervals : none;
    mean.occupied = intervals > 0 ? mean.occupied / intervals : none;
    mean.travel_time_s = mean.exited > 0 ? travel_s / mean.exited : none;
    return mean;
}

// Returns true if the gridlock has lasted for six signal cycles or more and still existed during the last cycle of the
// run.
bool is_permanent(const Gridlock& gridlock, double end_s, double cycle_s) {
    constexpr double kLasting_cycles = 6.0;  // twice rules.teleport_cycles, which is 3 in the shipped scenarios
    return end_s - gridlock.to_s <= cycle_s && gridlock.to_s - gridlock.from_s >= kLasting_cycles * cycle_s;
}

// Judges the stability of a run by its gridlocks, teleported vehicles, starving movements, and the number of exits in
// each signal cycle. measure.interval has no influence on the verdict, because exits are counted by signal cycle.
class StabilityJudge {
public:
    StabilityJudge(NetworkResult& result, const std::vector<AreaResult>& cycles, double cycle_s)
        : result_(result), cycles_(cycles), cycle_s_(cycle_s), first_full_(first_full_cycle()) {}

    void judge(double end_s) {
        result_.full_cycles = static_cast<int>(cycles_.size() - first_full_);
        const DelayLog& delays = result_.delays;
        if (const auto drop_s = delays.gridlocks.empty() ? std::nullopt : throughput_drop_s()) {
            return set_unstable(InstabilityCause::throughput_drop, drop_s);
        }
        const auto teleported = static_cast<double>(delays.teleported);
        if (delays.teleported > 0 && teleported >= kSemiStableShare * static_cast<double>(result_.exited)) {
            return set_unstable(InstabilityCause::teleported, teleport_limit_s());
        }
        for (const Gridlock& gridlock : delays.gridlocks) {
            if (is_permanent(gridlock, end_s, cycle_s_)) {
                return set_unstable(InstabilityCause::gridlock, gridlock.from_s);
            }
        }
        if (!delays.starvations.empty()) {
            return set_unstable(InstabilityCause::starvation, delays.starvations.front().from_s);
        }
        const bool is_semi_stable = !delays.gridlocks.empty() || delays.teleported > 0;
        result_.stability = is_semi_stable ? Stability::semi_stable : Stability::stable;
    }

private:
    void set_unstable(InstabilityCause cause, std::optional<double> since_s) {
        result_.stability = Stability::unstable;
        result_.unstable_by = cause;
        result_.collapse_s = since_s;
    }

    // Returns the index of the first signal cycle after the network has filled. From this cycle on, throughput no
    // longer rises. The function uses means over five cycles, because the throughput of single cycles scatters.
    std::size_t first_full_cycle() const {
        constexpr std::size_t kCycles = 5;
        std::vector<double> means;
        for (std::size_t k = 0; k + kCycles <= cycles_.size(); k += kCycles) {
            double sum = 0.0;
            for (std::size_t i = 0; i < kCycles; ++i) sum += cycles_[k + i].exited;
            means.push_back(sum / static_cast<double>(kCycles));
        }
        return rise_end(means) * kCycles;
    }

    // Returns the start of the first cycle after throughput has dropped for good, s; std::nullopt if it does not drop.
    std::optional<double> throughput_drop_s() const {
        std::vector<double> flow;
        for (const AreaResult& cycle : cycles_) flow.push_back(cycle.exited);
        const std::optional<Collapse> collapse = find_collapse(std::span(flow).subspan(first_full_), kCollapseShare);
        if (!collapse) return std::nullopt;
        return cycles_[first_full_ + collapse->index].window.from_s;
    }

    // Returns the time from which on the number of teleported vehicles makes the run unstable, s. At the end of each
    // cycle, the function compares two numbers since the start of the run: teleported vehicles, and vehicles that have
    // left the area. It returns the last cycle end at which their ratio is below kSemiStableShare.
    double teleport_limit_s() const {
        double since_s = 0.0;
        double exited = 0.0;
        double teleported = 0.0;
        auto use = result_.delays.rule_uses.begin();
        for (const AreaResult& cycle : cycles_) {
            exited += cycle.exited;
            for (; use != result_.delays.rule_uses.end() && use->time_s < cycle.window.to_s; ++use) {
                teleported += use->kind == RuleUse::Kind::teleported ? 1.0 : 0.0;
            }
            if (teleported < kSemiStableShare * exited) since_s = cycle.window.to_s;
        }
        return since_s;
    }

    NetworkResult& result_;
    const std::vector<AreaResult>& cycles_;
    double cycle_s_;
    std::size_t first_full_;  // index into cycles_ of the first cycle after the network has filled
};

void measure(const Scenario& scenario, const Model& model, const State& state, const IntervalSampler& sampler,
             NetworkResult& result) {
    const double end_s = model.time_s(state.tick);
    result.series = sampler.series();
    const std::vector<AreaResult> areas = area_series(model.detectors, state.records.crossings,
                                                      scenario.measure.interval_s, end_s, area_lane_m(scenario, model));
    result.series.resize(std::min(result.series.size(), areas.size()));
    std::vector<double> vehicles;
    for (std::size_t k = 0; k < result.series.size(); ++k) {
        result.series[k].area = areas[k];
        vehicles.push_back(areas[k].vehicles);
    }
    result.warm_up_s = static_cast<double>(warm_up(vehicles)) * scenario.measure.interval_s;
    // The measured window is the last part of the run, with the length measure.window. If the run is not longer than
    // measure.window, the window begins at the end of the warm-up.
    const double window_from_s = end_s - scenario.measure.window_s;
    result.measured = mean_from(result.series, window_from_s > 0.0 ? window_from_s : result.warm_up_s);
    if (model.trips_begin < 0) {
        result.origin_destination =
            origin_destination_results(model.graph, model.detectors, state.records.crossings, result.measured.window);
    }
}

// Returns the departure delays by approach of the graph. Imported networks have trips instead of inlets, so their
// delays are 0 here.
std::vector<DepartureDelays> approach_departures(const Model& model, const State& state) {
    std::vector<DepartureDelays> delays(model.graph.approaches.size());
    for (int inlet = 0; inlet < static_cast<int>(model.demand.inlets.size()); ++inlet) {
        const int approach = model.graph.lanes[at(model.demand.inlets[at(inlet)].lane)].approach;
        if (approach >= 0) delays[at(approach)].add(departure_delays(model, state, inlet));
    }
    return delays;
}

// Smallest number of vehicles for which several threads share a step. With fewer vehicles, a step takes only some tens
// of microseconds, and a second thread costs more than it saves.
constexpr int kThreadsFromMeso = 4000;
constexpr int kThreadsFromFull = 500;

}  // namespace

Model network_model(const Scenario& scenario, std::size_t population) {
    Model model = build_model(scenario, population);
    add_area_detectors(scenario, model);
    model.records_all = false;
    model.rules.watch_ticks = std::max<std::int64_t>(to_ticks(1.0, model.step_s), 1);
    return model;
}

NetworkResult run_network(const Scenario& scenario, std::size_t population,
                          const std::function<bool(const Simulation&)>& on_step, int threads,
                          const Observation& observation) {
    Model model = network_model(scenario, population);
    observation.prepare(model);
    HcmSampler::prepare(scenario, model);
    Simulation simulation(model, threads);
    simulation.use_threads_from(model.meso ? kThreadsFromMeso : kThreadsFromFull);
    NetworkResult result;
    result.population = scenario.populations.at(population).name;
    result.complete = true;
    IntervalSampler sampler(scenario, model);
    StreetTracer tracer(scenario, model);
    CongestionSampler congestion(model, scenario.measure.interval_s);
    DrivingMeters driving(scenario, population, model);
    std::optional<HcmSampler> hcm;
    if (asks_for_hcm(scenario)) hcm.emplace(scenario, model);
    const std::int64_t end_tick = to_ticks(scenario.duration_s, model.step_s);
    while (simulation.state().tick < end_tick) {
        if (on_step && !on_step(simulation)) {
            result.complete = false;
            break;
        }
        sampler.sample(simulation.state());
        tracer.sample(simulation.state());
        congestion.sample(simulation.state());
        driving.observe(simulation.state());
        if (hcm) hcm->sample(simulation.state());
        observation.call(population, simulation);
        simulation.step();
    }
    const State& state = simulation.state();
    sampler.sample(state);
    if (result.complete) observation.call(population, simulation);
    measure(scenario, model, state, sampler, result);
    driving.observe(state);
    result.driving = driving.finish(state, result.measured.window);
    if (hcm) {
        hcm->sample(state);
        result.hcm = hcm->rows(result.measured.window);
    }
    result.delays = state.congestion.delays;
    result.delays.refused_stop_s = simulation.model().time_s(result.delays.refusal_ticks);
    result.delays.advised_s = simulation.model().time_s(result.delays.advised_ticks);
    result.gap_counts = state.records.gap_counts;
    result.violations = state.records.violations;
    result.v2v = v2v_result(state.records, model.v2v_plan);
    result.vehicle_names = VehicleNames(model, state);
    result.longest_in_junction_s = model.time_s(state.records.longest_in_junction_ticks);
    result.vehicles_present = sampler.mean_present(result.measured.window);
    result.max_present = sampler.max_present();
    result.entered = state.records.entered;
    result.exited = state.records.exited;
    result.updates = state.records.updates;
    result.state_hash = simulation.state_hash();
    const double cycle_s = model.time_s(model.rules.gridlock_ticks);
    const double end_s = model.time_s(state.tick);
    StabilityJudge(result,
                   area_series(model.detectors, state.records.crossings, cycle_s, end_s, area_lane_m(scenario, model)),
                   cycle_s)
        .judge(end_s);
    result.street_trace = tracer.trace();
    congestion.sample(state);
    result.congestion = congestion.congestion();
    result.missed_turns = state.congestion.missed_turns;
    result.backlog = insertion_backlog(model, state);
    result.departure = departure_delays(model, state);
    result.approach_departures = approach_departures(model, state);
    if (model.trips_begin < 0) {
        result.inflow = inflow_series(model.graph, model.detectors, state.records.crossings,
                                      scenario.measure.interval_s, model.time_s(state.tick));
    }
    result.turn_counts = state.records.turned;
    result.mandatory_lane_changes = std::count_if(state.records.lane_changes.begin(), state.records.lane_changes.end(),
                                                  [](const LaneChange& change) { return change.for_route; });
    result.discretionary_lane_changes =
        static_cast<std::int64_t>(state.records.lane_changes.size()) - result.mandatory_lane_changes;
    return result;
}

}  // namespace stopline
