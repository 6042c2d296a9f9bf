#include "run/run_files.h"

#include <cmath>

#include <fmt/format.h>

#include "base/input_error.h"
#include "common/command_line.h"
#include "experiment/output.h"
#include "scenario/quantity.h"

namespace stopline {

namespace {

double seconds_of(const char* option, const std::string& text) {
    const ParsedQuantity time = parse_quantity(text, unit("s"));
    if (!time.problem.empty()) throw InputError(fmt::format("{}: value '{}' {}", option, text, time.problem));
    if (time.si < 0.0) throw InputError(fmt::format("{}: value '{}' is below 0 s", option, text));
    return time.si;
}

double whole_steps(const char* option, const std::string& text, const Scenario& scenario) {
    const double time_s = seconds_of(option, text);
    const double steps = time_s / scenario.tick_s();
    if (steps < 0.5 || std::abs(steps - std::round(steps)) > 1e-6) {
        throw InputError(fmt::format("{}: '{}' is not a whole number of steps of {}", option, text,
                                     short_text(scenario.tick_s(), unit("ms"))));
    }
    return time_s;
}

RecordingWindow window_of(const RunFilesOptions& options, const Scenario& scenario) {
    RecordingWindow window;
    window.interval_s = whole_steps("--record-interval", options.interval, scenario);
    window.from_s = seconds_of("--record-from", options.from);
    if (!options.until.empty()) window.until_s = seconds_of("--record-until", options.until);
    if (window.until_s <= window.from_s) {
        throw InputError(
            fmt::format("--record-until: '{}' is not after --record-from '{}'", options.until, options.from));
    }
    return window;
}

// NAME.ext, or NAME.POPULATION.ext where there are several.
std::filesystem::path file_of(const std::filesystem::path& file, const Scenario& scenario, std::size_t population) {
    if (file.empty() || scenario.populations.size() == 1) return file;
    const std::string name =
        fmt::format("{}.{}{}", file.stem().string(), scenario.populations[population].name, file.extension().string());
    return file.parent_path() / name;
}

void check_folder_of(const char* option, const std::string& file) {
    const std::filesystem::path path(file);
    if (path.filename().empty()) throw InputError(fmt::format("{}: '{}' is not the name of a file", option, file));
    prepare_folder(path.has_parent_path() ? path.parent_path() : ".");
}

std::string recorded_text(const std::filesystem::path& file, const RecordingSize& size) {
    return fmt::format("  {}: {} frames, {} vehicle states, {:.2f} MB, {:.2f} bytes a vehicle and frame\n",
                       file.string(), size.frames, size.vehicle_states, static_cast<double>(size.bytes) * 1e-6,
                       size.bytes_per_state());
}

}  // namespace

void add_run_files_options(CLI::App& app, RunFilesOptions& options) {
    app.add_option(
           "--record", options.record,
           "Record every vehicle and light into this file, for stopline-replay; several populations: FILE.POPULATION")
        ->type_name("FILE");
    app.add_option("--record-interval", options.interval, "Time between its frames (default: 0.5 s)")
        ->type_name("TIME");
    app.add_option("--record-from", options.from, "Record from this time on (default: 0 s)")->type_name("TIME");
    app.add_option("--record-until", options.until, "Record up to this time (default: the end)")->type_name("TIME");
}

RunFiles::RunFiles(const RunFilesOptions& options, const Scenario& scenario, const std::string& command)
    : window_(window_of(options, scenario)), wanted_(!options.record.empty()) {
    if (!wanted_) return;
    check_folder_of("--record", options.record);
    std::string again = command + " --record FILE --record-interval " + shell_word(options.interval);
    if (window_.from_s > 0.0) again += " --record-from " + shell_word(options.from);
    if (!options.until.empty()) again += " --record-until " + shell_word(options.until);
    for (std::size_t k = 0; k < scenario.populations.size(); ++k) {
        Run run;
        run.origin = {again,
                      scenario.name,
                      scenario.title,
                      fmt::format("{:016x}", scenario.hash),
                      scenario.seed,
                      scenario.populations[k].name,
                      scenario.network.has_intersections() ? scenario.network.intersection.lane_width_m : 3.5};
        run.record = file_of(options.record, scenario, k);
        runs_.push_back(std::move(run));
    }
}

Observation RunFiles::observation() {
    Observation observation;
    if (wanted_) {
        observation.look = [this](std::size_t population, const Simulation& simulation) {
            look(population, simulation);
        };
    }
    return observation;
}

void RunFiles::look(std::size_t population, const Simulation& simulation) {
    Run& run = runs_[population];
    if (!run.recorder) {
        run.recorder = std::make_unique<Recorder>(run.record, window_, run.origin, simulation.model());
    }
    run.recorder->look(simulation.state());
}

std::string RunFiles::finish() {
    if (!wanted_) return "";
    std::string text = "\nRecorded\n";
    for (Run& run : runs_) text += recorded_text(run.record, run.recorder->finish());
    return text + fmt::format("See it: stopline-replay {}\n", shell_word(runs_.front().record.string()));
}

}  // namespace stopline
