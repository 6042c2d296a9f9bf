#include "run/run_files.h"

#include <cmath>

#include <fmt/format.h>

#include "base/input_error.h"
#include "common/command_line.h"
#include "experiment/output.h"
#include "record/recorder.h"
#include "record/sumo_files.h"
#include "record/trajectory_writer.h"
#include "scenario/quantity.h"

namespace stopline {

namespace {

double seconds_of(const char* option, const std::string& text) {
    const ParsedQuantity time = parse_quantity(text, unit("s"));
    if (!time.problem.empty()) throw InputError(fmt::format("{}: value '{}' {}", option, text, time.problem));
    if (time.si < 0.0) throw InputError(fmt::format("{}: value '{}' is below 0 s", option, text));
    return time.si;
}

// `used`: something is written at this interval; defaults fit not all steps.
double whole_steps(const char* option, const std::string& text, const Scenario& scenario, bool used) {
    const double time_s = seconds_of(option, text);
    if (!used) return time_s;
    const double steps = time_s / scenario.tick_s();
    if (steps < 0.5 || std::abs(steps - std::round(steps)) > 1e-6) {
        throw InputError(fmt::format("{}: '{}' is not a whole number of steps of {}", option, text,
                                     short_text(scenario.tick_s(), unit("ms"))));
    }
    return time_s;
}

RecordingWindow window_of(const RunFilesOptions& options, const Scenario& scenario) {
    RecordingWindow window;
    const bool frames = !options.record.empty() || !options.fcd.empty();
    window.interval_s = whole_steps("--record-interval", options.interval, scenario, frames);
    window.from_s = seconds_of("--record-from", options.from);
    if (!options.until.empty()) window.until_s = seconds_of("--record-until", options.until);
    if (window.until_s <= window.from_s) {
        throw InputError(
            fmt::format("--record-until: '{}' is not after --record-from '{}'", options.until, options.from));
    }
    if (scenario.duration_s > 0.0 && window.from_s > scenario.duration_s) {
        throw InputError(fmt::format("--record-from: '{}' is after the end of the run: at most duration, {}",
                                     options.from, short_text(scenario.duration_s, unit("s"))));
    }
    return window;
}

// NAME.ext, or NAME.POPULATION.ext where there are several.
std::filesystem::path file_of(const std::filesystem::path& file, const Scenario& scenario, std::size_t population) {
    if (scenario.populations.size() == 1) return file;
    const std::string name =
        fmt::format("{}.{}{}", file.stem().string(), scenario.populations[population].name, file.extension().string());
    return file.parent_path() / name;
}

void check_folder_of(const std::string& file) {
    const std::filesystem::path path(file);
    if (path.filename().empty()) throw InputError(fmt::format("'{}' is not the name of a file", file));
    prepare_folder(path.has_parent_path() ? path.parent_path() : ".");
}

class RecordingWriter : public RunWriter {
public:
    RecordingWriter(const std::filesystem::path& file, const RecordingWindow& window, const RunOrigin& origin,
                    const Model& model)
        : recorder_(file, window, origin, model) {}

