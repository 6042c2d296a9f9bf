#include "sumo_export/compare.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/child_process.h"
#include "base/io/csv.h"
#include "runs/interrupted.h"
#include "runs/intersection/intersection_run.h"
#include "runs/run_kind.h"
#include "scenario/build_model.h"
#include "scenario/kinds/network_kind.h"
#include "sumo_export/export.h"
#include "sumo_export/imported.h"
#include "sumo_export/inputs.h"
#include "sumo_export/staged_folder.h"

namespace stopline {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

constexpr std::string_view kStepLog = "Step #";  // begins each line of SUMO's step log, which ends with '\r'

// Returns the simulated time in SUMO's latest step log, s.
double simulated_s(const std::string& output) {
    const std::size_t last = output.rfind(kStepLog);
    return last == std::string::npos ? 0.0 : std::strtod(output.c_str() + last + kStepLog.size(), nullptr);
}

// Returns the output of SUMO without its step log.
std::string without_step_log(const std::string& output) {
    std::string text;
    for (std::size_t begin = 0; begin < output.size();) {
        const std::size_t end = std::min(output.find_first_of("\r\n", begin), output.size() - 1) + 1;
        const std::string line = output.substr(begin, end - begin);
        if (!line.starts_with(kStepLog)) text += line;
        begin = end;
    }
    return text;
}

struct SumoRun {
    std::filesystem::path folder;  // contains run.sumocfg
    std::uint64_t seed = 0;
    double end_s = 0.0;                              // simulated time at the end of the run
    double limit_s = 0.0;                            // longest wall-clock time
    const std::function<bool(double)>& on_progress;  // gets the simulated share of the run; returns false to stop
};

// Runs SUMO. Throws InputError if SUMO fails or needs more than the longest wall-clock time, and Interrupted if the
// caller stops it.
void run_sumo(const SumoRun& run) {
    const auto start = std::chrono::steady_clock::now();
    bool is_late = false;
    const auto watch = [&](const std::string& output) {
        if (!run.on_progress(simulated_s(output) / run.end_s)) throw Interrupted();
        is_late = seconds_since(start) > run.limit_s;
        return !is_late;
    };
    const ProcessResult ended =
        run_process({"sumo", "-c", "run.sumocfg", "--seed", std::to_string(run.seed), "--no-step-log", "false",
                     "--step-log.period", "100", "--tripinfo-output", "trips.out.xml", "--summary-output",
                     "summary.out.xml", "--summary-output.period", "1"},
                    run.folder, watch);
    if (is_late) {
        throw InputError(fmt::format(
            "SUMO was stopped after {:.0f} s of wall-clock time. It had simulated {:.0f} of {:.0f} s in {}. Allow more "
            "with --sumo-limit, or shorten the run with --set 'duration=...'",
            run.limit_s, simulated_s(ended.output), run.end_s, run.folder.string()));
    }
    if (!ended.failed()) return;
    constexpr std::size_t kMaxOutput = 2000;  // characters; SUMO can repeat the same warning for every vehicle
    const std::string all = without_step_log(ended.output);
    const std::string output = all.size() > kMaxOutput ? all.substr(0, kMaxOutput) + "\n(output cut off)" : all;
    throw InputError(fmt::format("SUMO failed in {}:\n{}", run.folder.string(), output));
}

// Throws InputError if a signal has a programme in an additional file but none in the network file. SUMO does not load
// such a network.
void check_lights(const SumoNetwork& network) {
    for (const SumoLight& light : network.lights) {
        if (light.signal < 0) continue;
        const SumoSignal& signal = network.net.signals[static_cast<std::size_t>(light.signal)];
        if (signal.defined_in_net) continue;
        throw InputError(fmt::format(
            "{}: tlLogic '{}' is not in {}; SUMO needs a programme for each signal in the network file. Move the "
            "element into the network file, before its connections",
            signal.where, signal.id, network.net.file.string()));
    }
}

std::vector<double> column(const Comparison& comparison, bool ours, double RunSummary::*field) {
    std::vector<double> values;
    for (const ComparedRun& run : comparison.runs) {
        values.push_back(summary_of(ours ? run.ours : run.sumo, comparison.from_s, comparison.to_s).*field);
    }
    return values;
}

// Returns, for each lane of a generated network, the name of its stop line, or "" if the lane has no stop line.
std::vector<std::string> own_stop_lines(const Model& model, const PlainNetwork& network) {
    std::vector<std::string> names(model.graph.lanes.size());
    for (const Detector& detector : model.detectors) {
        if (detector.kind != Detector::Kind::stop_line) continue;
        names[static_cast<std::size_t>(detector.lane)] = network.lane_id(detector.lane);
    }
    return names;
}

// Replaces the keys of `passed_s`, which are names of SUMO's lanes, by the names of the stop lines of these lanes.
void rename_stop_lines(const std::map<std::string, std::string>& names, RunFacts& facts) {
    std::map<std::string, std::vector<double>> renamed;
    for (const auto& [lane, times_s] : facts.passed_s) {
        const auto known = names.find(lane);
        std::vector<double>& passed_s = renamed[known == names.end() ? lane : known->second];
        passed_s.insert(passed_s.end(), times_s.begin(), times_s.end());
    }
    facts.passed_s = std::move(renamed);
}

ComparedRun compare_seed(const Scenario& scenario, std::size_t population, const std::filesystem::path& folder,
                         double sumo_limit_s, const std::function<bool(double)>& on_progress) {
    ComparedRun run{scenario.seed};
    // The run of Stopline is the first half of the work, and the run of SUMO the second half.
    const std::function<bool(double)> on_own_progress = [&](double share) { return on_progress(0.5 * share); };
    const std::function<bool(double)> on_sumo_progress = [&](double share) { return on_progress(0.5 + 0.5 * share); };
    Model model = build_model(scenario, population);
    model.records_detectors = true;
    const double end_s = run_end_s(scenario);
    const NewFolders new_folders(folder);
    std::vector<std::unique_ptr<RunWriter>> writers;
    PlainNetwork network;
    StopLineNames lines;
    if (scenario.network.sumo) {
        lines = stop_line_names(*scenario.network.sumo);
        write_imported_inputs(folder, model, *scenario.network.sumo, lines, end_s);
    } else {
        network = plain_network(model.graph);
        lines.stop_line_of_lane = own_stop_lines(model, network);
        write_sumo_inputs(folder, model, network, end_s);
        make_net_file(folder);
        writers.push_back(make_sumo_route_writer(folder / "vehicles.rou.xml", model, network));
    }
    writers.push_back(make_facts_writer(model, lines.stop_line_of_lane, run.ours));
    Simulation simulation(model);
    const auto start = std::chrono::steady_clock::now();
    run_with_writers(simulation, end_s, writers, on_own_progress);
    run.ours_wall_s = seconds_since(start);
    const Violations& v = simulation.state().records.violations;
    run.violations = v.overlaps + v.conflicts + v.red_entries + v.lost_vehicles + v.deadlocks;
    const auto start_of_sumo = std::chrono::steady_clock::now();
    run_sumo({folder, scenario.seed, end_s, sumo_limit_s, on_sumo_progress});
    run.sumo_wall_s = seconds_since(start_of_sumo);
    const bool has_loops = !scenario.network.sumo || !lines.stop_line_at_end.empty();
    run.sumo = read_sumo_facts(folder, has_loops);
    rename_stop_lines(lines.stop_line_at_end, run.sumo);
    return run;
}

}  // namespace

