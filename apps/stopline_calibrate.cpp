// stopline-calibrate: fits the mesoscale mode to full dynamics by the times of passages at detectors (step I), then checks its
// throughput, density and travel time against the confidence bands of full dynamics (step II).
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>

#include "base/input_error.h"
#include "common/command_line.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/results.h"
#include "common/text_table.h"
#include "experiment/calibration.h"
#include "experiment/calibration_figures.h"
#include "experiment/leader_profile.h"
#include "experiment/output.h"
#include "experiment/program_identity.h"
#include "experiment/sweep_results.h"
#include "experiment/sweep_run.h"
#include "scenario/load_scenario.h"
#include "scenario/load_sweep.h"

namespace {

using namespace stopline;

struct CalibrateOptions {
    CommonOptions common;
    std::string timing_sweep;
    std::string metrics_sweep;
    std::string start = "start";
    std::string beside = "table2";
    std::string parameters;  // judged without a fit
    std::string accepted;
    std::string step = "both";
    std::vector<std::string> metrics;
    FitOptions fit;
};

std::string scenario_file(const char* name) {
    return (data_directory().parent_path() / "scenarios" / "sweeps" / name)
        .lexically_relative(std::filesystem::current_path())
        .string();
}

void declare(CLI::App& app, CalibrateOptions& options) {
    app.add_option("SWEEP", options.timing_sweep,
                   "Sweep file of step I, of any scenario with detectors (default: scenarios/sweeps/calibration.yaml)");
    app.add_option(
           "--metrics-sweep", options.metrics_sweep,
           "Sweep file of step II, with three repetitions or more (default: scenarios/sweeps/intersection.yaml)")
        ->type_name("FILE");
    app.add_option("--step", options.step, "What to do: I, II or both (default)")
        ->check(CLI::IsMember({"I", "II", "both"}));
    app.add_option("--start", options.start, "Parameters that the fit begins with (default: start)")
        ->type_name("NAME|FILE");
    app.add_option("--beside", options.beside, "Parameters that ours are shown beside (default: table2, the paper's)")
        ->type_name("NAME|FILE");
    app.add_option("--parameters", options.parameters, "Judge these parameters instead of fitting")
        ->type_name("NAME|FILE");
    app.add_option("--accepted", options.accepted, "Differences that someone has looked at and accepts (YAML)")
        ->type_name("FILE");
    app.add_option("--metric", options.metrics,
                   "Result to compare in step II (repeatable; default: throughput, density "
                   "and travel time)")
        ->type_name("COLUMN");
    app.add_option("--starts", options.fit.starts, "Starts of the search for each model (default: 3)")
        ->check(CLI::Range(1, 100));
    app.add_option("--evaluations", options.fit.evaluations_together, "Evaluations of the last search (default: 800)")
        ->check(CLI::Range(1, 100'000));
    app.add_option("--evaluations-apart", options.fit.evaluations_apart,
                   "Evaluations from each start, for one model alone (default: 250)")
        ->check(CLI::Range(1, 100'000));
    add_common_options(app, options.common, "Folder for stores, tables and figures (default: out/calibration)");
    add_set_option(app, options.common);
    app.footer(
        std::string(
            "\nEverything that is finished is stored at once: started again after an interrupt or a kill, the same\n"
            "command goes on and ends with the same files.\n\n"
            "Examples:\n"
            "  stopline-calibrate\n"
            "  stopline-calibrate --step I --parameters table2 --output out/table2\n"
            "  stopline-calibrate --step I my_sweep.yaml --start fitted --output out/mine\n\n"
            "Next: name the result in a scenario, fidelity: meso and meso: out/calibration/fitted.yaml.\n\n") +
        kExitCodesText);
}

RunStore store_of(const std::filesystem::path& file, const std::string& name, const std::string& key,
                  std::size_t points, const std::string& provenance) {
    StoreIdentity identity;
    identity.name = name;
    identity.sweep = key;
    identity.program = identity_of_program();
    identity.points = points;
    identity.provenance = provenance;
    return RunStore::open_or_make(file, identity);
}

// One sweep of a calibration, run or taken from its store.
struct Runs {
    Sweep sweep;
    RunStore store;
    SweepTotals totals;
};

Runs run_sweep(const CalibrateOptions& options, const std::string& file, const std::vector<std::string>& overrides,
               const std::filesystem::path& store_file, RunFunction run, const std::string& label) {
    SweepOptions sweep_options;
    sweep_options.overrides = options.common.settings;
    if (options.common.seed) sweep_options.overrides.push_back(fmt::format("seed={}", *options.common.seed));
    sweep_options.overrides.insert(sweep_options.overrides.end(), overrides.begin(), overrides.end());
    sweep_options.threads = threads_or_all(options.common.threads);
    Sweep sweep(load_sweep(file), sweep_options);
    RunStore store = store_of(store_file, label, sweep.key(), sweep.points(),
                              sweep_provenance(sweep, command_text("stopline-calibrate", file, options.common)));
    const std::vector<std::size_t> todo = points_to_do(sweep, Shard{}, store);
    SweepSession session;
    {
        ProgressBar bar(fmt::format("{}: {} runs", label, sweep.points()));
        SweepRunOptions run_options;
        run_options.threads = sweep_options.threads;
        run_options.on_progress = [&bar](double share) { return bar.update(share); };
        run_options.run = run;
        if (!todo.empty()) session = run_points(sweep, todo, store, run_options);
    }
    for (const SweepFailure& failure : session.failures) {
        throw InputError(fmt::format("{}: {}", sweep.describe(failure.point), failure.message));
    }
    fmt::print("{}: {} runs, {} of them now{}\n", label, sweep.points(), session.runs,
               session.runs == 0
                   ? ""
                   : fmt::format(", in {:.1f} s: {:.1f} million vehicle updates per second", session.wall_s,
                                 static_cast<double>(session.updates) / session.wall_s / 1e6));
    SweepTotals totals = sweep_results(store).totals;
    return {std::move(sweep), std::move(store), totals};
}

// Evaluations of an earlier session, as "loss value value ...".
std::vector<std::optional<FitEvaluation>> stored_evaluations(const RunStore& store) {
    std::vector<std::optional<FitEvaluation>> known(store.identity().points);
    store.each([&](std::size_t index, const std::string& text) {
        std::istringstream in(text);
        FitEvaluation e;
        std::string word;
        bool first = true;
        while (in >> word) {
            const double value = std::strtod(word.c_str(), nullptr);
            if (first) e.loss = value;
            if (!first) e.values.push_back(value);
            first = false;
        }
        known.at(index) = e;
    });
    return known;
}

MesoFit run_fit(const CalibrateOptions& options, const std::vector<CalibrationCase>& cases, const Runs& full,
                const MesoSettings& start, const std::filesystem::path& folder) {
    FitOptions fit = options.fit;
    fit.threads = threads_or_all(options.common.threads);
    const std::string key = fmt::format("{} {} {} {} {:016x}", full.sweep.key(), fit.starts, fit.evaluations_apart,
                                        fit.evaluations_together, hash_of(meso_yaml(start, "")));
    const auto most =
        static_cast<std::size_t>(2 * fit.starts * (fit.evaluations_apart + 100) + fit.evaluations_together + 100);
    RunStore store = store_of(folder / "fit.sqlite", "fit", key, most, "");
    const std::vector<std::optional<FitEvaluation>> known = stored_evaluations(store);
    fit.known = [&](std::size_t index, const std::vector<double>& values) -> std::optional<double> {
        if (index >= known.size() || !known[index] || known[index]->values != values) return std::nullopt;
        return known[index]->loss;
    };
    fit.on_evaluation = [&](std::size_t index, const FitEvaluation& e) {
        std::string text = fmt::format("{:a}", e.loss);
        for (const double value : e.values) text += fmt::format(" {:a}", value);
        if (!(index < known.size() && known[index])) store.put(index, text);
    };
    ProgressBar bar("fit");
    fit.on_progress = [&bar](double share) { return bar.update(share); };
    std::vector<FitCase> fit_cases;
    for (const CalibrationCase& c : cases) fit_cases.push_back(c.fit);
    return fit_meso(fit_cases, start, fit);
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100.0 * share); }

void print_timing(const std::vector<TimingResult>& results, const std::vector<CalibrationCase>& cases,
                  const AcceptedFile& accepted) {
    TextTable table("llr");
    table.row({"parameters", "permutations", "pairs", "within 1 s", "with accepted", "median", "95 %", "other green",
               "unpaired"});
    for (const TimingResult& result : results) {
        const std::vector<TimingMiss> misses = timing_misses(result, cases, accepted);
        for (const auto& [chosen, name] : {std::pair{Chosen::fitted, "in the fit"}, {Chosen::held_out, "held out"}}) {
            const Agreement a = agreement_of(result, cases, chosen);
            table.row({result.name, name, fmt::format("{}", a.pairs), percent(a.within_share),
                       percent(valid_share(result, cases, misses, chosen)), fmt::format("{:.2f} s", a.median_s),
                       fmt::format("{:.2f} s", a.p95_s), fmt::format("{}", a.other_green),
                       fmt::format("{}", a.unpaired)});
        }
    }
    fmt::print("\nStep I: passages at detectors, the k-th of either mode (limit {} s)\n{}", kTimingLimit_s,
               table.text());
}

void print_parameters(const std::vector<TimingResult>& results) {
    TextTable table("lr");
    std::vector<std::string> head{"parameter"};
    for (const TimingResult& result : results) head.push_back(result.name);
    table.row(head);
    for (const FitParameter& p : fit_parameters()) {
        std::vector<std::string> row{fmt::format("{} {}", p.name, p.unit)};
        for (const TimingResult& result : results) {
            MesoSettings settings = result.settings;
            row.push_back(fmt::format("{:.3f}", p.in(settings)));
        }
        table.row(row);
    }
    fmt::print("\n{}", table.text());
}

void write_all(const std::vector<std::pair<std::string, std::string>>& files, const std::filesystem::path& folder) {
    fmt::print("\nWritten to {}\n", folder.string());
    for (const auto& [name, text] : files) {
        write_file(folder / name, text);
        fmt::print("  {}\n", name);
    }
}

// Returns the parameters to go on with.
MesoSettings step_one(const CalibrateOptions& options, const std::filesystem::path& folder, bool& sound) {
    const std::string file = options.timing_sweep.empty() ? scenario_file("calibration.yaml") : options.timing_sweep;
    const AcceptedFile accepted = options.accepted.empty() ? AcceptedFile{} : load_accepted(options.accepted);
    MesoSettings start = load_meso(options.start);
    std::optional<MesoSettings> given;
    if (!options.parameters.empty()) given = load_meso(options.parameters);
    const Runs full =
        run_sweep(options, file, {"fidelity=full"}, folder / "passages.sqlite", detector_metrics, "full dynamics");
    if (!given && !start.leader_profile_mps.empty()) measure_leader_profile(full.sweep.base(), start);
    const std::vector<CalibrationCase> cases = calibration_cases(full.sweep, full.store, start);
    MesoFit fit;
    if (!given) fit = run_fit(options, cases, full, start, folder);
    MesoSettings chosen = given ? *given : fit.settings;
    if (!given) chosen.name = "fitted";
    const int threads = threads_or_all(options.common.threads);
    const MesoSettings beside = load_meso(options.beside);
    std::vector<TimingResult> results{judge_timing(beside.name, cases, beside, threads)};
    if (chosen.name != beside.name) results.push_back(judge_timing(chosen.name, cases, chosen, threads));
    print_timing(results, cases, accepted);
    print_parameters(results);
    const std::vector<TimingMiss> misses = timing_misses(results.back(), cases, accepted);
    std::vector<std::pair<std::string, std::string>> files{{"permutations.csv", permutations_csv(results, cases)},
                                                           {"differences.csv", differences_csv(results.back(), cases)},
                                                           {"misses.csv", misses_csv(misses, cases)}};
    if (!given) {
        files.emplace_back(
            "fitted.yaml",
            meso_yaml(chosen, fmt::format("Fitted by stopline-calibrate to full dynamics, {} (scenario {}),\n"
                                          "beginning with {}.",
                                          full.sweep.settings().name, full.sweep.base().name, start.name)));
        files.emplace_back("fit_history.csv", history_csv(fit));
    }
    write_all(files, folder);
    draw_all(timing_figures(results, cases, fit.history), folder);
    for (const TimingResult& result : results) sound = sound && result.violations.none();
    sound = sound && full.totals.runs_with_violations == 0;
    return chosen;
}

void print_bands(const std::string& name, const BandCheck& check) {
    TextTable table("lr");
    table.row({name, "paper", "student", "mean |difference|", "mean difference", "half of a band"});
    for (const MetricBands& metric : check.metrics) {
        table.row({metric.metric, percent(metric.share_inside(Band::paper)),
                   percent(metric.share_inside(Band::student)), percent(metric.mean_difference_share()),
                   percent(metric.mean_shift_share()), percent(metric.median_half_width_share())});
    }
    table.row({"all of them", percent(check.share_inside(Band::paper)), percent(check.share_inside(Band::student)), "",
               "", ""});
    fmt::print("\n{}", table.text());
}

void step_two(const CalibrateOptions& options, const std::filesystem::path& folder, const MesoSettings& chosen,
              bool& sound) {
    const std::string file = options.metrics_sweep.empty() ? scenario_file("intersection.yaml") : options.metrics_sweep;
    const std::filesystem::path parameters = folder / "parameters.yaml";
    write_file(parameters, meso_yaml(chosen, "The parameters of this calibration."));
    const Runs full =
        run_sweep(options, file, {"fidelity=full"}, folder / "metrics_full.sqlite", run_metrics, "full dynamics");
    const std::vector<std::string> metrics = band_metrics(full.store, options.metrics);
    std::vector<std::pair<std::string, std::string>> files;
    const std::string beside = load_meso(options.beside).name;
    std::vector<std::pair<std::string, std::string>> sets{{beside, options.beside}};
    if (chosen.name != beside) sets.emplace_back("calibrated", std::filesystem::absolute(parameters).string());
    std::vector<BandCheck> checks;
    for (const auto& [name, meso] : sets) {
        const Runs runs = run_sweep(options, file, {"fidelity=meso", "meso=" + meso},
                                    folder / ("metrics_" + name + ".sqlite"), run_metrics, "mesoscale mode, " + name);
        checks.push_back(check_bands(full.sweep, full.store, runs.store, metrics));
        files.emplace_back("bands_" + name + ".csv", bands_csv(checks.back()));
        sound = sound && runs.totals.runs_with_violations == 0;
    }
    fmt::print("\nStep II: share of {} permutations whose mesoscale mean lies in the 95 % band of full dynamics\n",
               checks.back().permutations);
    for (std::size_t k = 0; k < checks.size(); ++k) print_bands(sets[k].first, checks[k]);
    write_all(files, folder);
    draw_all(band_figures(checks.back()), folder);
    sound = sound && full.totals.runs_with_violations == 0;
}

ExitCode calibrate(const CalibrateOptions& options) {
    const std::filesystem::path folder = options.common.output.empty() ? "out/calibration" : options.common.output;
    prepare_folder(folder);
    bool sound = true;
    MesoSettings chosen;
    if (options.step != "II") {
        chosen = step_one(options, folder, sound);
    } else {
        chosen = load_meso(options.parameters.empty() ? (folder / "fitted.yaml").string() : options.parameters);
    }
    if (options.step != "I") step_two(options, folder, chosen, sound);
    fmt::print("\nNext: 'fidelity: meso' and 'meso: {}' in a scenario, or --set of both.\n",
               options.parameters.empty() ? (folder / "fitted.yaml").string() : options.parameters);
    if (!sound) fmt::print("Vehicles overlapped, entered on red or were lost in some runs: see the stores.\n");
    return sound ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("stopline-calibrate", [&] {
        CLI::App app("Fits the mesoscale mode to full dynamics and checks that it gives the same answers.",
                     "stopline-calibrate");
        CalibrateOptions options;
        declare(app, options);
        const std::optional<ExitCode> end = parse_command_line(app, argc, argv);
        return end ? *end : calibrate(options);
    });
}