    void look(const State& state) override { recorder_.look(state); }
    std::string finish() override {
        const RecordingSize size = recorder_.finish();
        return fmt::format("{} frames, {} vehicle states, {:.2f} MB, {:.2f} bytes a vehicle and frame", size.frames,
                           size.vehicle_states, static_cast<double>(size.bytes) * 1e-6, size.bytes_per_state());
    }

private:
    Recorder recorder_;
};

}  // namespace

void add_run_files_options(CLI::App& app, RunFilesOptions& options) {
    const auto file = [&](const char* name, std::string& value, const char* help) {
        app.add_option(name, value, help)->type_name("FILE");
    };
    const auto time = [&](const char* name, std::string& value, const char* help) {
        app.add_option(name, value, help)->type_name("TIME");
    };
    file(
        "--record", options.record,
        "Record every vehicle and light, for stopline-replay; with several populations, here and below, one file each: "
        "NAME.POPULATION.EXT");
    file("--fcd", options.fcd, "Write every vehicle's path as SUMO's floating car data (XML)");
    time("--record-interval", options.interval, "Time between frames of both (default: 1 s)");
    time("--record-from", options.from, "Write both from this time on (default: 0 s)");
    time("--record-until", options.until, "Write both up to this time (default: the end)");
    file("--tripinfo", options.tripinfo, "Write finished trips as SUMO does (XML)");
    file("--e1", options.loops, "Write the detectors as SUMO's induction loops (XML)");
    time("--e1-interval", options.loop_interval, "Time that a row of them is about (default: 60 s)");
}

RunFiles::RunFiles(const RunFilesOptions& options, const Scenario& scenario, const std::string& command)
    : scenario_(scenario), window_(window_of(options, scenario)), runs_(scenario.populations.size()) {
    const auto add = [&](const std::string& file, auto make) {
        if (!file.empty()) kinds_.push_back({file, make});
    };
    if (!options.record.empty()) add_recording(options, scenario, command);
    add(options.fcd, [this](const std::filesystem::path& file, std::size_t, const Model& model) {
        return make_fcd_writer(file, window_, model);
    });
    add(options.tripinfo, [](const std::filesystem::path& file, std::size_t, const Model& model) {
        return make_tripinfo_writer(file, model);
    });
    const double loop_s = whole_steps("--e1-interval", options.loop_interval, scenario, !options.loops.empty());
    add(options.loops, [loop_s](const std::filesystem::path& file, std::size_t, const Model& model) {
        return make_loop_writer(file, loop_s, model);
    });
    needs_detectors_ = !options.loops.empty();
    RecordingWindow trajectories = window_;
    trajectories.interval_s = options.trajectory_interval_s;
    add(options.trajectories,
        [this, trajectories](const std::filesystem::path& file, std::size_t k, const Model& model) {
            return make_trajectory_writer(file, trajectories, scenario_.populations[k].name, model);
        });
    for (const Kind& kind : kinds_) check_folder_of(kind.file);
}

void RunFiles::add_recording(const RunFilesOptions& options, const Scenario& scenario, const std::string& command) {
    std::string again = command + " --record FILE --record-interval " + shell_word(options.interval);
    if (window_.from_s > 0.0) again += " --record-from " + shell_word(options.from);
    if (!options.until.empty()) again += " --record-until " + shell_word(options.until);
    const NetworkSettings& network = scenario.network;
    constexpr double kApproachLaneWidth_m = 3.5;
    RunOrigin origin{again,
                     scenario.name,
                     scenario.title,
                     fmt::format("{:016x}", scenario.hash),
                     scenario.seed,
                     "",
                     network.is_streets()          ? network.streets.lane_width_m
                     : network.has_intersections() ? network.intersection.lane_width_m
                                                   : kApproachLaneWidth_m};
    const auto make = [this, origin](const std::filesystem::path& file, std::size_t k, const Model& model) {
        RunOrigin own = origin;
        own.population = scenario_.populations[k].name;
        return std::make_unique<RecordingWriter>(file, window_, own, model);
    };
    kinds_.push_back({options.record, make});
    records_ = true;
}

Observation RunFiles::observation() {
    Observation observation;
    observation.all_detectors = needs_detectors_;
    if (!kinds_.empty()) {
        observation.look = [this](std::size_t population, const Simulation& simulation) {
            look(population, simulation);
        };
    }
    return observation;
}

void RunFiles::look(std::size_t population, const Simulation& simulation) {
    std::vector<Writing>& run = runs_[population];
    if (run.empty()) {
        for (const Kind& kind : kinds_) {
            const std::filesystem::path file = file_of(kind.file, scenario_, population);
            run.push_back({file, kind.make(file, population, simulation.model())});
        }
    }
    for (const Writing& writing : run) writing.writer->look(simulation.state());
}

std::string RunFiles::finish() {
    if (kinds_.empty()) return "";
    std::string text = "\nWritten while they ran\n";
    for (const std::vector<Writing>& run : runs_) {
        for (const Writing& writing : run) {
            text += fmt::format("  {}: {}\n", writing.file.string(), writing.writer->finish());
        }
    }
    if (!records_) return text;
    return text + fmt::format("See it: stopline-replay {}\n", shell_word(runs_.front().front().file.string()));
}

}  // namespace stopline
