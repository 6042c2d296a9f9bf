// stopline-export: a scenario as input of SUMO.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "base/input_error.h"
#include "common/command_line.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "sumo/export.h"

namespace {

using namespace stopline;

struct ExportOptionsOfUser {
    CommonOptions common;
    std::string file;
    std::string folder;
    std::string population;
};

void declare(CLI::App& app, ExportOptionsOfUser& options) {
    add_version_option(app);
    app.add_option("SCENARIO", options.file, "Scenario file")->required();
    app.add_option("--sumo", options.folder, "Folder for SUMO's files; made if need be")->required()->type_name("DIR");
    app.add_option("--population", options.population, "Whose vehicles (default: the first of the scenario)")
        ->type_name("NAME");
    app.add_option("--seed", options.common.seed, "Seed instead of the scenario's");
    add_set_option(app, options.common);
    app.footer(
        std::string("\nThe scenario is run in the mesoscale mode: its vehicles, as they entered, are those of the "
                    "export.\n\nExamples:\n"
                    "  stopline-export --sumo out/sumo scenarios/grid.yaml --population CTG-Ref --set "
                    "'duration=600 s'\n"
                    "  sumo -c out/sumo/run.sumocfg --tripinfo-output trips.xml\n\n") +
        kExitCodesText);
}

ExitCode run(const ExportOptionsOfUser& options) {
    CommonOptions common = options.common;
    set_mesoscale("stopline-export", common);
    const Scenario scenario = load_with_options(options.file, common);
    const std::size_t population = options.population.empty() ? 0 : population_index(scenario, options.population);
    const std::string vehicles = [&] {
        ProgressBar bar("1 run");
        return export_to_sumo(scenario, population, options.folder, [&bar](double share) { return bar.update(share); });
    }();
    fmt::print("Written to {}: {}, {}\n", options.folder, scenario.populations[population].name, vehicles);
    const std::string command = netconvert_command(options.folder);
    if (!has_sumo()) {
        fmt::print("\nNext: install SUMO (pip install eclipse-sumo), then\n  {}\n  sumo -c {}\n", command,
                   shell_word((std::filesystem::path(options.folder) / "run.sumocfg").string()));
        return ExitCode::done;
    }
    fmt::print("\nNext: sumo -c {}\n", shell_word((std::filesystem::path(options.folder) / "run.sumocfg").string()));
    return ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("stopline-export", [&] {
        CLI::App app("Writes a scenario as input of SUMO: network, lights, detectors, vehicles, configuration.",
                     "stopline-export");
        ExportOptionsOfUser options;
        declare(app, options);
        const std::optional<ExitCode> end = parse_command_line(app, argc, argv);
        return end ? *end : run(options);
    });
}
