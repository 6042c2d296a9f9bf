// stopline-run: runs one scenario, once for each population, and writes tables, CSV files and figures.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "base/io/command_files.h"
#include "base/io/console.h"
#include "base/io/output.h"
#include "common/command_line.h"
#include "common/examples.h"
#include "common/intersection_text.h"
#include "common/network_text.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/results.h"
#include "common/single_light_text.h"
#include "figures/driving_figures.h"
#include "figures/hcm_figure.h"
#include "figures/intersection_figures.h"
#include "figures/network_figures.h"
#include "figures/single_light_figures.h"
#include "figures/street_figures.h"
#include "figures/street_map.h"
#include "figures/time_space_figure.h"
#include "record/streamed_file.h"
#include "run/hcm_text.h"
#include "run/run_files.h"
#include "runs/driving/driving_csv.h"
#include "runs/hcm/hcm_sampler.h"
#include "runs/network/street_results.h"
#include "runs/provenance.h"
#include "runs/run_kind.h"
#include "runs/run_report.h"
#include "runs/single_light/single_light.h"
#include "runs/single_light/single_light_csv.h"
#include "runs/tables/column_aliases.h"
#include "runs/tables/column_docs.h"
#include "scenario/import_sumo.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/load_scenario.h"
#include "scenario/schema/quantity.h"

