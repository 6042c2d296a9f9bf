// stopline-export: writes a scenario as input files of SUMO.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "base/input_error.h"
#include "common/command_line.h"
#include "common/examples.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "sumo_export/export.h"

namespace {

using namespace stopline;

struct ExportCliOptions {
    CommonOptions common;
    std::string file;
    std::string folder;
    std::string population;
};

void declare(Options& app, ExportCliOptions& options) {
    app.add("SCENARIO", options.file, "Scenario file").required();
    app.add("--sumo", options.folder, "Folder for SUMO's files (created if missing)").required().type_name("DIR");
    app.add("--population", options.population, "Population to export (default: the first of the scenario)")
        .type_name("NAME");
    app.add("--seed", options.common.seed, "Seed of all random numbers (default: the scenario's)");
    add_set_option(app, options.common);
    app.footer(
        runnable("\nRuns the scenario in the mesoscale mode and exports the vehicles as they entered that run.\n\n"
                 "Examples:\n"
                 "  stopline-export --sumo out/sumo scenarios/grid.yaml --population CTG-Ref --set 'duration=600 s'\n\n"
                 "Next: run SUMO\n"
                 "  sumo -c out/sumo/run.sumocfg --tripinfo-output trips.xml\n\n") +
        kExitCodesText);
}

ExitCode run(const ExportCliOptions& options) {
    CommonOptions common = options.common;
    set_mesoscale("stopline-export", common);
    const Scenario scenario = load_with_options(options.file, common);
    const std::size_t population = options.population.empty() ? 0 : population_index(scenario, options.population);
    const std::string vehicles = [&] {
        ProgressBar bar("1 run");
        return export_to_sumo(scenario, population, options.folder, [&bar](double share) { return bar.update(share); });
    }();
    fmt::print("Written to {}: {}, {}\n", options.folder, scenario.populations[population].name, vehicles);
    const std::string sumo_command =
        "sumo -c " + shell_word((std::filesystem::path(options.folder) / "run.sumocfg").string());
    if (has_sumo()) {
        fmt::print("\nNext: run SUMO\n  {}\n", sumo_command);
    } else {
        fmt::print("\nNext: install SUMO and run it\n  pip install eclipse-sumo\n  {}\n  {}\n",
                   netconvert_command(options.folder), sumo_command);
    }
    return ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("stopline-export", [&] {
        Options app(
            "Writes a scenario as input files of SUMO: network, signals, detectors, vehicles and configuration.",
            "stopline-export");
        ExportCliOptions options;
        declare(app, options);
        const std::optional<ExitCode> end = app.parse(argc, argv);
        return end ? *end : run(options);
    });
}
