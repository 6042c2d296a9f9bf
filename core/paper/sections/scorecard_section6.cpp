// Section VI of the paper: arterial (rows A01 to A17 of data/paper/targets.csv), grid (G01 to G12) and stability (S01
// to S04). Most values come from three sweeps in the mesoscale mode with the calibrated parameters. The other values
// come from separate runs, mostly of the arterial without turns (measure_platoons).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/csv.h"
#include "base/io/data_directory.h"
#include "paper/sections/scorecard_section6.h"
#include "paper/sections/scorecard_sections.h"
#include "paper/sections/scorecard_sweeps.h"
#include "runs/interrupted.h"
#include "runs/intersection/intersection_run.h"
#include "runs/network/network_run.h"
#include "runs/parallel_runs.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"

namespace stopline {

using namespace section6;

namespace {

std::string traffic_of(const Scenario& scenario, bool stability) {
    const int left = static_cast<int>(std::lround(100.0 * scenario.demand.left_share));
    if (stability) return fmt::format("{}_{}", scenario.demand.kind, left);
    return left == 0 ? "free" : "turns";
}

Measurements measured_sweep(const ScorecardOptions& options, const char* file, const char* name, bool stability) {
    const SweepRuns runs = run_sweep(options, file, {}, name, run_metrics, {0.0, 1.0});
    Measurements measured;
    runs.store.for_each_run([&](std::size_t point, const std::string& text) {
        const Scenario scenario = runs.sweep.scenario(runs.sweep.combination(point));
        const std::string point_text =
            point_name(traffic_of(scenario, stability), static_cast<int>(std::lround(scenario.signal.green_s)),
                       static_cast<int>(std::lround(scenario.signal.offset_s)), runs.sweep.population(point));
        const auto store = [&](const char* quantity, const char* column) {
            const std::optional<double> value = parse_number(value_in(text, column));
            measured.set(std::string(quantity) + " " + point_text,
                         value.value_or(std::numeric_limits<double>::quiet_NaN()));
        };
        store("throughput", "throughput_veh_h");
        store("time", "travel_time_s");
        store("density", "density_percent");
        store("teleported", "teleported");
        store("gridlocks", "gridlocks");
        const std::string verdict = value_in(text, "stability");
        const auto known = std::find(kStabilityNames.begin(), kStabilityNames.end(), verdict);
        measured.set("stability " + point_text, static_cast<double>(known - kStabilityNames.begin()));
    });
    measured.set("violations", static_cast<double>(runs.totals.runs_with_violations));
    return measured;
}

Measurements measure_arterial(const Scenario& /*scenario*/, const ScorecardOptions& options) {
    return measured_sweep(options, "arterial.yaml", kArterial, false);
}

Measurements measure_grid(const Scenario& /*scenario*/, const ScorecardOptions& options) {
    return measured_sweep(options, "grid.yaml", kGrid, false);
}

Measurements measure_stability(const Scenario& /*scenario*/, const ScorecardOptions& options) {
    return measured_sweep(options, "stability.yaml", kStability, true);
}

// Measures the mean travel time from the first to the last stop line of the street, divided by the number of blocks
// between these stop lines, s. Stores one value for each driving direction: "NAME east" and "NAME west". Adds 1 to the
// measurement "violations" if the run has violations.
void measure_block_times(const Scenario& scenario, std::size_t population, const std::string& name,
                         Measurements& measured) {
    constexpr double kUntil_s = 1800.0;
    constexpr double kFrom_s = 600.0;
    const Model model = build_model(scenario, population);
    Simulation simulation(model);
    simulation.run_until(kUntil_s);
    const int last = scenario.network.grid.columns - 1;
    for (const bool east : {true, false}) {
        const std::string from = fmt::format("c{}r0_{}_in_", east ? 0 : last, east ? "west" : "east");
        const std::string to = fmt::format("c{}r0_{}_in_", east ? last : 0, east ? "west" : "east");
        std::map<int, double> since_s;
        double sum_s = 0.0;
        int vehicles = 0;
        for (const Crossing& crossing : simulation.state().records.crossings) {
            const Detector& detector = model.detectors[static_cast<std::size_t>(crossing.detector)];
            if (detector.kind != Detector::Kind::stop_line) continue;
            const std::string& lane = model.graph.lanes[static_cast<std::size_t>(detector.lane)].name;
            if (lane.starts_with(from)) since_s[crossing.vehicle] = crossing.time_s;
            const auto found = since_s.find(crossing.vehicle);
            if (!lane.starts_with(to) || found == since_s.end() || crossing.time_s < kFrom_s) continue;
            sum_s += crossing.time_s - found->second;
            ++vehicles;
        }
        measured.set(name + (east ? " east" : " west"), sum_s / vehicles / last);
    }
    measured.set("violations", measured.find("violations").value_or(0.0) +
                                   (simulation.state().records.violations.none() ? 0.0 : 1.0));
}

std::size_t index_of(const Scenario& scenario, const std::string& population) {
    for (std::size_t k = 0; k < scenario.populations.size(); ++k) {
        if (scenario.populations[k].name == population) return k;
    }
    throw InputError(fmt::format("the scenario has no population '{}'", population));
}

// Runs the arterial without turns. Measures the travel time for each block at two offsets (Fig. 16, situations 1 and
// 2), and the throughput of two populations. Also runs a single intersection to measure the number of vehicles in a
// platoon.
Measurements measure_platoons(const Scenario& scenario, const ScorecardOptions& options) {
    Measurements measured;
    Scenario street = scenario;
    street.demand.left_share = street.demand.right_share = street.demand.cross_left_share =
        street.demand.cross_right_share = 0.0;
    Scenario platoons = street;
    platoons.signal.green_s = 10.0;
    platoons.signal.cross_green_s = 10.0;
    for (const int offset_s : kArterialOffsets_s) {
        platoons.signal.offset_s = offset_s;
        measure_block_times(platoons, index_of(scenario, "CDG"), fmt::format("interspace {}", offset_s), measured);
    }
    Scenario crossing = load_scenario(scenario_directory() / "intersection.yaml", {"signal.green=10 s"});
    const IntersectionResult single = run_intersection(crossing, index_of(crossing, "CDG"));
    measured.set("platoon_veh", single.discharge.vehicles_per_green);
    const std::vector<std::pair<int, const char*>> runs{{25, "CTG-Ref"}, {25, "CDG"}, {35, "CTG-Ref"}, {35, "CDG"}};
    std::vector<NetworkResult> results(runs.size());
    run_side_by_side(runs.size(), options.threads, options.on_progress,
                     [&](std::size_t k, const std::function<bool(double)>& report_progress) {
                         constexpr std::int64_t kAskInterval_ticks = 500;
                         Scenario own = street;
                         own.signal.green_s = runs[k].first;
                         own.signal.cross_green_s = runs[k].first == 25 ? 10.0 : 5.0;
                         results[k] =
                             run_network(own, index_of(own, runs[k].second), [&](const Simulation& simulation) {
                                 return simulation.state().tick % kAskInterval_ticks != 0 ||
                                        report_progress(simulation.time_s() / own.duration_s);
                             });
                     });
    for (std::size_t k = 0; k < runs.size(); ++k) {
        measured.set(fmt::format("no_turns {} {}", runs[k].first, runs[k].second),
                     results[k].measured.throughput_veh_h());
        if (!results[k].violations.none()) measured.set("violations", measured.find("violations").value_or(0.0) + 1.0);
    }
    return measured;
}

}  // namespace

std::span<const Experiment> section6_experiments() {
    static const std::array kExperiments{Experiment{kPlatoons, "arterial", true, measure_platoons},
                                         Experiment{kArterial, "arterial", false, measure_arterial},
                                         Experiment{kGrid, "grid", false, measure_grid},
                                         Experiment{kStability, "grid", false, measure_stability}};
    return kExperiments;
}

}  // namespace stopline