namespace {

using namespace stopline;

constexpr const char* kTrajectoriesName = "trajectories.csv";

struct RunCliOptions {
    CommonOptions common;
    RunFilesOptions files;
    std::string file;
    std::string interval = "0.1 s";  // time between the samples of --trajectories
    bool trajectories = false;
    std::string trajectories_file = kTrajectoriesName;  // relative to the results folder
    bool no_figures = false;
    std::optional<std::string> describe;  // lists the fields whose path contains this text; empty: all fields
    bool describe_markdown = false;
    bool describe_columns = false;
    bool schema = false;
    bool list = false;
};

void declare(Options& app, RunCliOptions& options) {
    app.add("FILE", options.file, runnable("Scenario file (YAML), such as scenarios/single_light.yaml"));
    add_common_options(app, options.common, "Folder for the results (default: out/ and the name of the scenario)");
    add_set_option(app, options.common);
    app.add_flag(
        "--trajectories", options.trajectories,
        "Also write trajectories.csv. Single light: from 5 s before the green to 25 s after it. Single intersection: "
        "the first measured cycle. Networks: the whole run, or --record-from to --record-until");
    app.add(
           "--trajectories-file", options.trajectories_file,
           "With --trajectories: file in the results folder. It ends with .csv or, compressed, with .csv.gz or .csv.zst")
        .type_name("FILE")
        .only_with({"--trajectories"})
        .show_default();
    app.add("--interval", options.interval, "With --trajectories: time between samples (default: 0.1 s)")
        .only_with({"--trajectories"})
        .type_name("TIME");
    add_run_files_options(app, options.files);
    add_old_column_names_option(app, options.common);
    app.add_flag("--no-figures", options.no_figures, "Do not draw figures");
    app.add_optional("--describe", options.describe,
                     "List the fields of scenario files and exit: all of them, or those with FIELD in their path")
        .type_name("[FIELD]");
    app.add_flag("--describe-markdown", options.describe_markdown,
                 "Print all fields of scenario and sweep files as Markdown (scenarios/FIELDS.md) and exit");
    app.add_flag("--describe-columns", options.describe_columns,
                 "Print all columns of result tables as Markdown (scenarios/COLUMNS.md) and exit");
    app.add_flag("--schema", options.schema, "Print the JSON schema of scenario files, for editors, and exit");
    app.add_flag("--list", options.list,
                 "List spacing policies and laws, populations, vehicles, drivers, streets and metrics, and exit");
    app.footer(
        runnable(
            "\nExamples:\n"
            "  stopline-run scenarios/single_light.yaml\n"
            "  stopline-run scenarios/intersection.yaml --set 'demand.left=15 %'\n"
            "  stopline-run scenarios/grid.yaml --set 'duration=2000 s'\n"
            "  stopline-run scenarios/single_light.yaml --set 'populations=[CDG, CTG-Ref]' --trajectories\n"
            "  stopline-run scenarios/grid.yaml --set 'duration=600 s' --record out/grid.rec\n"
            "  stopline-run scenarios/intersection.yaml --fcd out/fcd.xml --tripinfo out/trips.xml --e1 out/loops.xml\n"
            "  stopline-run scenarios/first_steps.yaml --set vehicle=electric_100kw --output out/electric\n"
            "  stopline-run --list scenarios/single_light.yaml\n"
            "  stopline-run --describe signal.green\n\n"
            "Next: open the figures in the output folder. To watch a recorded run in a browser:\n"
            "  stopline-replay out/grid.CDG.rec\n\n") +
        kExitCodesText);
}

double trajectory_interval_s(const RunCliOptions& options, const Scenario& scenario) {
    if (!options.trajectories) return 0.0;
    const ParsedQuantity interval = parse_quantity(options.interval, unit("s"));
    if (!interval.problem.empty()) {
        throw InputError(fmt::format("--interval: value '{}' {}", options.interval, interval.problem));
    }
    const double steps = interval.si / scenario.tick_s();
    if (steps < 0.5 || std::abs(steps - std::round(steps)) > 1e-6) {
        throw InputError(fmt::format("--interval: '{}' is not a whole number of steps of {}; give a multiple of it",
                                     options.interval, short_text(scenario.tick_s(), unit("ms"))));
    }
    return interval.si;
}

// Writes the tables and the provenance file, and prints their names.
void write_tables(const RunCliOptions& options, const Scenario& scenario, std::vector<NamedText> files,
                  StateHashes hashes, const std::filesystem::path& folder) {
    Provenance provenance;
    provenance.command = command_text("stopline-run", options.file, options.common);
    if (options.trajectories) provenance.command += " --trajectories --interval " + shell_word(options.interval);
    if (options.common.old_column_names) provenance.command += " --old-column-names";
    if (options.trajectories_file != kTrajectoriesName)
        provenance.command += " --trajectories-file " + shell_word(options.trajectories_file);
    const ColumnNames names = column_names(options.common);
    for (auto& [name, text] : files) {
        const std::string name_in_results = name;
        const std::string table = table_group(scenario.network) + "/" + name;
        ResultFile file = result_file(table, std::move(name), std::move(text), names);
        name = name_in_results == kTrajectoriesName ? options.trajectories_file : std::move(file.name);
        text = std::move(file.text);
        provenance.files.push_back(name);
    }
    provenance.state_hashes = std::move(hashes);
    files.emplace_back(scenario.name + ".provenance.json", provenance_json(scenario, provenance));
    fmt::print("\nWritten to {}\n", folder.string());
    for (const auto& [name, text] : files) {
        write_streamed_file(folder / name, text);
        fmt::print("  {}\n", name);
    }
}

// Returns the figures, with those of further measures that the scenario asks for.
template <class Result>
std::vector<Figure> with_measures(std::vector<Figure> figures, const Scenario& scenario,
                                  const std::vector<Result>& results) {
    for (Figure& figure : driving_figures(scenario, driving_of(results))) figures.push_back(std::move(figure));
    if (std::optional<Figure> figure = hcm_figure(hcm_of(results))) figures.push_back(*std::move(figure));
    return figures;
}

// Prints the report by the Highway Capacity Manual if the scenario asks for it.
template <class Result>
void print_hcm(const Scenario& scenario, const std::vector<Result>& results) {
    if (asks_for_hcm(scenario)) fmt::print("\n{}", hcm_text(hcm_of(results)));
}

void write_results(const RunCliOptions& options, const SingleLightReport& result, double interval_s,
                   const std::filesystem::path& folder) {
    std::vector<NamedText> files = result_tables(result);
    if (options.trajectories) files.emplace_back("trajectories.csv", trajectories_csv(result, interval_s));
    write_tables(options, result.scenario, std::move(files), state_hashes(result.runs), folder);
}

void write_results(const RunCliOptions& options, const IntersectionReport& report,
                   const std::filesystem::path& folder) {
    std::vector<NamedText> files = result_tables(report);
    if (options.trajectories) files.emplace_back("trajectories.csv", intersection_trajectories_csv(report));
    write_tables(options, report.scenario, std::move(files), state_hashes(report.populations), folder);
}

// Returns the title and the values of --set, such as "Grid of 25 intersections, with network.grid.columns=3".
std::string heading(const Scenario& scenario, const CommonOptions& options) {
    const std::string& title = scenario.title.empty() ? scenario.name : scenario.title;
    return options.settings.empty() ? title : fmt::format("{}, with {}", title, fmt::join(options.settings, ", "));
}

void print_report(const SingleLightReport& result, const CommonOptions& options) {
    const Scenario& scenario = result.scenario;
    fmt::print("{}\n", heading(scenario, options));
    fmt::print("scenario {} ({:016x}), seed {}, vehicle {}, driver {}\n\n", scenario.name, scenario.hash, scenario.seed,
               scenario.vehicle_name, scenario.driver_name);
    fmt::print("{}{}{}\n{}{}", counts_text(result), ideal_text(result), headways_text(result), queue_text(result),
               violations_text(result));
}

// Runs a single intersection and writes its results.
ExitCode run_as_intersection(const RunCliOptions& options, const Scenario& scenario, double interval_s,
                             const std::filesystem::path& folder, RunFiles& run_files) {
    const IntersectionReport report = [&] {
        ProgressBar bar(fmt::format("{} runs", scenario.populations.size()));
        return run_intersections(scenario,
                                 {thread_count(options.common.threads), interval_s,
                                  [&bar](double share) { return bar.update(share); }, run_files.observation()});
    }();
    fmt::print("{}\nscenario {} ({:016x}), seed {}\n\n{}", heading(scenario, options.common), scenario.name,
               scenario.hash, scenario.seed, intersection_text(report));
    print_hcm(scenario, report.populations);
    write_results(options, report, folder);
    fmt::print("{}", run_files.finish());
    if (!options.no_figures)
        draw_figures(with_measures(intersection_figures(report), scenario, report.populations), folder);
    fmt::print("\nNext:\n{}", settings_hint(options.file, options.common, "other greens and turns",
                                            {"signal.green=10 s", "demand.left=30 %"}));
    fmt::print("{}", runnable("  all combinations: stopline-sweep scenarios/sweeps/intersection.yaml\n"
                              "  comparison with the paper: stopline-scorecard\n"));
    return report.no_violations() && report.no_starvation() ? ExitCode::done : ExitCode::check_failed;
}

// Returns a line on where to find the teleported vehicles; empty if there are none.
std::string teleports_hint(const NetworkReport& report) {
    const auto teleports = [](const NetworkResult& result) { return result.delays.teleported > 0; };
    const bool any = std::any_of(report.populations.begin(), report.populations.end(), teleports);
    return any ? "  rules.csv lists each teleported vehicle with its lane and time\n" : "";
}

// Returns the settings for the other fidelity. The default parameters of the mesoscale mode are replaced by those that
// were fitted to full dynamics.
std::vector<std::string> other_fidelity(const Scenario& scenario) {
    if (scenario.is_meso()) return {"fidelity=full"};
    if (scenario.meso.name != "table2") return {"fidelity=meso"};
    return {"fidelity=meso", std::string("meso=") + kCalibratedMeso};
}

// Runs a network and writes its results. Trajectories are written during the run.
ExitCode run_as_network(const RunCliOptions& options, const Scenario& scenario, double /*interval_s*/,
                        const std::filesystem::path& folder, RunFiles& run_files) {
    const NetworkReport report = [&] {
        ProgressBar bar(fmt::format("{} runs", scenario.populations.size()));
        return run_networks(scenario, {thread_count(options.common.threads),
                                       [&bar](double share) { return bar.update(share); }, run_files.observation()});
    }();
    fmt::print("{}\nscenario {} ({:016x}), seed {}\n\n{}", heading(scenario, options.common), scenario.name,
               scenario.hash, scenario.seed, network_text(report));
    print_hcm(scenario, report.populations);
    std::vector<Figure> figures{network_series_figure(report), delay_causes_figure(report)};
    if (network_kind(scenario.network).reports_approaches) {
        if (!scenario.network.streets.intersections.empty()) figures.push_back(street_map(scenario));
        figures.push_back(inflow_figure(report));
        figures.push_back(backlog_figure(report));
    }
    if (scenario.measure.time_space_s > 0.0) figures.push_back(time_space_figure(report));
    write_tables(options, scenario, result_tables(report), state_hashes(report.populations), folder);
    fmt::print("{}", run_files.finish());
    figures = with_measures(std::move(figures), scenario, report.populations);
    if (!options.no_figures) draw_figures(figures, folder);
    const auto hint = [&](const std::string& purpose, const std::vector<std::string>& settings) {
        return settings_hint(options.file, options.common, purpose, settings);
    };
    std::string variation = hint("another fidelity", other_fidelity(scenario));
    if (network_kind(scenario.network).signal_groups > 0) {
        variation =
            hint("other greens, offsets and turns", {"signal.green=10 s", "signal.offset=15 s", "demand.left=5 %"});
    }
    fmt::print(
        "\nNext:\n"
        "  lane_delays.csv: delay of the queues that begin on each lane, by cause; delays.csv: each delay\n"
        "{}"
        "{}"
        "  many variations at once: {} --help\n",
        teleports_hint(report), variation, program_command("stopline-sweep"));
    return report.no_violations() && report.no_starvation() ? ExitCode::done : ExitCode::check_failed;
}

// Runs a single light and writes its results.
ExitCode run_as_single_light(const RunCliOptions& options, const Scenario& scenario, double interval_s,
                             const std::filesystem::path& folder, RunFiles& run_files) {
    SingleLightOptions run_options;
    run_options.threads = thread_count(options.common.threads);
    run_options.trajectory_interval_s = interval_s;
    run_options.observation = run_files.observation();
    const SingleLightReport result = [&] {
        ProgressBar bar(fmt::format("{} runs", scenario.populations.size()));
        run_options.on_progress = [&bar](double share) { return bar.update(share); };
        return run_single_light(scenario, run_options);
    }();
    print_report(result, options.common);
    print_hcm(scenario, result.runs);
    write_results(options, result, interval_s, folder);
    fmt::print("{}", run_files.finish());
    if (!options.no_figures) {
        draw_figures(with_measures(single_light_figures(result, load_targets()), scenario, result.runs), folder);
    }
    const bool is_meso = result.scenario.is_meso();
    const char* const trajectories =
        options.trajectories ? "" : "  positions of all vehicles over time: add --trajectories\n";
    fmt::print("\nNext:\n{}",
               settings_hint(options.file, options.common, is_meso ? "another fidelity" : "another vehicle",
                             {is_meso ? "fidelity=full" : "vehicle=electric_100kw"}));
    fmt::print("{}", runnable(fmt::format("  names of vehicles and policies: stopline-run --list\n"
                                          "{}"
                                          "  comparison with the paper: stopline-scorecard\n",
                                          trajectories)));
    return result.no_violations() ? ExitCode::done : ExitCode::check_failed;
}

// A way of running, printing and storing the results of a scenario.
struct Reporter {
    std::string_view name;  // name of a RunKind (runs/run_kind.h)
    ExitCode (*run)(const RunCliOptions& options, const Scenario& scenario, double interval_s,
                    const std::filesystem::path& folder, RunFiles& run_files);
    bool streams_trajectories;  // trajectories are written during the run
};

const Reporter& reporter_of(const Scenario& scenario) {
    static constexpr std::array kReporters{Reporter{kRunAsSingleLight, run_as_single_light, false},
                                           Reporter{kRunAsIntersection, run_as_intersection, false},
                                           Reporter{kRunAsNetwork, run_as_network, true}};
    const std::string_view name = run_kind(scenario).name;
    return *std::find_if(kReporters.begin(), kReporters.end(), [&](const Reporter& one) { return one.name == name; });
}

// Returns the names of all tables that a run of this kind can write into its folder, except the trajectories.
std::vector<std::string> table_names(const Scenario& scenario, ColumnNames names) {
    const std::string group = table_group(scenario.network) + "/";
    std::vector<std::string> files{scenario.name + ".provenance.json"};
    for (const TableDoc& table : table_docs()) {
        if (!table.name.starts_with(group)) continue;
        std::string file(table.name.substr(group.size()));
        if (file != kTrajectoriesName) files.push_back(result_file_name(table.name, std::move(file), names));
    }
    return files;
}

// Throws InputError if an output of the run would overwrite an input, another output, or a figure.
void check_files(const RunCliOptions& options, const Scenario& scenario, const std::filesystem::path& folder,
                 const RunFiles& run_files, bool streams_trajectories) {
    CommandFiles files;
    add_scenario_inputs(files, options.file, options.common);
    const ColumnNames names = options.common.old_column_names ? ColumnNames::old : ColumnNames::current;
    files.add_outputs(folder, table_names(scenario, names), "a table in the folder of --output");
    if (options.trajectories && !streams_trajectories) {
        files.add_output(folder / options.trajectories_file, "--trajectories-file");
    }
    run_files.add_outputs(files);
    if (options.no_figures) return;
    run_files.refuse_names_of_figures(folder);
}

// Throws InputError if --trajectories-file names no CSV file or a file outside of the results folder.
void check_trajectories_file(const std::string& file) {
    constexpr std::array kEndings{".csv", ".csv.gz", ".csv.zst"};
    const auto is_ending = [&](const char* ending) { return file.ends_with(ending); };
    if (std::none_of(kEndings.begin(), kEndings.end(), is_ending)) {
        throw InputError(fmt::format("--trajectories-file: the table is a CSV file, so the name '{}' must end with {}",
                                     file, fmt::join(kEndings, " or ")));
    }
    const std::filesystem::path path = std::filesystem::path(file).lexically_normal();
    if (!path.is_absolute() && *path.begin() != "..") return;
    throw InputError(fmt::format(
        "--trajectories-file: '{}' is outside of the results folder; give a name, and choose the folder with --output",
        file));
}

// Throws InputError if no output of the run uses the options --record-from and --record-until.
void refuse_unused_window(const RunCliOptions& options, bool streams_trajectories) {
    const RunFilesOptions defaults;
    const bool has_window = options.files.from != defaults.from || options.files.until != defaults.until;
    if (!has_window || streams_trajectories || !options.files.record.empty() || !options.files.fcd.empty()) return;
    throw InputError(
        "--record-from and --record-until have no effect on --trajectories here; only the trajectories of a network "
        "have a window");
}

ExitCode run(const RunCliOptions& options) {
    if (options.describe) return fmt::print("{}", describe_fields(*options.describe)), ExitCode::done;
    if (options.describe_markdown) return fmt::print("{}", fields_markdown()), ExitCode::done;
    if (options.describe_columns) return fmt::print("{}", columns_markdown()), ExitCode::done;
    if (options.schema) return fmt::print("{}", json_schema()), ExitCode::done;
    if (options.list) return fmt::print("{}", list_text(options.file, options.common)), ExitCode::done;
    if (options.file.empty()) {
        throw InputError(runnable("no scenario file given; try: stopline-run scenarios/single_light.yaml (or --help)"));
    }
    const Scenario scenario = load_with_options(options.file, options.common);
    for (const std::string& line : sumo_warnings(scenario)) print_message("SUMO import: {}\n", line);
    for (const std::string& line : sumo_notes(scenario)) print_message("note: {}\n", line);
    if (const std::string warning = sumo_demand_warning(scenario); !warning.empty()) {
        print_message("warning: {}\n", warning);
    }
    const double interval_s = trajectory_interval_s(options, scenario);
    check_trajectories_file(options.trajectories_file);
    const std::filesystem::path folder = options.common.output.empty() ? "out/" + scenario.name : options.common.output;
    refuse_unused_window(options, reporter_of(scenario).streams_trajectories);
    RunFilesOptions files = options.files;
    files.column_names = column_names(options.common);
    const Reporter& reporter = reporter_of(scenario);
    if (options.trajectories && reporter.streams_trajectories) {
        files.trajectories = (folder / options.trajectories_file).string();
        files.trajectory_interval_s = interval_s;
    }
    RunFiles run_files(files, scenario, command_text("stopline-run", options.file, options.common));
    check_files(options, scenario, folder, run_files, reporter.streams_trajectories);
    run_files.prepare();
    prepare_folder(folder);
    if (options.trajectories && !reporter.streams_trajectories) prepare_output_file(folder / options.trajectories_file);
    const ResultFiles before = result_files(folder);
    const ExitCode code = reporter.run(options, scenario, interval_s, folder, run_files);
    print_unchanged_files(folder, before);
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("stopline-run", [&] {
        Options app("Runs a scenario, once for each of its populations, and writes tables, CSV files and figures.",
                    "stopline-run");
        RunCliOptions options;
        declare(app, options);
        const std::optional<ExitCode> end = app.parse(argc, argv);
        return end ? *end : run(options);
    });
}
