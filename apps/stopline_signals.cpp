// stopline-signals: times the signal of an intersection or a grid. Start values follow from the demand and the measured
// saturation flow of each population (Webster, HCM). A search by simulation improves them.
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/command_files.h"
#include "base/io/console.h"
#include "base/io/output.h"
#include "common/command_line.h"
#include "common/examples.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/results.h"
#include "figures/studies/timing_figure.h"
#include "runs/provenance.h"
#include "scenario/schema/quantity.h"
#include "signal_timing/signal_timing.h"
#include "signal_timing/timing_search.h"
#include "signals/timing_text.h"
#include "sweeps/sweep_merge.h"
#include "sweeps/sweep_results.h"
#include "sweeps/sweep_run.h"

namespace stopline {

namespace {

struct SignalsCliOptions {
    CommonOptions common;
    std::string file;
    std::vector<std::string> populations;
    std::string min_green = "5 s";
    bool pedestrians = false;
    bool search = false;
    std::string objective;  // empty: delay
    int seeds = 3;
    int greens = 5;
    int offsets = 6;
    std::string range = "1.6";
    bool no_figures = false;
};

void declare(Options& app, SignalsCliOptions& options) {
    app.add("SCENARIO", options.file,
            "Scenario with an intersection or a grid, fixed-time signals without phases, and demand by rate");
    add_population_option(app, options.populations, "all populations");
    app.add("--min-green", options.min_green, "Shortest green, rounded up to whole seconds")
        .type_name("TIME")
        .show_default();
    app.add_flag("--pedestrians", options.pedestrians, "Make greens long enough for pedestrians who cross a leg");
    app.add_flag("--search", options.search, "Run all combinations of some greens and offsets around the start values");
    app.add("--objective", options.objective, "With --search: minimise delay, or maximise throughput (default: delay)")
        .only_with({"--search"})
        .one_of({"delay", "throughput"});
    app.add("--seeds", options.seeds, "With --search: number of runs of each setting")
        .only_with({"--search"})
        .range(1, 1000)
        .show_default();
    app.add("--greens", options.greens, "With --search: number of values for each green, odd")
        .only_with({"--search"})
        .range(1, 99)
        .show_default();
    app.add("--range", options.range, "With --search: greens from start value / NUMBER to start value x NUMBER")
        .only_with({"--search"})
        .type_name("NUMBER")
        .show_default();
    app.add("--offsets", options.offsets, "With --search: number of offsets, in networks of several intersections")
        .only_with({"--search"})
        .range(1, 100)
        .show_default();
    app.add_flag("--no-figures", options.no_figures, "Do not draw figures");
    add_common_options(app, options.common, "Folder for the results (default: out/signals_ and the name of the file)");
    add_set_option(app, options.common);
    app.footer(
        runnable(
            "\nFinished runs of a search are stored at once. After an interruption, the same command continues.\n\n"
            "Examples:\n"
            "  stopline-signals scenarios/intersection.yaml --set demand.kind=rate --set demand.start=empty \\\n"
            "      --set 'demand.inflow=900 veh/h' --population CTG-Ref --population CDG\n"
            "  stopline-signals scenarios/arterial.yaml --set demand.kind=rate --set 'demand.inflow=500 veh/h' \\\n"
            "      --set 'duration=1800 s' --set 'measure.window=900 s' --population CTG-Ref --search --seeds 2\n\n"
            "Next: run the scenario with the times, as the program prints them at its end.\n\n") +
        kExitCodesText);
}

// Returns a quantity from the command line in SI units. Throws InputError unless it is from `low` to `high`.
double option_quantity(const char* option, const std::string& text, const char* in, double low, double high) {
    const ParsedQuantity parsed = parse_quantity(text, unit(in));
    if (!parsed.problem.empty()) throw InputError(fmt::format("{}: value '{}' {}", option, text, parsed.problem));
    if (parsed.si < low || parsed.si > high) {
        const std::string with_unit = *in == 0 ? "" : std::string(" ") + in;
        throw InputError(fmt::format("{}: value '{}' is not allowed; allowed: {:g}{} to {:g}{}", option, text, low,
                                     with_unit, high, with_unit));
    }
    return parsed.si;
}

void check_options(const SignalsCliOptions& options) {
    if (options.file.empty()) {
        throw InputError(runnable("no scenario given; try: stopline-signals scenarios/intersection.yaml (or --help)"));
    }
    if (options.greens % 2 == 0) {
        throw InputError(
            fmt::format("--greens: value '{}' is even; give an odd number, so that the start value is in "
                        "the middle",
                        options.greens));
    }
}

std::filesystem::path folder_of(const SignalsCliOptions& options) {
    if (!options.common.output.empty()) return options.common.output;
    return "out/signals_" + std::filesystem::path(options.file).stem().string();
}

std::string command_of(const SignalsCliOptions& options) {
    const SignalsCliOptions defaults;
    std::string command = command_text("stopline-signals", options.file, options.common);
    const auto add = [&](const char* name, const std::string& value, const std::string& by_default) {
        if (value != by_default) command += fmt::format(" {} {}", name, shell_word(value));
    };
    for (const std::string& name : options.populations) add("--population", name, "");
    add("--min-green", options.min_green, defaults.min_green);
    if (options.pedestrians) command += " --pedestrians";
    if (!options.search) return command;
    command += " --search";
    add("--objective", options.objective, defaults.objective);
    add("--seeds", std::to_string(options.seeds), std::to_string(defaults.seeds));
    add("--greens", std::to_string(options.greens), std::to_string(defaults.greens));
    add("--offsets", std::to_string(options.offsets), std::to_string(defaults.offsets));
    add("--range", options.range, defaults.range);
    return command;
}

// Throws InputError if a result would overwrite a file that the scenario names.
void check_files(const SignalsCliOptions& options, const Scenario& scenario) {
    CommandFiles files;
    add_scenario_inputs(files, options.file, options.common);
    std::vector<std::string> names{"timing.csv", "lanes.csv", "search.csv", "signals.provenance.json"};
    for (const PopulationSettings& population : scenario.populations) {
        names.push_back("search_" + population.name + ".csv");
        names.push_back("search_" + population.name + ".sqlite");
    }
    files.add_outputs(folder_of(options), names, "a result in the folder of --output");
}

// The search of one population: its sweep, its open store, and the numbers of the runs that the store lacks.
struct PreparedSearch {
    const PopulationTiming* start = nullptr;
    Sweep sweep;
    RunStore store;
    std::vector<std::size_t> todo;
};

PreparedSearch prepare_search(const Scenario& scenario, const PopulationTiming& start, const SearchOptions& options,
                              const TimingOptions& timing, const SignalsCliOptions& cli) {
    SweepOptions sweep_options;
    sweep_options.overrides = search_overrides(scenario, start.saturation.population, options);
    if (cli.common.seed) sweep_options.overrides.push_back(fmt::format("seed={}", *cli.common.seed));
    sweep_options.threads = timing.threads;
    Sweep sweep(search_settings(scenario, start, options, timing), sweep_options);
    print_warnings(sweep.warnings());
    StoreIdentity identity;
    identity.name = sweep.settings().name;
    identity.sweep = sweep.key();
    identity.program = required_program_identity();
    identity.points = sweep.points();
    identity.provenance = sweep_provenance(sweep, command_of(cli));
    RunStore store = RunStore::open_or_make(sweep_files(folder_of(cli), sweep.settings().name).store, identity);
    std::vector<std::size_t> todo = missing_points(sweep, Shard{}, store);
    return {&start, std::move(sweep), std::move(store), std::move(todo)};
}

// Runs what is missing. The progress counts the runs of all searches.
void run_searches(std::vector<PreparedSearch>& searches, int threads) {
    std::size_t runs = 0;
    std::size_t missing = 0;
    for (const PreparedSearch& one : searches) {
        runs += one.sweep.points();
        missing += one.todo.size();
    }
    ProgressBar bar(missing == runs ? fmt::format("{} runs", runs)
                                    : fmt::format("{} runs, {} already stored", runs, runs - missing));
    std::size_t done = 0;
    for (PreparedSearch& one : searches) {
        SweepRunOptions options;
        options.threads = threads;
        options.run = timing_metrics;
        options.on_progress = [&](double share) {
            const double now = static_cast<double>(done) + share * static_cast<double>(one.todo.size());
            return bar.update(now / static_cast<double>(missing));
        };
        if (one.todo.empty()) continue;
        const SweepSession session = run_points(one.sweep, one.todo, one.store, options);
        if (!session.failures.empty()) {
            const SweepFailure& first = session.failures.front();
            throw InputError(fmt::format("{} runs of the search failed; the first one ({}): {}",
                                         session.failures.size(), one.sweep.describe(first.point), first.message));
        }
        done += one.todo.size();
    }
    if (missing == 0) return fmt::print("\nAll {} runs were done before.\n", runs);
    fmt::print("\n{} runs, {} of them now\n", runs, missing);
}

using NamedText = std::pair<std::string, std::string>;

struct SearchOutcome {
    std::vector<TimingSearch> searches;
    bool has_violations = false;
};

SearchOutcome search_times(const Scenario& scenario, const std::vector<PopulationTiming>& timings,
                           const SearchOptions& options, const TimingOptions& timing, const SignalsCliOptions& cli,
                           std::vector<NamedText>& tables) {
    std::vector<PreparedSearch> prepared;
    for (const PopulationTiming& one : timings) {
        if (!one.is_oversaturated()) prepared.push_back(prepare_search(scenario, one, options, timing, cli));
    }
    SearchOutcome outcome;
    if (prepared.empty()) return outcome;
    try {
        run_searches(prepared, timing.threads);
    } catch (const Interrupted&) {
        print_message("stopline-signals: finished runs are stored; the same command continues with the others\n");
        throw;
    }
    for (const PreparedSearch& one : prepared) {
        const SweepTable table = sweep_results(one.store);
        outcome.has_violations = outcome.has_violations || table.totals.runs_with_violations > 0;
        tables.emplace_back(one.sweep.settings().name + ".csv", table.csv);
        outcome.searches.push_back(search_results(scenario, table.csv, *one.start, options.objective));
        fmt::print("\n{}", search_text(scenario, outcome.searches.back(), shortest_greens_s(scenario, timing)));
    }
    tables.emplace_back("search.csv", search_csv(outcome.searches));
    return outcome;
}

void write_results(const SignalsCliOptions& options, const Scenario& scenario, const std::vector<NamedText>& tables,
                   const std::vector<TimingSearch>& searches) {
    const std::filesystem::path folder = folder_of(options);
    Provenance provenance;
    provenance.command = command_of(options);
    fmt::print("\nWritten to {}\n", folder.string());
    for (const auto& [name, text] : tables) {
        write_file(folder / name, text);
        provenance.files.push_back(name);
        fmt::print("  {}\n", name);
    }
    write_file(folder / "signals.provenance.json", provenance_json(scenario, provenance));
    fmt::print("  signals.provenance.json\n");
    for (const TimingSearch& search : searches) fmt::print("  search_{}.sqlite\n", search.population);
    if (options.no_figures || searches.empty()) return;
    std::vector<Figure> figures;
    for (const TimingSearch& search : searches) figures.push_back(timing_figure(search));
    draw_figures(figures, folder);
}

// Returns the best known times of a population: those of the search if there is one, else the start values.
SignalTimes best_times(const PopulationTiming& timing, const std::vector<TimingSearch>& searches) {
    for (const TimingSearch& search : searches) {
        if (search.population == timing.saturation.population) return search.all[search.best.front()].times;
    }
    return timing.times;
}

// Prints the options and the YAML that apply the times of each population, and commands to go on with.
void print_times(const SignalsCliOptions& options, const Scenario& scenario,
                 const std::vector<PopulationTiming>& timings, const SearchOptions& search,
                 const std::vector<TimingSearch>& searches) {
    const PopulationTiming* first = nullptr;
    for (const PopulationTiming& one : timings) {
        if (one.is_oversaturated()) continue;
        if (first == nullptr) {
            fmt::print("\nApply the times{}:\n", searches.empty() ? "" : " of the best setting");
            first = &one;
        }
        fmt::print("\n{}", apply_text(scenario, one.saturation.population, best_times(one, searches)));
    }
    if (first == nullptr) {
        return fmt::print("\nNext: lower the demand, e.g. add --set 'demand.inflow=400 veh/h'\n");
    }
    CommonOptions next = options.common;
    next.settings = search_overrides(scenario, first->saturation.population, search);
    for (std::string& text : timing_overrides(scenario, best_times(*first, searches))) {
        next.settings.push_back(std::move(text));
    }
    if (!searches.empty()) next.seed = 1 + scenario.seed + static_cast<std::uint64_t>(options.seeds);
    fmt::print("\nNext: run the scenario with the times of {}{}\n  {}\n", first->saturation.population,
               searches.empty() ? "" : " and another seed", runnable(command_text("stopline-run", options.file, next)));
    if (!options.search) fmt::print("or improve the times by simulation: add --search to this command\n");
}

ExitCode run(const SignalsCliOptions& options) {
    check_options(options);
    Scenario scenario = load_with_options(options.file, options.common);
    check_timing_scenario(scenario, options.file, options.common.settings);
    SearchOptions search;
    for (const PopulationSettings& one : scenario.populations) search.populations_in_file.push_back(one.name);
    choose_populations(options.populations, scenario);
    TimingOptions timing;
    timing.threads = thread_count(options.common.threads);
    timing.min_green_s = option_quantity("--min-green", options.min_green, "s", 1.0, 300.0);
    timing.pedestrians = options.pedestrians;
    check_files(options, scenario);
    search.overrides = options.common.settings;
    search.file = options.file;
    search.seeds = options.seeds;
    search.greens = options.greens;
    search.offsets = options.offsets;
    search.range = option_quantity("--range", options.range, "", 1.05, 10.0);
    search.objective = options.objective == "throughput" ? Objective::throughput : Objective::delay;
    prepare_folder(folder_of(options));
    const std::vector<PopulationTiming> timings = [&] {
        ProgressBar bar("measuring saturation flows");
        timing.on_progress = [&bar](double share) { return bar.update(share); };
        return time_signals(scenario, timing);
    }();
    fmt::print("{}\n\n{}", scenario.title.empty() ? scenario.name : scenario.title, timing_text(scenario, timings));
    std::vector<NamedText> tables{{"timing.csv", timing_csv(scenario, timings)},
                                  {"lanes.csv", timing_lanes_csv(timings)}};
    SearchOutcome outcome;
    if (options.search) outcome = search_times(scenario, timings, search, timing, options, tables);
    write_results(options, scenario, tables, outcome.searches);
    const auto is_oversaturated = [](const PopulationTiming& one) { return one.is_oversaturated(); };
    print_times(options, scenario, timings, search, outcome.searches);
    const bool violated = std::any_of(timings.begin(), timings.end(),
                                      [](const PopulationTiming& one) { return one.saturation.has_violations; });
    if (violated || outcome.has_violations) print_message("stopline-signals: a run has violations\n");
    const bool any = std::any_of(timings.begin(), timings.end(), is_oversaturated);
    return any || violated || outcome.has_violations ? ExitCode::check_failed : ExitCode::done;
}

}  // namespace

int signals_main(int argc, const char* const* argv) {
    return run_program("stopline-signals", [&] {
        Options app(
            "Times the signals of an intersection or a grid for its demand, by Webster and the HCM, or by a search.",
            "stopline-signals");
        SignalsCliOptions options;
        declare(app, options);
        const std::optional<ExitCode> end = app.parse(argc, argv);
        return end ? *end : run(options);
    });
}

}  // namespace stopline

int main(int argc, char** argv) { return stopline::signals_main(argc, argv); }
