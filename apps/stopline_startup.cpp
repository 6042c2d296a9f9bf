// stopline-startup: compares the simulated start of a platoon leader with measured starts (Section III.B of the paper).
// It can fit the driver to the measured starts.
#include <filesystem>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/command_files.h"
#include "base/io/data_directory.h"
#include "base/io/output.h"
#include "base/nearest_name.h"
#include "base/units.h"
#include "calibration/startup.h"
#include "calibration/startup_report.h"
#include "common/command_line.h"
#include "common/examples.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "figures/studies/startup_figure.h"
#include "runs/provenance.h"
#include "runs/run_populations.h"
#include "runs/tables/column_aliases.h"
#include "scenario/load_scenario.h"

namespace stopline {

namespace {

constexpr const char* kMeasuredStarts = "startup/kit_curve_leader50.csv";

struct StartupCliOptions {
    CommonOptions common;
    std::string file;
    std::string measured;
    std::string write;
    bool fit = false;
    bool no_figures = false;
};

void declare(Options& app, StartupCliOptions& options) {
    app.add("FILE", options.file,
            runnable("Scenario that gives the vehicle and the driver (default: scenarios/single_light.yaml)"));
    app.add(
        "--measured", options.measured,
        fmt::format("Measured starts: CSV with columns t_s and mean_kmh, and optionally ci95_of_mean, p2.5, p97.5 and "
                    "n (default: {})",
                    (data_directory() / kMeasuredStarts).string()));
    app.add_flag(
        "--fit", options.fit,
        "Fit the acceleration profile, the speed gain and the acceleration of human drivers to the mean of the "
        "measured starts");
    app.add("--write", options.write, "With --fit: write the fitted driver to this file (YAML)")
        .only_with({"--fit"})
        .type_name("FILE");
    app.add_flag("--no-figures", options.no_figures, "Do not draw figures");
    add_common_options(app, options.common, "Folder for the results (default: out/startup)");
    add_set_option(app, options.common);
    add_old_column_names_option(app, options.common);
    app.footer(runnable("\nExamples:\n"
                        "  stopline-startup\n"
                        "  stopline-startup --set vehicle=electric_100kw --output out/startup_electric\n"
                        "  stopline-startup --fit --write out/driver.yaml\n\n"
                        "Next: use the fitted driver in a run\n"
                        "  stopline-run scenarios/single_light.yaml --set driver=\"$PWD/out/driver.yaml\"\n\n") +
               kExitCodesText);
}

std::filesystem::path measured_file(const StartupCliOptions& options) {
    return options.measured.empty() ? data_directory() / kMeasuredStarts : std::filesystem::path(options.measured);
}

std::filesystem::path output_folder(const StartupCliOptions& options) {
    return options.common.output.empty() ? "out/startup" : options.common.output;
}

void fit_driver(const StartupCliOptions& options, const StartupCurve& curve, Scenario& scenario) {
    StartupFit fit;
    {
        ProgressBar bar("fit");
        constexpr double kTypicalEvaluations = 2000.0;
        fit = fit_startup(scenario, curve, [&bar](int evaluations) {
            return bar.update(std::min(0.99, evaluations / kTypicalEvaluations));
        });
    }
    fmt::print(
        "Fit: {} evaluations; root mean square deviation from the mean curve {:.2f} km/h before, {:.2f} km/h after\n\n",
        fit.evaluations, fit.rms_before_mps * kKmhPerMps, fit.rms_after_mps * kKmhPerMps);
    scenario.driver = fit.driver;
    scenario.driver_name = "fitted";
    if (options.write.empty()) return;
    const std::string comment = fmt::format(
        "Parameters of the driver. `stopline-startup --fit` has fitted free driving (profile and speed_gain), so that\n"
        "the simulated start of {} follows the mean of {}. It has also fitted the acceleration of human drivers\n"
        "(human.idm.acceleration) to this mean. Nothing else is fitted.\n"
        "Sources: controller gains: Ploeg et al. 2011, reference [31] of the paper; radar delay: Section III.D of the\n"
        "paper; comfort limits: ISO 15622. The paper does not give the V2V delay; string stability depends on it.\n"
        "Our choices: jerk_up and jerk_down make the command continuous: it reaches a comfort limit in 0.42 s (up) and\n"
        "0.14 s (down, less than the lag of the brake). catch_up_factor: 2.5 km/h at 50 km/h close a gap and hardly\n"
        "exceed the limit. emergency_threshold: slightly below deceleration_comfort, so that emergency braking begins\n"
        "before comfortable braking is exhausted. emergency_gap: net gap that remains after emergency braking.",
        scenario.vehicle_name,
        options.measured.empty() ? kMeasuredStarts : shortened(measured_file(options).filename().string()));
    write_file(options.write, driver_yaml(scenario.driver, comment));
    fmt::print("Driver written to {}\n\n", options.write);
}

std::string command_of(const StartupCliOptions& options) {
    std::string command = command_text("stopline-startup", options.file, options.common);
    if (!options.measured.empty()) command += " --measured " + shell_word(options.measured);
    if (options.common.old_column_names) command += " --old-column-names";
    return command + (options.fit ? " --fit" : "");
}

void write_results(const StartupCliOptions& options, const Scenario& scenario, const StartupReport& report) {
    const std::filesystem::path folder = output_folder(options);
    Figure figure = startup_figure(report);
    for (auto& [name, text] : figure.data) {
        text = result_file("startup/" + name, name, std::move(text), column_names(options.common)).text;
    }
    Provenance provenance;
    provenance.command = command_of(options);
    fmt::print("\nWritten to {}\n", folder.string());
    for (const auto& [name, text] : figure.data) {
        write_file(folder / name, text);
        provenance.files.push_back(name);
        fmt::print("  {}\n", name);
    }
    write_file(folder / "startup.provenance.json", provenance_json(scenario, provenance));
    fmt::print("  startup.provenance.json\n");
    if (options.no_figures) return;
    if (!gnuplot_installed()) {
        fmt::print("  no figure: gnuplot is not installed (apt-get install gnuplot-nox)\n");
        return;
    }
    draw(figure, folder);
    fmt::print("  startup.svg, startup.png\n");
}

ExitCode run(const StartupCliOptions& options) {
    const std::string file =
        options.file.empty() ? (scenario_directory() / "single_light.yaml").string() : options.file;
    Scenario scenario = load_with_options(file, options.common);
    const StartupCurve curve = load_startup_curve(measured_file(options));
    CommandFiles files;
    add_scenario_inputs(files, file, options.common);
    files.add_input(measured_file(options), "--measured");
    files.add_outputs(
        output_folder(options),
        {"startup.csv", "startup_fine.csv", "startup.provenance.json", "startup.gp", "startup.svg", "startup.png"},
        "a result in the folder of --output");
    files.add_output(options.write, "--write");
    if (!options.write.empty()) prepare_output_file(options.write);
    prepare_folder(output_folder(options));
    if (options.fit) fit_driver(options, curve, scenario);
    const StartupReport report = report_startup(scenario, curve);
    fmt::print("Start of vehicle {} with driver {}, compared with {}\n\n{}", report.vehicle, report.driver,
               measured_file(options).filename().string(), startup_text(report));
    write_results(options, scenario, report);
    fmt::print(
        "{}", runnable("\nNext: see the effect of the start at a light\n  stopline-run scenarios/single_light.yaml\n"));
    return ExitCode::done;
}

}  // namespace

int startup_main(int argc, const char* const* argv) {
    return run_program("stopline-startup", [&] {
        Options app("Compares the simulated start of a platoon leader with measured starts at traffic lights.",
                    "stopline-startup");
        StartupCliOptions options;
        declare(app, options);
        const std::optional<ExitCode> end = app.parse(argc, argv);
        return end ? *end : run(options);
    });
}

}  // namespace stopline

int main(int argc, char** argv) { return stopline::startup_main(argc, argv); }
