// stopline-compare: the mesoscale mode beside SUMO, on the same inputs.
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/input_error.h"
#include "common/command_line.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/results.h"
#include "common/text_table.h"
#include "experiment/output.h"
#include "sumo/compare.h"
#include "sumo/export.h"

namespace {

using namespace stopline;

struct CompareOptionsOfUser {
    CommonOptions common;
    std::string file;
    std::string population;
    int repetitions = 3;
    bool no_figures = false;
};

void declare(CLI::App& app, CompareOptionsOfUser& options) {
    add_version_option(app);
    app.add_option("SCENARIO", options.file, "Scenario file")->required();
    app.add_option("--population", options.population, "Whose vehicles (default: CTG-Ref, or the first)")
        ->type_name("NAME");
    app.add_option("--repetitions", options.repetitions, "Runs of both, with as many seeds")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    app.add_flag("--no-figures", options.no_figures, "Draw no figures");
    app.add_option("--seed", options.common.seed, "First seed instead of the scenario's");
    app.add_option("--output", options.common.output, "Folder for results (default: out/NAME_sumo)")->type_name("DIR");
    add_set_option(app, options.common);
    app.footer(
        std::string(
            "\nBoth get the same network, lights and vehicles: those that entered in our run, when and where they did; "
            "on imported\nnetworks those of the route files, when they are planned to depart, and the ways that the "
            "import took for them.\n\nExamples:\n"
            "  stopline-compare scenarios/intersection.yaml\n"
            "  stopline-compare scenarios/grid.yaml --set 'duration=900 s' --set 'measure.steady=600 s'\n\n"
            "Like with like, without what is ours alone (the project's README says what and why):\n"
            "  stopline-compare scenarios/intersection.yaml --set meso=table2 --set 'driver.free_drive.hesitation=0 s' \\\n"
            "      --set 'driver.stop.deceleration=4.7 m/s2' --set 'driver.stop.decision_deceleration=5.3 m/s2'\n\n") +
        kExitCodesText);
}

std::size_t chosen(const CompareOptionsOfUser& options, const Scenario& scenario) {
    if (!options.population.empty()) return population_index(scenario, options.population);
    for (std::size_t k = 0; k < scenario.populations.size(); ++k) {
        if (scenario.populations[k].name == "CTG-Ref") return k;
    }
    return 0;
}

std::string number(double value) { return std::isnan(value) ? "-" : fmt::format("{:.2f}", value); }

std::string band_cells(const ComparedMetric& metric, Band band, std::string& inside) {
    const std::size_t needed = band == Band::paper ? 3 : 2;
    inside = "-";
    if (metric.of_sumo_alone || metric.sumo.size() < needed || std::isnan(mean_of(metric.sumo))) return "-";
    const Interval interval = metric.band(band);
    if (interval.high - interval.low < 1e-6 * std::fabs(interval.high)) return "no spread";
    inside = interval.contains(mean_of(metric.ours)) ? "yes" : "no";
    return fmt::format("{:.2f} .. {:.2f}", interval.low, interval.high);
}

void print(const Comparison& comparison) {
    const std::size_t seeds = comparison.runs.size();
    fmt::print("{}, {} seed{}, from {:g} to {:g} s\n\n", comparison.population, seeds, seeds == 1 ? "" : "s",
               comparison.from_s, comparison.to_s);
    TextTable table;
    table.row({"", "Stopline", "SUMO", "difference", "band student", "inside", "band paper", "inside"});
    for (const ComparedMetric& metric : comparison.metrics()) {
        std::string in_student;
        std::string in_paper;
        const std::string student = band_cells(metric, Band::student, in_student);
        const std::string paper = band_cells(metric, Band::paper, in_paper);
        const double percent = metric.difference_percent();
        table.row({metric.name, metric.of_sumo_alone ? "-" : number(mean_of(metric.ours)), number(mean_of(metric.sumo)),
                   std::isfinite(percent) ? fmt::format("{:+.1f} %", percent) : "-", student, in_student, paper,
                   in_paper});
    }
    fmt::print("{}", table.text());
    fmt::print("\n{}\n", comparison.imported
                             ? "wait_outside_s: from the planned departure to entering, of trips that ended. "
                               "waiting_at_end_veh: found no room to enter until\nthe end."
                             : "wait_outside_s: how much later than in our run the same vehicles find room to enter in "
                               "SUMO; no check.");
    fmt::print(
        "moved_on_veh, of the whole run: SUMO's teleports; ours by a rule, or from a lane that does not serve their "
        "way.\n");
    if (!comparison.imported) {
        fmt::print(
            "SUMO gets the vehicles that entered our run, no more: in the long run it cannot pass more than ours does, however "
            "much more\nit could. Then its travel times are shorter.\n");
    }
    double ours_s = 0.0;
    double sumo_s = 0.0;
    for (const ComparedRun& run : comparison.runs) {
        ours_s += run.ours_took_s;
        sumo_s += run.sumo_took_s;
    }
    fmt::print("By the clock: our runs {:.1f} s, SUMO's {:.1f} s (the whole program, with its files; one thread).\n",
               ours_s, sumo_s);
    if (!comparison.note.empty()) fmt::print("\n{}\n", comparison.note);
}

// Without these settings drivers differ from SUMO's by design, and the table says no nearly everywhere.
void print_what_differs(const Scenario& scenario) {
    std::string settings;
    const auto unlike = [&](bool differs, const char* setting) {
        if (differs) settings += fmt::format(" --set '{}'", setting);
    };
    const auto apart = [](double value, double other) { return std::fabs(value - other) > 1e-9; };
    unlike(scenario.meso.name != "table2", "meso=table2");
    unlike(apart(scenario.driver.free_drive.hesitation_s, 0.0), "driver.free_drive.hesitation=0 s");
    unlike(apart(scenario.driver.stop.deceleration_mps2, 4.7), "driver.stop.deceleration=4.7 m/s2");
    unlike(apart(scenario.driver.stop.decision_deceleration_mps2, 5.3), "driver.stop.decision_deceleration=5.3 m/s2");
    if (settings.empty()) return;
    fmt::print("\nOur drivers differ from SUMO's by design. Like with like (the README says why):{}\n", settings);
}

ExitCode run(const CompareOptionsOfUser& options) {
    CommonOptions common = options.common;
    set_mesoscale("stopline-compare", common);
    const Scenario scenario = load_with_options(options.file, common);
    const std::string folder = common.output.empty() ? "out/" + scenario.name + "_sumo" : common.output;
    const Comparison comparison = [&] {
        ProgressBar bar(fmt::format("{} runs of both programs", options.repetitions));
        CompareOptions compare;
        compare.repetitions = options.repetitions;
        compare.on_progress = [&bar](double share) { return bar.update(share); };
        return compare_with_sumo(scenario, chosen(options, scenario), folder, compare);
    }();
    print(comparison);
    print_what_differs(scenario);
    std::int64_t violations = 0;
    for (const ComparedRun& one : comparison.runs) violations += one.overlaps;
    if (violations > 0) fmt::print("\nVIOLATIONS in our runs: {}\n", violations);
    fmt::print("\nWritten to {}\n", folder);
    for (const auto& [name, text] : {std::pair{"comparison.csv", comparison_csv(comparison)},
                                     std::pair{"stop_lines.csv", stop_lines_csv(comparison)}}) {
        write_file(std::filesystem::path(folder) / name, text);
        fmt::print("  {}\n", name);
    }
    if (!options.no_figures) {
        draw_all(comparison_figures(comparison, scenario.title.empty() ? scenario.name : scenario.title), folder);
    }
    fmt::print("\nNext: the inputs of both are in {}/seed_N; sumo-gui -c {}/seed_{}/run.sumocfg shows SUMO's run.\n",
               folder, folder, comparison.runs.front().seed);
    return violations > 0 ? ExitCode::check_failed : ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("stopline-compare", [&] {
        CLI::App app("Runs SUMO and the mesoscale mode on the same inputs and compares what comes out.",
                     "stopline-compare");
        CompareOptionsOfUser options;
        declare(app, options);
        const std::optional<ExitCode> end = parse_command_line(app, argc, argv);
        return end ? *end : run(options);
    });
}
