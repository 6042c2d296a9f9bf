// stopline-compare: runs SUMO and the mesoscale mode on the same inputs and compares the results.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/command_files.h"
#include "base/io/output.h"
#include "common/command_line.h"
#include "common/examples.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/results.h"
#include "common/text_table.h"
#include "runs/tables/column_aliases.h"
#include "scenario/schema/quantity.h"
#include "sumo_export/compare.h"
#include "sumo_export/export.h"

namespace {

using namespace stopline;

struct CompareCliOptions {
    CommonOptions common;
    std::string file;
    std::string population;
    int repetitions = 3;
    std::string sumo_limit = "30 min";
    bool no_figures = false;
};

void declare(Options& app, CompareCliOptions& options) {
    app.add("SCENARIO", options.file, "Scenario file").required();
    app.add("--population", options.population, "Population to compare (default: CTG-Ref, or the first one)")
        .type_name("NAME");
    app.add("--repetitions", options.repetitions, "Number of runs of each program, each with its own seed")
        .show_default()
        .range(1, 1000)
        .type_name("N");
    app.add("--sumo-limit", options.sumo_limit, "Longest time that one run of SUMO may take on this machine")
        .type_name("TIME")
        .show_default();
    app.add_flag("--no-figures", options.no_figures, "Do not draw figures");
    app.add("--seed", options.common.seed, "Seed of the first run (default: the scenario's)");
    app.add("--output", options.common.output, "Folder for the results (default: out/NAME_sumo)").type_name("DIR");
    add_set_option(app, options.common);
    add_old_column_names_option(app, options.common);
    app.footer(
        runnable("\nBoth programs get the same network, signals and vehicles: the vehicles that entered our run, at\n"
                 "the same times and places. On imported networks they get the vehicles of the route files, with\n"
                 "planned departures and routes.\n\n"
                 "Examples:\n"
                 "  stopline-compare scenarios/intersection.yaml\n"
                 "  stopline-compare scenarios/grid.yaml --set 'duration=900 s' --set 'measure.window=600 s'\n\n"
                 "With the same driver behaviour in both programs, as far as SUMO has it:\n"
                 "  stopline-compare scenarios/intersection.yaml --set meso=table2 \\\n"
                 "      --set 'driver.free_drive.hesitation=0 s' --set 'driver.stop.deceleration=4.7 m/s2' \\\n"
                 "      --set 'driver.stop.decision_deceleration=5.3 m/s2'\n\n"
                 "Next: watch SUMO's run\n"
                 "  sumo-gui -c out/intersection_sumo/seed_1/run.sumocfg\n\n") +
        kExitCodesText);
}

// Returns the index of the population to compare: the one that --population names, else CTG-Ref, else the first.
std::size_t chosen_population(const CompareCliOptions& options, const Scenario& scenario) {
    if (!options.population.empty()) return population_index(scenario, options.population);
    for (std::size_t k = 0; k < scenario.populations.size(); ++k) {
        if (scenario.populations[k].name == "CTG-Ref") return k;
    }
    return 0;
}

// Returns the confidence band of SUMO's mean as text. Sets `inside` to "yes" if our mean lies in the band or equals
// SUMO's mean, to "no" if it does not, and to "-" if there is no band.
std::string band_text(const ComparedMetric& metric, Band band, std::string& inside) {
    const std::size_t min_runs = band == Band::paper ? 3 : 2;
    inside = "-";
    if (metric.sumo_only || metric.sumo.size() < min_runs || std::isnan(mean_of(metric.sumo))) return "-";
    const Interval interval = metric.band(band);
    const double ours = mean_of(metric.ours);
    const double sumo = mean_of(metric.sumo);
    const bool is_equal = std::fabs(ours - sumo) <= 1e-9 * std::max(1.0, std::fabs(sumo));
    if (is_equal) inside = "yes";
    if (interval.high - interval.low < 1e-6 * std::fabs(interval.high)) return "no spread";
    inside = is_equal || interval.contains(ours) ? "yes" : "no";
    return fmt::format("{:.2f} .. {:.2f}", interval.low, interval.high);
}

void print(const Comparison& comparison) {
    const std::size_t seeds = comparison.runs.size();
    fmt::print("{}, {} seed{}, from {:g} to {:g} s\n\n", comparison.population, seeds, seeds == 1 ? "" : "s",
               comparison.from_s, comparison.to_s);
    TextTable table;
    table.add_row({"", "Stopline", "SUMO", "difference", "Student band", "inside", "paper band", "inside"});
    for (const ComparedMetric& metric : comparison.metrics()) {
        std::string in_student;
        std::string in_paper;
        const std::string student = band_text(metric, Band::student, in_student);
        const std::string paper = band_text(metric, Band::paper, in_paper);
        const double percent = metric.difference_percent();
        table.add_row({metric.name, metric.sumo_only ? "-" : number_cell(mean_of(metric.ours), 2),
                       number_cell(mean_of(metric.sumo), 2),
                       std::isfinite(percent) ? fmt::format("{:+.1f} %", percent) : "-", student, in_student, paper,
                       in_paper});
    }
    fmt::print("{}", table.text());
    fmt::print(
        "\ninside: our mean lies in the 95 % confidence band of SUMO's mean (Student's t, or the paper's formula).\n");
    if (comparison.imported) {
        fmt::print(
            "departure_delay_s: from the planned departure to the insertion, for trips that ended.\n"
            "backlog: vehicles that found no room to enter before the run ended.\n");
    } else {
        fmt::print("departure_delay_s: later insertion of the same vehicles in SUMO than in our run; not compared.\n");
    }
    fmt::print("teleported: vehicles of the whole run. In our runs they were blocked too long or missed their turn.\n");
    if (!comparison.imported) {
        fmt::print(
            "SUMO gets only the vehicles that entered our run, so its throughput cannot exceed ours in the long run.\n"
            "If SUMO could carry more traffic, it shows shorter travel times instead.\n");
    }
    double ours_s = 0.0;
    double sumo_s = 0.0;
    for (const ComparedRun& run : comparison.runs) {
        ours_s += run.ours_wall_s;
        sumo_s += run.sumo_wall_s;
    }
    fmt::print("Wall-clock time: our runs {:.1f} s, SUMO {:.1f} s (the whole program with its files; one thread).\n",
               ours_s, sumo_s);
    if (!comparison.note.empty()) fmt::print("\n{}\n", comparison.note);
}

// Prints the settings that make our drivers behave like SUMO's drivers. Settings that the scenario already has are left
// out. Without all these settings most metrics lie outside the bands, because the drivers differ.
void print_settings_like_sumo(const Scenario& scenario) {
    std::string settings;
    const auto add_if = [&](bool is_missing, const char* setting) {
        if (is_missing) settings += fmt::format(" \\\n      --set '{}'", setting);
    };
    const auto differ = [](double value, double other) { return std::fabs(value - other) > 1e-9; };
    add_if(scenario.meso.name != "table2", "meso=table2");
    add_if(differ(scenario.driver.free_drive.hesitation_s, 0.0), "driver.free_drive.hesitation=0 s");
    add_if(differ(scenario.driver.stop.deceleration_mps2, 4.7), "driver.stop.deceleration=4.7 m/s2");
    add_if(differ(scenario.driver.stop.decision_deceleration_mps2, 5.3), "driver.stop.decision_deceleration=5.3 m/s2");
    if (settings.empty()) return;
    fmt::print("\nOur drivers differ from SUMO's by design. Options for the same behaviour in both programs:{}\n",
               settings);
}

double parse_limit_s(const std::string& text) {
    const ParsedQuantity time = parse_quantity(text, unit("s"));
    if (!time.problem.empty()) throw InputError(fmt::format("--sumo-limit: value '{}' {}", text, time.problem));
    if (!(time.si > 0.0)) throw InputError(fmt::format("--sumo-limit: value '{}' must be more than 0 s", text));
    return time.si;
}

// Throws InputError if a file of the comparison would overwrite a file that the scenario names. Networks that SUMO runs
// can lie in the folder of an earlier comparison.
void check_files(const CompareCliOptions& options, const Scenario& scenario, const CommonOptions& common,
                 const std::filesystem::path& folder) {
    CommandFiles files;
    add_scenario_inputs(files, options.file, common);
    for (int k = 0; k < options.repetitions; ++k) {
        files.add_outputs(folder / fmt::format("seed_{}", scenario.seed + static_cast<std::uint64_t>(k)),
                          {"vehicles.rou.xml", "lights.add.xml", "detectors.add.xml", "run.sumocfg", "trips.out.xml",
                           "summary.out.xml", "detectors.out.xml", "loops.out.xml"},
                          "a file for SUMO in the folder of --output");
    }
    files.add_outputs(folder, {"comparison.csv", "stop_lines.csv"}, "a result in the folder of --output");
}

ExitCode run(const CompareCliOptions& options) {
    CommonOptions common = options.common;
    set_mesoscale("stopline-compare", common);
    const double sumo_limit_s = parse_limit_s(options.sumo_limit);
    const Scenario scenario = load_with_options(options.file, common);
    const std::string folder = common.output.empty() ? "out/" + scenario.name + "_sumo" : common.output;
    check_files(options, scenario, common, folder);
    const Comparison comparison = [&] {
        ProgressBar bar(fmt::format("{} runs of both programs", options.repetitions));
        CompareOptions compare;
        compare.repetitions = options.repetitions;
        compare.sumo_limit_s = sumo_limit_s;
        compare.on_progress = [&bar](double share) { return bar.update(share); };
        return compare_with_sumo(scenario, chosen_population(options, scenario), folder, compare);
    }();
    print(comparison);
    print_settings_like_sumo(scenario);
    std::int64_t violations = 0;
    for (const ComparedRun& run : comparison.runs) violations += run.violations;
    if (violations > 0)
        fmt::print("\nVIOLATIONS in our runs (overlaps, entries on red, lost vehicles): {}\n", violations);
    fmt::print("\nWritten to {}\n", folder);
    for (const auto& [name, text] : {std::pair{"comparison.csv", comparison_csv(comparison)},
                                     std::pair{"stop_lines.csv", stop_lines_csv(comparison)}}) {
        const ResultFile file = result_file(std::string("compare/") + name, name, text, column_names(options.common));
        write_file(std::filesystem::path(folder) / file.name, file.text);
        fmt::print("  {}\n", file.name);
    }
    if (!options.no_figures) {
        draw_figures(comparison_figures(comparison, scenario.title.empty() ? scenario.name : scenario.title), folder);
    }
    const std::filesystem::path first_run =
        std::filesystem::path(folder) / fmt::format("seed_{}", comparison.runs.front().seed);
    fmt::print("\nNext: watch SUMO's run (the inputs of each run are in {}/seed_N)\n  sumo-gui -c {}\n", folder,
               shell_word((first_run / "run.sumocfg").string()));
    return violations > 0 ? ExitCode::check_failed : ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("stopline-compare", [&] {
        Options app("Runs SUMO and the mesoscale mode on the same inputs and compares the results.",
                    "stopline-compare");
        CompareCliOptions options;
        declare(app, options);
        const std::optional<ExitCode> end = app.parse(argc, argv);
        return end ? *end : run(options);
    });
}
