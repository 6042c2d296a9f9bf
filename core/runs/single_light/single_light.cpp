#include "runs/single_light/single_light.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>

#include "base/containers/index.h"
#include "base/nan.h"
#include "runs/single_light/ideal_platoon.h"
#include "runs/single_light/queue_stability.h"
#include "scenario/fleets.h"
#include "sim/state/model.h"

namespace stopline {

namespace {

std::int64_t ticks_of(double interval_s, double step_s) {
    return std::max<std::int64_t>(1, to_ticks(interval_s, step_s));
}

const GapPolicySettings& policy_named(const Scenario& scenario, const std::string& name) {
    // load_scenario() has checked that the policy exists.
    return *std::find_if(scenario.policies.begin(), scenario.policies.end(),
                         [&](const GapPolicySettings& policy) { return policy.name == name; });
}

SteadyFlow steady_flow(const Scenario& scenario, const PopulationSettings& population,
                       const std::vector<TrajectoryPoint>& points, double interval_s) {
    const double cruise_mps = cruise_speed_mps(scenario);
    const std::vector<SteadyVehicle> steady = steady_vehicles(points, interval_s, cruise_mps);
    const std::vector<SteadyVehicle> cruising = cruising_vehicles(points, interval_s, cruise_mps);
    const double mean_length_m = mean_vehicle_m(scenario, population);
    SteadyFlow flow;
    std::vector<double> open_gaps_m;
    for (std::size_t k = 0; k < population.components.size(); ++k) {
        const double share = population.components[k].share;
        const double gap_m = equilibrium_gap_m(policy_named(scenario, population.components[k].policy), cruise_mps);
        std::vector<double> gaps_m;
        std::vector<double> headways_s;
        for (const SteadyVehicle& vehicle : steady) {
            if (vehicle.policy != static_cast<int>(k) || !has_closed_up(vehicle.net_gap_m, gap_m)) continue;
            gaps_m.push_back(vehicle.net_gap_m);
            headways_s.push_back(vehicle.headway_s);
        }
        for (const SteadyVehicle& vehicle : cruising) {
            if (vehicle.policy != static_cast<int>(k) || has_closed_up(vehicle.net_gap_m, gap_m)) continue;
            open_gaps_m.push_back(vehicle.net_gap_m);
        }
        flow.vehicles += static_cast<int>(gaps_m.size());
        flow.net_gap_m += share * mean(gaps_m);
        flow.headway_s += share * mean(headways_s);
        flow.policy_gap_m += share * gap_m;
        flow.policy_headway_s += share * (mean_length_m + gap_m) / cruise_mps;
    }
    flow.deviation_percent = 100.0 * (flow.headway_s / flow.policy_headway_s - 1.0);
    flow.not_closed_up = static_cast<int>(open_gaps_m.size());
    flow.open_gap_m = mean(open_gaps_m);
    return flow;
}

QueueGaps queue_gaps(const std::vector<QueueGap>& gaps) {
    constexpr double kTolerance_m = 1.0;
    std::vector<double> gaps_m;
    double largest_open_m = kNan;
    for (const QueueGap& gap : gaps) {
        gaps_m.push_back(gap.net_gap_m);
        if (gap.net_gap_m > gap.standstill_gap_m + kTolerance_m)
            largest_open_m = std::fmax(largest_open_m, gap.net_gap_m);  // ignores NaN
    }
    if (gaps_m.empty()) return {kNan, kNan, kNan, kNan};
    const auto [smallest, largest] = std::minmax_element(gaps_m.begin(), gaps_m.end());
    return {mean(gaps_m), *smallest, *largest, largest_open_m};
}

// Returns the points downstream of the stop line. Vehicles that arrive after the queue has left can also drive at the
// speed limit upstream of the stop line, but must not count as steady there.
std::vector<TrajectoryPoint> downstream_points(const std::vector<TrajectoryPoint>& points, double line_m) {
    std::vector<TrajectoryPoint> downstream;
    std::copy_if(points.begin(), points.end(), std::back_inserter(downstream),
                 [&](const TrajectoryPoint& point) { return point.distance_m >= line_m; });
    return downstream;
}

// Returns the start of the platoon leader, which is the first vehicle to pass the stop line of the first lane. Times
// count from the start of green.
LeaderStart leader_of(const Scenario& scenario, const std::vector<LinePassage>& line,
                      const std::vector<TrajectoryPoint>& points, double green_start_s) {
    if (line.empty()) return {kNan, kNan};
    LeaderStart start =
        leader_start(points_of(points, line.front().vehicle), scenario.network.approach.speed_limit_mps);
    start.start_s -= green_start_s;
    start.limit_s -= green_start_s;
    return start;
}

// Returns the speeds from `start_s` on. The times of the samples count from `start_s`.
std::vector<SpeedSample> speeds_from(const std::vector<TrajectoryPoint>& points, double start_s) {
    std::vector<SpeedSample> samples;
    for (const TrajectoryPoint& point : points) {
        if (point.time_s >= start_s) samples.push_back({point.time_s - start_s, point.speed_mps});
    }
    return samples;
}

// Returns the passages of ideal platoons (ideal_platoon.h) over the stop line. On each lane, the platoon is the queue
// at the start of green, and its leader has the simulated speed.
Counter ideal_counter(const Scenario& scenario, const PopulationSettings& population,
                      const std::vector<TrajectoryPoint>& points, double green_start_s) {
    const double line_m = scenario.network.approach.length_m;
    const double sample_s = kSampleInterval_s;
    std::map<int, std::vector<TrajectoryPoint>> queues;  // lane -> points of its queue
    for (const TrajectoryPoint& point : points) {
        if (point.time_s < green_start_s || point.time_s >= green_start_s + 0.5 * sample_s) continue;
        if (point.distance_m < line_m) queues[point.lane].push_back(point);
    }
    std::vector<double> times_s;
    for (auto& [lane, queue] : queues) {
        std::sort(queue.begin(), queue.end(), [](const TrajectoryPoint& one, const TrajectoryPoint& other) {
            return one.distance_m > other.distance_m;
        });
        std::vector<IdealVehicle> vehicles;
        for (const TrajectoryPoint& point : queue) {
            const PopulationSettings::Component& component = population.components[at(point.policy)];
            vehicles.push_back({&policy_named(scenario, component.policy), vehicle_of(scenario, component).length_m});
        }
        const std::vector<SpeedSample> leader = speeds_from(points_of(points, queue.front().vehicle), green_start_s);
        const std::vector<double> lane_s =
            ideal_passages_s(leader, vehicles, line_m - queue.front().distance_m, scenario.signal.green_s);
        times_s.insert(times_s.end(), lane_s.begin(), lane_s.end());
    }
    return Counter(times_s);
}

void compare_with_baseline(SingleLightReport& result) {
    for (PopulationSummary& summary : result.populations) {
        summary.asymptotic_improvement_percent = kNan;
        summary.improvement_percent.assign(summary.passed.size(), kNan);
        if (!result.baseline) continue;
        const PopulationSummary& baseline = result.populations[*result.baseline];
        summary.asymptotic_improvement_percent =
            improvement_percent(baseline.steady.headway_s, summary.steady.headway_s);
        for (std::size_t k = 0; k < summary.passed.size(); ++k) {
            summary.improvement_percent[k] = improvement_percent(summary.passed[k], baseline.passed[k]);
        }
    }
}

}  // namespace

PopulationSummary summary_of(const Scenario& scenario, std::size_t index, const RunResult& run,
                             const std::vector<TrajectoryPoint>& points, double interval_s) {
    const PopulationSettings& population = scenario.populations[index];
    PopulationSummary summary;
    summary.name = population.name;
    summary.line =
        within_green(line_passages(make_approach(scenario.network.approach), run.passages, run.green_start_s),
                     scenario.signal.green_s);
    std::vector<double> times_s;
    for (const LinePassage& passage : summary.line) times_s.push_back(passage.time_s);
    summary.counter = Counter(times_s);
    for (const double green_s : scenario.measure.green_s) summary.passed.push_back(summary.counter.passed(green_s));
    const int queued = scenario.demand.vehicles * scenario.network.approach.lanes;
    summary.emptied_s = summary.counter.total() >= queued ? summary.counter.times_s().back() : kNan;
    summary.last_positions = last_positions_flow(summary.line, kLastPositions);
    const ApproachSettings& road = scenario.network.approach;
    summary.steady = steady_flow(scenario, population, downstream_points(points, road.length_m), interval_s);
    summary.leader = leader_of(scenario, summary.line, points, run.green_start_s);
    summary.queue = queue_gaps(run.queue_gaps);
    summary.ideal = ideal_counter(scenario, population, points, run.green_start_s);
    summary.stability = {kNan, kNan, kNan, kNan};
    if (scenario.measure.string_stability == "on") {
        summary.stability = queue_stability(scenario, population, summary.line, points, run.green_start_s);
    }
    return summary;
}

double cruise_speed_mps(const Scenario& scenario) {
    const double limit_mps = scenario.network.approach.speed_limit_mps;
    return scenario.is_meso() ? scenario.meso.leader_speed_share * scenario.meso.speed_factor * limit_mps : limit_mps;
}

std::vector<TrajectoryPoint> thin_out(const std::vector<TrajectoryPoint>& points, double interval_s, double step_s) {
    const std::int64_t interval_ticks = ticks_of(interval_s, step_s);
    std::vector<TrajectoryPoint> kept;
    std::copy_if(points.begin(), points.end(), std::back_inserter(kept), [&](const TrajectoryPoint& point) {
        return std::llround(point.time_s / step_s) % interval_ticks == 0;
    });
    return kept;
}

const PopulationSummary* SingleLightReport::find(const std::string& population) const {
    const auto found = std::find_if(populations.begin(), populations.end(),
                                    [&](const PopulationSummary& summary) { return summary.name == population; });
    return found == populations.end() ? nullptr : &*found;
}

double SingleLightReport::mean_improvement_percent(const PopulationSummary& population, double from_s) const {
    if (!baseline) return kNan;
    const PopulationSummary& base = populations[*baseline];
    double to_s = scenario.signal.green_s;
    for (const double emptied_s : {population.emptied_s, base.emptied_s}) {
        if (!std::isnan(emptied_s)) to_s = std::min(to_s, emptied_s);
    }
    return stopline::mean_improvement_percent(population.counter, base.counter, from_s, to_s);
}

double SingleLightReport::ideal_improvement_percent(const PopulationSummary& population, double from_s) const {
    if (!baseline) return kNan;
    const Counter& base = populations[*baseline].ideal;
    const int queued = scenario.demand.vehicles * scenario.network.approach.lanes;
    double to_s = scenario.signal.green_s;
    for (const Counter* const counter : {&population.ideal, &base}) {
        if (counter->total() >= queued) to_s = std::min(to_s, counter->times_s().back());
    }
    return stopline::mean_improvement_percent(population.ideal, base, from_s, to_s);
}

bool SingleLightReport::no_violations() const {
    return std::all_of(runs.begin(), runs.end(), [](const RunResult& run) { return run.violations.none(); });
}

SingleLightReport run_single_light(const Scenario& scenario, const SingleLightOptions& options) {
    SingleLightReport result;
    result.scenario = scenario;
    const std::int64_t summary_ticks = ticks_of(kSampleInterval_s, scenario.tick_s());
    std::int64_t sample_ticks = summary_ticks;
    if (options.trajectory_interval_s > 0.0) {
        sample_ticks = std::gcd(summary_ticks, ticks_of(options.trajectory_interval_s, scenario.tick_s()));
    }
    result.sample_interval_s = static_cast<double>(summary_ticks) * scenario.tick_s();
    RunAllOptions runs;
    runs.threads = options.threads;
    runs.trajectory_interval_s = static_cast<double>(sample_ticks) * scenario.tick_s();
    runs.trajectory_from_s = scenario.signal.first_green_s - kTrajectoryBefore_s;
    runs.trajectory_until_s = scenario.signal.first_green_s + scenario.signal.green_s + kTrajectoryAfter_s;
    runs.on_progress = options.on_progress;
    runs.observation = options.observation;
    result.runs = run_populations(scenario, runs);
    for (std::size_t k = 0; k < result.runs.size(); ++k) {
        const std::vector<TrajectoryPoint> points =
            thin_out(result.runs[k].trajectory, result.sample_interval_s, scenario.tick_s());
        result.populations.push_back(summary_of(scenario, k, result.runs[k], points, result.sample_interval_s));
        if (result.populations.back().name == scenario.measure.baseline) result.baseline = k;
    }
    compare_with_baseline(result);
    return result;
}

}  // namespace stopline