double ComparedMetric::difference_percent() const {
    if (sumo_only || mean_of(sumo) == 0.0) return std::nan("");
    return 100.0 * (mean_of(ours) / mean_of(sumo) - 1.0);
}

Interval ComparedMetric::band(Band kind) const { return confidence_interval(sumo, kind); }

std::vector<ComparedMetric> Comparison::metrics() const {
    const std::vector<std::pair<const char*, double RunSummary::*>> fields{
        {"throughput_veh_h", &RunSummary::throughput_veh_h},
        {"travel_time_s", &RunSummary::travel_time_s},
        {"stop_line_passages_veh_h", &RunSummary::passages_veh_h},
        {"mean_speed_mps", &RunSummary::speed_mps},
        {"stopped_vehicles", &RunSummary::stopped},
        {"departure_delay_s", &RunSummary::departure_delay_s}};
    std::vector<ComparedMetric> metrics;
    for (const auto& [name, field] : fields) {
        // On a generated network, SUMO's planned departures are the times at which vehicles entered the network in the
        // run of Stopline. So only SUMO's runs can have departure delays.
        const bool sumo_only = field == &RunSummary::departure_delay_s && !imported;
        metrics.push_back({name, column(*this, true, field), column(*this, false, field), sumo_only});
        if (field != &RunSummary::passages_veh_h || has_stop_lines) continue;
        for (std::vector<double>* const values : {&metrics.back().ours, &metrics.back().sumo}) {
            std::fill(values->begin(), values->end(), std::nan(""));
        }
    }
    if (imported) {
        metrics.push_back(
            {"backlog", column(*this, true, &RunSummary::backlog), column(*this, false, &RunSummary::backlog)});
    }
    metrics.push_back({"teleported", {}, {}});
    for (const ComparedRun& run : runs) {
        metrics.back().ours.push_back(static_cast<double>(run.ours.teleported));
        metrics.back().sumo.push_back(static_cast<double>(run.sumo.teleported));
    }
    return metrics;
}

