// Section VI of the paper: arterial (A01..A17), grid (G01..G12) and stability (S01..S04), from three sweeps in the mesoscale mode with
// the fitted parameters, and some runs of the arterial without any turns.
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
#include "experiment/build_model.h"
#include "experiment/interrupted.h"
#include "experiment/intersection_run.h"
#include "experiment/network_run.h"
#include "experiment/scorecard_section6.h"
#include "experiment/scorecard_sections.h"
#include "experiment/scorecard_sweeps.h"
#include "experiment/side_by_side.h"
#include "scenario/load_scenario.h"

namespace stopline {

using namespace section6;

namespace {

constexpr std::array<int, 2> kArterialOffsets_s{0, 15};

std::string traffic_of(const Scenario& scenario, bool stability) {
    const int left = static_cast<int>(std::lround(100.0 * scenario.demand.left));
    if (stability) return fmt::format("{}_{}", scenario.demand.kind, left);
    return left == 0 ? "free" : "turns";
}

Measurements measured_sweep(const ScorecardOptions& options, const char* file, const char* name, bool stability) {
    const SweepRuns runs = run_sweep(options, file, {}, name, run_metrics, {0.0, 1.0});
    Measurements measured;
    runs.store.each([&](std::size_t point, const std::string& text) {
        const Scenario scenario = runs.sweep.scenario(runs.sweep.combination(point));
        const std::string place =
            place_of(traffic_of(scenario, stability), static_cast<int>(std::lround(scenario.signal.green_s)),
                     static_cast<int>(std::lround(scenario.signal.offset_s)), runs.sweep.population(point));
        const auto keep = [&](const char* what, const char* column) {
            const std::optional<double> value = parse_number(value_in(text, column));
            measured.set(std::string(what) + " " + place, value.value_or(std::numeric_limits<double>::quiet_NaN()));
        };
        keep("throughput", "throughput_veh_h");
        keep("time", "travel_time_s");
        keep("density", "density_percent");
        keep("moved_on", "moved_on");
        keep("gridlocks", "gridlocks");
        const std::string verdict = value_in(text, "stability");
        const auto known = std::find(kStabilityNames.begin(), kStabilityNames.end(), verdict);
        measured.set("stability " + place, static_cast<double>(known - kStabilityNames.begin()));
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

// Mean time from the first to the last stop line of the street, over its interspaces; eastwards and westwards.
void measure_interspaces(const Scenario& scenario, std::size_t population, const std::string& name,
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
        for (const Crossing& crossing : simulation.state().crossings) {
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
    measured.set("violations",
                 measured.find("violations").value_or(0.0) + (simulation.state().violations.none() ? 0.0 : 1.0));
}

std::size_t index_of(const Scenario& scenario, const std::string& population) {
    for (std::size_t k = 0; k < scenario.populations.size(); ++k) {
        if (scenario.populations[k].name == population) return k;
    }
    throw InputError(fmt::format("the scenario has no population '{}'", population));
}

// Situations 1 and 2 of Fig. 16, and the arterial without any turns.
Measurements measure_platoons(const Scenario& scenario, const ScorecardOptions& options) {
    Measurements measured;
    Scenario street = scenario;
    street.demand.left = street.demand.right = street.demand.cross_left = street.demand.cross_right = 0.0;
    Scenario platoons = street;
    platoons.signal.green_s = 10.0;
    platoons.signal.cross_green_s = 10.0;
    for (const int offset_s : kArterialOffsets_s) {
        platoons.signal.offset_s = offset_s;
        measure_interspaces(platoons, index_of(scenario, "CDG"), fmt::format("interspace {}", offset_s), measured);
    }
    Scenario crossing =
        load_scenario(data_directory().parent_path() / "scenarios" / "intersection.yaml", {"signal.green=10 s"});
    const IntersectionFigures single = run_intersection(crossing, index_of(crossing, "CDG"));
    measured.set("platoon_veh", single.discharge.vehicles_per_green);
    const std::vector<std::pair<int, const char*>> runs{{25, "CTG-Ref"}, {25, "CDG"}, {35, "CTG-Ref"}, {35, "CDG"}};
    std::vector<NetworkFigures> figures(runs.size());
    run_side_by_side(
        runs.size(), options.threads, options.on_progress, [&](std::size_t k, const std::function<bool(double)>& tell) {
            constexpr std::int64_t kTell = 500;  // steps
            Scenario own = street;
            own.signal.green_s = runs[k].first;
            own.signal.cross_green_s = runs[k].first == 25 ? 10.0 : 5.0;
            figures[k] = run_network(own, index_of(own, runs[k].second), [&](const Simulation& simulation) {
                return simulation.state().tick % kTell != 0 || tell(simulation.time_s() / own.duration_s);
            });
        });
    for (std::size_t k = 0; k < runs.size(); ++k) {
        measured.set(fmt::format("no_turns {} {}", runs[k].first, runs[k].second),
                     figures[k].steady.throughput_veh_h());
        if (!figures[k].violations.none()) measured.set("violations", measured.find("violations").value_or(0.0) + 1.0);
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
