// stopline-startup: the simulated start of a platoon leader beside measured starts, and the fit of its driver (Section III.B).
#include <filesystem>
#include <string>

#include <fmt/core.h>
#include <fmt/format.h>

#include "base/input_error.h"
#include "base/units.h"
#include "common/command_line.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "experiment/output.h"
#include "experiment/provenance.h"
#include "experiment/run_populations.h"
#include "experiment/startup.h"
#include "experiment/startup_report.h"
#include "scenario/load_scenario.h"
#include "scenario/nearest_name.h"

namespace stopline {

namespace {

constexpr const char* kMeasured = "startup/kit_curve_leader50.csv";

struct Options {
    CommonOptions common;
    std::string file;
    std::string measured;
    std::string write;
    bool fit = false;
    bool no_figures = false;
};

void declare(CLI::App& app, Options& options) {
    app.add_option("FILE", options.file,
                   "Scenario whose vehicle and driver start (default: scenarios/single_light.yaml)");
    app.add_option(
        "--measured", options.measured,
        std::string("Measured starts: CSV with columns t_s, mean_kmh and, if known, ci95_of_mean, p2.5, p97.5, n "
                    "(default: data/") +
            kMeasured + ")");
    app.add_flag("--fit", options.fit,
                 "Fit the driver's acceleration profile and gain to the mean of the measured starts");
    app.add_option("--write", options.write, "With --fit: write the driver to this file (data/drivers/NAME.yaml)");
    app.add_flag("--no-figures", options.no_figures, "Draw no figure");
    add_common_options(app, options.common, "Folder for the results (default: out/startup)");
    add_set_option(app, options.common);
    app.footer(std::string("\nExamples:\n"
                           "  stopline-startup\n"
                           "  stopline-startup --set vehicle=electric_100kw --output out/startup_electric\n"
                           "  stopline-startup --fit --write data/drivers/startup_kit.yaml\n\n") +
               kExitCodesText);
}

std::filesystem::path measured_file(const Options& options) {
    return options.measured.empty() ? data_directory() / kMeasured : std::filesystem::path(options.measured);
}

void fit_driver(const Options& options, const StartupCurve& curve, Scenario& scenario) {
    StartupFit fit;
    {
        ProgressBar bar("fit");
        constexpr double kUsual = 2000.0;  // evaluations that the fit takes as a rule
        fit = fit_startup(scenario, curve,
                          [&bar](int evaluations) { return bar.update(std::min(0.99, evaluations / kUsual)); });
    }
    fmt::print("fitted in {} evaluations: deviation from the mean curve {:.2f} -> {:.2f} km/h (root mean square)\n\n",
               fit.evaluations, fit.rms_before_mps * kKmhPerMps, fit.rms_after_mps * kKmhPerMps);
    scenario.driver = fit.driver;
    scenario.driver_name = "fitted";
    if (options.write.empty()) return;
    const std::string comment = fmt::format(
        "How vehicles are driven. Free driving (profile and speed_gain) is fitted by `stopline-startup --fit` so that the\n"
        "simulated start of {} follows the mean of {}; nothing else is fitted.\n"
        "Controller gains: Ploeg et al. 2011, reference [31] of the paper; radar delay: its Section III.D; comfort limits: ISO\n"
        "15622. The V2V delay is not in the paper; string stability depends on it.\n"
        "Our choice: jerk_up and jerk_down: the command has no steps, yet reaches a comfort limit in 0.42 s (up) and 0.14 s\n"
        "(down, less than the lag of the brake). catch_up_factor: 2.5 km/h at 50 km/h close a gap and hardly exceed the limit.\n"
        "emergency_threshold: a little below deceleration_comfort, so that an emergency begins before comfortable braking is used\n"
        "up. emergency_gap: room that is left behind an emergency.",
        scenario.vehicle_name,
        options.measured.empty() ? kMeasured : shortened(measured_file(options).filename().string()));
    write_file(options.write, driver_yaml(scenario.driver, comment));
    fmt::print("driver written to {}\n\n", options.write);
}

std::string command_of(const Options& options) {
    std::string command = command_text("stopline-startup", options.file, options.common);
    if (!options.measured.empty()) command += " --measured " + shell_word(options.measured);
    return command + (options.fit ? " --fit" : "");
}

void write_results(const Options& options, const Scenario& scenario, const StartupReport& report) {
    const std::filesystem::path folder = options.common.output.empty() ? "out/startup" : options.common.output;
    const Figure figure = startup_figure(report);
    Provenance provenance;
    provenance.command = command_of(options);
    prepare_folder(folder);
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
        fmt::print("  no figure: gnuplot is not installed (Debian package gnuplot-nox)\n");
        return;
    }
    draw(figure, folder);
    fmt::print("  startup.svg, startup.png\n");
}

ExitCode run(const Options& options) {
    if (!options.write.empty() && !options.fit) throw InputError("--write needs --fit");
    const std::filesystem::path usual = (data_directory() / "../scenarios/single_light.yaml").lexically_normal();
    Scenario scenario = load_with_options(options.file.empty() ? usual.string() : options.file, options.common);
    const StartupCurve curve = load_startup_curve(measured_file(options));
    if (options.fit) fit_driver(options, curve, scenario);
    const StartupReport report = report_startup(scenario, curve);
    fmt::print("start of {} with driver {} against {}\n\n{}", report.vehicle, report.driver,
               measured_file(options).filename().string(), startup_text(report));
    write_results(options, scenario, report);
    fmt::print("\nNext: stopline-run scenarios/single_light.yaml for what this start means at a light.\n");
    return ExitCode::done;
}

}  // namespace

int startup_main(int argc, const char* const* argv) {
    return run_program("stopline-startup", [&] {
        CLI::App app("The simulated start of a platoon leader beside measured starts at traffic lights.",
                     "stopline-startup");
        Options options;
        declare(app, options);
        const std::optional<ExitCode> end = parse_command_line(app, argc, argv);
        return end ? *end : run(options);
    });
}

}  // namespace stopline

int main(int argc, char** argv) { return stopline::startup_main(argc, argv); }
