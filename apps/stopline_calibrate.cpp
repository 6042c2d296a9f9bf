// stopline-calibrate: step I fits the mesoscale mode to the times at which vehicles pass detectors in full dynamics.
// Step II checks if throughput, density and travel time of the mesoscale mode lie in the confidence bands of full
// dynamics.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/command_files.h"
#include "base/io/data_directory.h"
#include "base/io/output.h"
#include "base/text_hash.h"
#include "calibrate/calibration_text.h"
#include "calibration/calibration.h"
#include "calibration/leader_profile.h"
#include "common/command_line.h"
#include "common/examples.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/results.h"
#include "figures/studies/calibration_figures.h"
#include "runs/tables/column_aliases.h"
#include "scenario/load_scenario.h"
#include "scenario/sweep_file/load_sweep.h"
#include "sweeps/sweep_results.h"
#include "sweeps/sweep_run.h"

namespace {

using namespace stopline;

struct CalibrateCliOptions {
    CommonOptions common;
    std::string timing_sweep;
    std::string metrics_sweep;
    std::string start = "start";
    std::string reference = "table2";
    std::string parameters;  // parameters to evaluate instead of a fit; empty: fit
    std::string accepted;
    std::string step = "both";
    std::vector<std::string> metrics;
    FitOptions fit;
};

std::string scenario_file(const char* name) {
    return (std::filesystem::absolute(scenario_directory()) / "sweeps" / name)
        .lexically_normal()
        .lexically_relative(std::filesystem::current_path())
        .string();
}

void declare(Options& app, CalibrateCliOptions& options) {
    app.add(
        "SWEEP", options.timing_sweep,
        runnable("Sweep file of step I; its scenario needs detectors (default: scenarios/sweeps/calibration.yaml)"));
    app.add("--metrics-sweep", options.metrics_sweep,
            runnable("Sweep file of step II, with at least three repetitions (default: "
                     "scenarios/sweeps/intersection.yaml)"))
        .type_name("FILE");
    app.add("--step", options.step, "Step to run: I, II or both (default: both)").one_of({"I", "II", "both"});
    app.add("--start", options.start, "Parameters at which the fit starts (default: start)").type_name("NAME|FILE");
    app.add("--reference,--beside", options.reference,
            "Parameters to compare the result with (default: table2, from the paper)")
        .type_name("NAME|FILE");
    app.add("--parameters", options.parameters, "Evaluate these parameters instead of fitting").type_name("NAME|FILE");
    app.add("--accepted", options.accepted, "List of reviewed differences that count as valid (YAML)")
        .type_name("FILE");
    app.add("--metric", options.metrics,
            "Result column to check in step II (repeatable; default: throughput, density and travel time)")
        .type_name("COLUMN");
    app.add("--starts", options.fit.starts, "Number of starts of the search for each car-following model (default: 3)")
        .range(1, 100);
    app.add("--evaluations", options.fit.joint_evaluations,
            "Evaluations of the last search, for all models together (default: 800)")
        .range(1, 100'000);
    app.add("--evaluations-per-start,--evaluations-apart", options.fit.evaluations_per_start,
            "Evaluations from each start, for one model (default: 250)")
        .range(1, 100'000);
    add_common_options(app, options.common, "Folder for stored runs, tables and figures (default: out/calibration)");
    add_set_option(app, options.common);
    add_old_column_names_option(app, options.common);
    app.footer(
        runnable(
            "\nEach finished run is stored at once. After an interruption, the same command continues and ends with\n"
            "the same files.\n\n"
            "Examples:\n"
            "  stopline-calibrate\n"
            "  stopline-calibrate --step I --parameters table2 --output out/table2\n"
            "  stopline-calibrate --step I scenarios/sweeps/calibration.yaml --start fitted --output out/refit\n\n"
            "Next: use the fitted parameters in a run\n"
            "  stopline-run scenarios/intersection.yaml --set fidelity=meso \\\n"
            "      --set meso=\"$PWD/out/calibration/fitted.yaml\"\n\n") +
        kExitCodesText);
}

RunStore open_store(const std::filesystem::path& file, const std::string& name, const std::string& key,
                    std::size_t points, const std::string& provenance) {
    StoreIdentity identity;
    identity.name = name;
    identity.sweep = key;
    identity.program = required_program_identity();
    identity.points = points;
    identity.provenance = provenance;
    return RunStore::open_or_make(file, identity);
}

// Loads the parameters of the mesoscale mode that an option names, and prints the warnings that loading returns.
MesoSettings load_meso_file(const char* option, const std::string& name_or_path) {
    std::vector<std::string> warnings;
    try {
        MesoSettings settings = load_meso(name_or_path, ".", &warnings);
        print_warnings(warnings);
        return settings;
    } catch (const InputError& error) {
        throw InputError(fmt::format("{} {}", option, error.what()));
    }
}

// One sweep of the calibration, with all its results.
struct CompletedSweep {
    Sweep sweep;
    RunStore store;
    SweepTotals totals;
};

// Loads a sweep file with the settings of the command line and with `overrides`. Prints its warnings.
Sweep open_sweep(const CalibrateCliOptions& options, const std::string& file,
                 const std::vector<std::string>& overrides) {
    SweepOptions sweep_options;
    sweep_options.overrides = options.common.settings;
    if (options.common.seed) sweep_options.overrides.push_back(fmt::format("seed={}", *options.common.seed));
    sweep_options.overrides.insert(sweep_options.overrides.end(), overrides.begin(), overrides.end());
    sweep_options.threads = thread_count(options.common.threads);
    Sweep sweep(load_sweep(file), sweep_options);
    print_warnings(sweep.warnings());
    return sweep;
}

// Runs all points of a sweep that are not stored yet. `file` is the sweep file.
CompletedSweep run_sweep(const CalibrateCliOptions& options, const std::string& file, Sweep sweep,
                         const std::filesystem::path& store_file, RunFunction run, const std::string& label) {
    RunStore store = open_store(store_file, label, sweep.key(), sweep.points(),
                                sweep_provenance(sweep, command_text("stopline-calibrate", file, options.common)));
    const std::vector<std::size_t> todo = missing_points(sweep, Shard{}, store);
    SweepSession session;
    {
        ProgressBar bar(fmt::format("{}: {} runs", label, sweep.points()));
        SweepRunOptions run_options;
        run_options.threads = thread_count(options.common.threads);
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

// Returns the evaluations that earlier sessions stored, indexed by the number of the evaluation. An evaluation is a set
// of parameter values and its loss. Its text in the store begins with the loss, and the values follow.
std::vector<std::optional<FitEvaluation>> stored_evaluations(const RunStore& store) {
    std::vector<std::optional<FitEvaluation>> stored(store.identity().points);
    store.for_each_run([&](std::size_t index, const std::string& text) {
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
        stored.at(index) = e;
    });
    return stored;
}

MesoFit run_fit(const CalibrateCliOptions& options, const std::vector<CalibrationCase>& cases,
                const CompletedSweep& full, const MesoSettings& start, const std::filesystem::path& folder) {
    FitOptions fit = options.fit;
    fit.threads = thread_count(options.common.threads);
    const std::string key = fmt::format("{} {} {} {} {:016x}", full.sweep.key(), fit.starts, fit.evaluations_per_start,
                                        fit.joint_evaluations, hash_of(meso_yaml(start, "")));
    const auto max_evaluations =
        static_cast<std::size_t>(2 * fit.starts * (fit.evaluations_per_start + 100) + fit.joint_evaluations + 100);
    RunStore store = open_store(folder / "fit.sqlite", "fit", key, max_evaluations, "");
    const std::vector<std::optional<FitEvaluation>> stored = stored_evaluations(store);
    fit.stored_loss = [&](std::size_t index, const std::vector<double>& values) -> std::optional<double> {
        if (index >= stored.size() || !stored[index] || stored[index]->values != values) return std::nullopt;
        return stored[index]->loss;
    };
    fit.on_evaluation = [&](std::size_t index, const FitEvaluation& e) {
        std::string text = fmt::format("{:a}", e.loss);
        for (const double value : e.values) text += fmt::format(" {:a}", value);
        if (!(index < stored.size() && stored[index])) store.put(index, text);
    };
    ProgressBar bar("fit");
    fit.on_progress = [&bar](double share) { return bar.update(share); };
    std::vector<FitCase> fit_cases;
    for (const CalibrationCase& c : cases) fit_cases.push_back(c.fit);
    return fit_meso(fit_cases, start, fit);
}

// Writes tables and other files, and prints their names.
void write_all(const std::vector<std::pair<std::string, std::string>>& files, const std::filesystem::path& folder,
               ColumnNames names) {
    fmt::print("\nWritten to {}\n", folder.string());
    for (const auto& [name, text] : files) {
        const std::string table = name.starts_with("bands_") ? "bands_NAME.csv" : name;
        const bool is_table = name.ends_with(".csv");
        write_file(folder / name, is_table ? result_file("calibrate/" + table, name, text, names).text : text);
        fmt::print("  {}\n", name);
    }
}

// Carries out step I: fits or evaluates parameters and returns them. Sets `no_violations` to false if a run has
// violations.
MesoSettings step_one(const CalibrateCliOptions& options, const std::filesystem::path& folder, bool& no_violations) {
    const std::string file = options.timing_sweep.empty() ? scenario_file("calibration.yaml") : options.timing_sweep;
    const AcceptedFile accepted = options.accepted.empty() ? AcceptedFile{} : load_accepted(options.accepted);
    MesoSettings start = load_meso_file("--start", options.start);
    std::optional<MesoSettings> given;
    if (!options.parameters.empty()) given = load_meso_file("--parameters", options.parameters);
    const MesoSettings reference = load_meso_file("--reference", options.reference);
    Sweep sweep = open_sweep(options, file, {"fidelity=full"});
    check_accepted(accepted, sweep);
    const CompletedSweep full =
        run_sweep(options, file, std::move(sweep), folder / "passages.sqlite", detector_metrics, "full dynamics");
    if (!given && !start.leader_profile_mps.empty()) measure_leader_profile(full.sweep.base(), start);
    const std::vector<CalibrationCase> cases = calibration_cases(full.sweep, full.store, start);
    MesoFit fit;
    if (!given) fit = run_fit(options, cases, full, start, folder);
    MesoSettings chosen = given ? *given : fit.settings;
    if (!given) chosen.name = "fitted";
    const int threads = thread_count(options.common.threads);
    std::vector<TimingResult> results{evaluate_timing(reference.name, cases, reference, threads)};
    if (chosen.name != reference.name) results.push_back(evaluate_timing(chosen.name, cases, chosen, threads));
    fmt::print("{}{}", timing_text(results, cases, accepted), parameters_text(results));
    const std::vector<TimingMiss> misses = timing_misses(results.back(), cases, accepted);
    std::vector<std::pair<std::string, std::string>> files{{"permutations.csv", permutations_csv(results, cases)},
                                                           {"differences.csv", differences_csv(results.back(), cases)},
                                                           {"misses.csv", misses_csv(misses, cases)}};
    if (!given) {
        files.emplace_back(
            "fitted.yaml",
            meso_yaml(chosen, fmt::format("Fitted by stopline-calibrate to full dynamics: sweep {}, scenario {}.\n"
                                          "The fit started with the parameters {}.",
                                          full.sweep.settings().name, full.sweep.base().name, start.name)));
        files.emplace_back("fit_history.csv", history_csv(fit));
    }
    write_all(files, folder, column_names(options.common));
    draw_figures(timing_figures(results, cases, fit.history), folder);
    for (const TimingResult& result : results) no_violations = no_violations && result.violations.none();
    no_violations = no_violations && full.totals.runs_with_violations == 0;
    return chosen;
}

// Returns the values of --metric with the current column names. Prints a warning for each old name.
std::vector<std::string> current_metrics(std::vector<std::string> metrics) {
    OldNameReader old_names("sweep/NAME.csv");
    for (std::string& metric : metrics) metric = old_names.column(metric);
    print_warnings(old_names.warnings());
    return metrics;
}

// The input of step II, loaded and checked before the first run of either step.
struct StepTwoInput {
    std::string file;  // sweep file
    Sweep full;        // in full dynamics
    std::vector<std::string> metrics;
    std::string reference;  // name of the parameters of --reference
};

StepTwoInput load_step_two(const CalibrateCliOptions& options) {
    const std::string file = options.metrics_sweep.empty() ? scenario_file("intersection.yaml") : options.metrics_sweep;
    Sweep full = open_sweep(options, file, {"fidelity=full"});
    std::vector<std::string> metrics = band_metrics(full, current_metrics(options.metrics));
    return {file, std::move(full), std::move(metrics), load_meso_file("--reference", options.reference).name};
}

void step_two(const CalibrateCliOptions& options, StepTwoInput input, const std::filesystem::path& folder,
              const MesoSettings& chosen, bool& no_violations) {
    const std::string& file = input.file;
    const std::string& reference = input.reference;
    const std::filesystem::path parameters = folder / "parameters.yaml";
    write_file(parameters, meso_yaml(chosen, "The parameters of this calibration."));
    const CompletedSweep full =
        run_sweep(options, file, std::move(input.full), folder / "metrics_full.sqlite", run_metrics, "full dynamics");
    std::vector<std::pair<std::string, std::string>> files;
    std::vector<std::pair<std::string, std::string>> sets{{reference, options.reference}};
    if (chosen.name != reference) sets.emplace_back("calibrated", std::filesystem::absolute(parameters).string());
    std::vector<BandCheck> checks;
    for (const auto& [name, meso] : sets) {
        const CompletedSweep runs =
            run_sweep(options, file, open_sweep(options, file, {"fidelity=meso", "meso=" + meso}),
                      folder / ("metrics_" + name + ".sqlite"), run_metrics, "mesoscale mode, " + name);
        checks.push_back(check_bands(full.sweep, full.store, runs.store, input.metrics));
        files.emplace_back("bands_" + name + ".csv", bands_csv(checks.back()));
        no_violations = no_violations && runs.totals.runs_with_violations == 0;
    }
    fmt::print(
        "\nStep II: share of {} permutations with the mean of the mesoscale mode in the 95 % band of full dynamics\n",
        checks.back().permutations);
    for (std::size_t k = 0; k < checks.size(); ++k) fmt::print("{}", bands_text(sets[k].first, checks[k]));
    write_all(files, folder, column_names(options.common));
    draw_figures(band_figures(checks.back()), folder);
    no_violations = no_violations && full.totals.runs_with_violations == 0;
}

// Makes `text` an absolute path if it is a path, because a relative path in --set would refer to the folder of the
// scenario. Returns the name of shipped parameters, such as table2, unchanged.
std::string name_or_absolute_path(const std::string& text) {
    const bool is_path = text.find('/') != std::string::npos || text.ends_with(".yaml");
    return is_path ? std::filesystem::absolute(text).lexically_normal().string() : text;
}

// Throws InputError for options that have no effect on the chosen steps.
void check_options(const CalibrateCliOptions& options, const Options& app) {
    const std::vector<std::string> of_fit{"--starts", "--evaluations", "--evaluations-per-start"};
    const std::vector<std::string> of_step_one{"SWEEP", "--start", "--accepted"};
    const std::vector<std::string> of_step_two{"--metrics-sweep", "--metric"};
    const auto refuse = [&](const std::vector<std::string>& names, const char* condition) {
        for (const std::string& name : app.given()) {
            if (std::find(names.begin(), names.end(), name) == names.end()) continue;
            throw InputError(fmt::format("{} has no effect with {}; leave one of them out", name, condition));
        }
    };
    if (!options.parameters.empty()) refuse(of_fit, "--parameters");
    if (options.step == "I") refuse(of_step_two, "--step I");
    if (options.step != "II") return;
    refuse(of_fit, "--step II");
    refuse(of_step_one, "--step II");
}

// Throws InputError if a result would overwrite a file that the command reads.
void check_files(const CalibrateCliOptions& options, const std::filesystem::path& folder) {
    CommandFiles files;
    const auto add_sweep = [&](const std::string& given, const char* shipped) {
        const std::string file = given.empty() ? scenario_file(shipped) : given;
        add_sweep_inputs(files, file, load_sweep(file), options.common.settings);
    };
    if (options.step != "II") add_sweep(options.timing_sweep, "calibration.yaml");
    if (options.step != "I") add_sweep(options.metrics_sweep, "intersection.yaml");
    for (const auto& [option, file] : {std::pair{"--start", options.start},
                                       {"--reference", options.reference},
                                       {"--parameters", options.parameters},
                                       {"--accepted", options.accepted}}) {
        std::error_code ignored;
        if (std::filesystem::is_regular_file(file, ignored)) files.add_input(file, option);
    }
    const char* const role = "a result in the folder of --output";
    if (options.step != "II") files.add_outputs(folder, {"permutations.csv", "differences.csv", "misses.csv"}, role);
    if (options.step != "II" && options.parameters.empty()) {
        files.add_outputs(folder, {"fitted.yaml", "fit_history.csv"}, role);
    }
    if (options.step != "I") files.add_output(folder / "parameters.yaml", role);
}

ExitCode calibrate(const CalibrateCliOptions& options) {
    const std::filesystem::path folder = options.common.output.empty() ? "out/calibration" : options.common.output;
    check_files(options, folder);
    prepare_folder(folder);
    const std::string parameters = options.parameters.empty() ? (folder / "fitted.yaml").string() : options.parameters;
    bool no_violations = true;
    MesoSettings chosen;
    if (options.step == "II") chosen = load_meso_file("--parameters", parameters);
    std::optional<StepTwoInput> input;
    if (options.step != "I") input = load_step_two(options);
    if (options.step != "II") chosen = step_one(options, folder, no_violations);
    if (input) step_two(options, *std::move(input), folder, chosen, no_violations);
    fmt::print("{}", runnable(fmt::format("\nNext: use the parameters in a run\n"
                                          "  stopline-run scenarios/intersection.yaml --set fidelity=meso --set {}\n",
                                          shell_word("meso=" + name_or_absolute_path(parameters)))));
    if (!no_violations) {
        fmt::print("VIOLATIONS: vehicles overlapped, entered on red or were lost in some runs.\n");
    }
    return no_violations ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("stopline-calibrate", [&] {
        Options app("Fits the mesoscale mode to full dynamics and checks that both give the same results.",
                    "stopline-calibrate");
        CalibrateCliOptions options;
        declare(app, options);
        const std::optional<ExitCode> end = app.parse(argc, argv);
        if (!end) check_options(options, app);
        return end ? *end : calibrate(options);
    });
}