Comparison compare_with_sumo(const Scenario& scenario, std::size_t population, const std::filesystem::path& folder,
                             const CompareOptions& options) {
    if (scenario.network.sumo) check_lights(*scenario.network.sumo);
    if (!has_sumo()) {
        throw InputError(
            "SUMO is not installed or does not run. Install it with 'pip install eclipse-sumo' and add its bin folder to "
            "PATH; 'sumo --version' and 'netconvert --version' must work");
    }
    Comparison comparison;
    comparison.population = scenario.populations.at(population).name;
    comparison.note = sumo_limits_note(build_model(scenario, population));
    comparison.to_s = run_end_s(scenario);
    comparison.from_s = options.from_s < 0.0 ? run_kind(scenario).measured_window(scenario).from_s : options.from_s;
    if (comparison.from_s >= comparison.to_s) {
        throw InputError(
            fmt::format("there is nothing to compare: the compared time starts at {:g} s, but the run ends at "
                        "{:g} s",
                        comparison.from_s, comparison.to_s));
    }
    comparison.imported = scenario.network.sumo != nullptr;
    if (comparison.imported)
        comparison.has_stop_lines = !stop_line_names(*scenario.network.sumo).stop_line_at_end.empty();
    const NewFolders new_folders(folder);
    for (int k = 0; k < options.repetitions; ++k) {
        Scenario run_scenario = scenario;
        run_scenario.seed = scenario.seed + static_cast<std::uint64_t>(k);
        comparison.runs.push_back(
            compare_seed(run_scenario, population, folder / fmt::format("seed_{}", run_scenario.seed),
                         options.sumo_limit_s, [&](double share) {
                             return !options.on_progress || options.on_progress((k + share) / options.repetitions);
                         }));
    }
    return comparison;
}

std::string comparison_csv(const Comparison& comparison) {
    CsvWriter csv({"metric", "seed", "ours", "sumo"});
    for (const ComparedMetric& metric : comparison.metrics()) {
        for (std::size_t k = 0; k < metric.ours.size(); ++k) {
            csv.row({metric.name, std::to_string(comparison.runs[k].seed), fixed(metric.ours[k], 4),
                     fixed(metric.sumo[k], 4)});
        }
    }
    return csv.text();
}

}  // namespace stopline
