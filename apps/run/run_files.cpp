#include "run/run_files.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/output.h"
#include "common/command_line.h"
#include "common/examples.h"
#include "record/green_writer.h"
#include "record/recording/recorder.h"
#include "record/sumo_files.h"
#include "record/trajectory_writer.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/schema/quantity.h"

namespace stopline {

namespace {

double parse_time_s(const char* option, const std::string& text) {
    const ParsedQuantity time = parse_quantity(text, unit("s"));
    if (!time.problem.empty()) throw InputError(fmt::format("{}: value '{}' {}", option, text, time.problem));
    if (time.si < 0.0) throw InputError(fmt::format("{}: value '{}' is below 0 s; give 0 s or more", option, text));
    return time.si;
}

// Parses an interval. An interval that a file uses must be a whole number of simulation steps. An unused interval
// (`is_used` is false) may have any length, because the default interval does not fit every step length.
double parse_interval_s(const char* option, const std::string& text, const Scenario& scenario, bool is_used) {
    const double time_s = parse_time_s(option, text);
    if (!is_used) return time_s;
    if (time_s <= 0.0) throw InputError(fmt::format("{}: value '{}' must be above 0 s", option, text));
    const double steps = time_s / scenario.tick_s();
    if (std::abs(steps - std::round(steps)) > 1e-6) {
        throw InputError(fmt::format("{}: '{}' is not a whole number of steps of {}; give a multiple of it", option,
                                     text, short_text(scenario.tick_s(), unit("ms"))));
    }
    return time_s;
}

RecordingWindow window_of(const RunFilesOptions& options, const Scenario& scenario) {
    RecordingWindow window;
    const bool has_frames = !options.record.empty() || !options.fcd.empty();
    window.interval_s = parse_interval_s("--record-interval", options.interval, scenario, has_frames);
    window.from_s = parse_time_s("--record-from", options.from);
    if (!options.until.empty()) window.until_s = parse_time_s("--record-until", options.until);
    if (window.until_s <= window.from_s) {
        throw InputError(fmt::format("--record-until: '{}' is not after --record-from '{}'; give a later time",
                                     options.until, options.from));
    }
    if (scenario.duration_s > 0.0 && window.from_s > scenario.duration_s) {
        throw InputError(fmt::format("--record-from: '{}' is after the end of the run; give at most the duration, {}",
                                     options.from, short_text(scenario.duration_s, unit("s"))));
    }
    return window;
}

// Returns the path of a population's file: NAME.ext, or NAME.POPULATION.ext if there are several populations. The
// ending of a compressed file has two parts, such as .xml.gz.
std::filesystem::path population_file(const std::filesystem::path& file, const Scenario& scenario,
                                      std::size_t population) {
    if (scenario.populations.size() == 1) return file;
    std::filesystem::path stem = file.stem();
    std::string ending = file.extension().string();
    if (ending == ".gz" || ending == ".zst") {
        ending = stem.extension().string() + ending;
        stem = stem.stem();
    }
    const std::string name = fmt::format("{}.{}{}", stem.string(), scenario.populations[population].name, ending);
    return file.parent_path() / name;
}

// Throws InputError if a figure in the folder of the tables could have the name of this file. `option`: the option that
// names the file.
void refuse_name_of_figure(const std::string& option, const std::filesystem::path& file,
                           const std::filesystem::path& folder) {
    constexpr std::array kEndings{".svg", ".png", ".gp", ".dat"};
    const bool is_beside = resolved_path(file).parent_path() == resolved_path(folder);
    if (!is_beside || std::find(kEndings.begin(), kEndings.end(), file.extension()) == kEndings.end()) return;
    throw InputError(fmt::format("{}: a figure in the folder of --output could overwrite '{}'; give another ending",
                                 option, file.string()));
}

class RecordingWriter : public RunWriter {
public:
    RecordingWriter(const std::filesystem::path& file, const RecordingWindow& window, const RunOrigin& origin,
                    const Model& model)
        : recorder_(file, window, origin, model) {}

    void observe(const State& state) override { recorder_.observe(state); }
    std::string finish() override {
        const RecordingSize size = recorder_.finish();
        return fmt::format("{} frames, {} vehicle states, {:.2f} MB, {:.2f} bytes per vehicle and frame", size.frames,
                           size.vehicle_states, static_cast<double>(size.bytes) * 1e-6, size.bytes_per_state());
    }

private:
    Recorder recorder_;
};

}  // namespace

void add_run_files_options(Options& app, RunFilesOptions& options) {
    const auto file = [&](const char* name, std::string& value, const char* help) {
        app.add(name, value, help).type_name("FILE");
    };
    const auto time = [&](const char* name, std::string& value, const std::vector<std::string>& files,
                          const char* help) { app.add(name, value, help).type_name("TIME").only_with(files); };
    const std::vector<std::string> framed{"--record", "--fcd"};
    const std::vector<std::string> timed{"--record", "--fcd", "--trajectories"};
    file(
        "--record", options.record,
        "Record all vehicles and signals for stopline-replay. Several populations write one file each, here and below: "
        "NAME.POPULATION.EXT");
    file(
        "--fcd", options.fcd,
        "Write the positions of all vehicles as SUMO floating car data (XML). A file that ends with .gz or .zst is compressed, here "
        "and below");
    time("--record-interval", options.interval, framed, "With --record or --fcd: time between frames (default: 1 s)");
    time("--record-from", options.from, timed,
         "With --record, --fcd or --trajectories: time of the first frame (default: 0 s)");
    time("--record-until", options.until, timed,
         "With --record, --fcd or --trajectories: time of the last frame (default: end of the run)");
    file("--tripinfo", options.tripinfo, "Write finished trips as SUMO tripinfo (XML)");
    file("--e1", options.loops, "Write the counts of the detectors as SUMO induction loops (XML)");
    time("--e1-interval", options.loop_interval, {"--e1"}, "With --e1: counting interval (default: 60 s)");
    file("--greens", options.greens, "Write start and end of every green of each signal group (CSV)");
}

RunFiles::RunFiles(const RunFilesOptions& options, const Scenario& scenario, const std::string& command)
    : scenario_(scenario), window_(window_of(options, scenario)), open_files_(scenario.populations.size()) {
    const auto add = [&](const char* option, const std::string& file, const auto& make_writer) {
        if (file.empty()) return;
        if (!std::filesystem::path(file).has_filename()) {
            throw InputError(fmt::format("{}: '{}' is a folder; add the name of a file to it", option, file));
        }
        kinds_.push_back({option, file, make_writer});
    };
    if (!options.record.empty()) add("--record", options.record, recording_maker(options, scenario, command));
    add("--fcd", options.fcd, [this](const std::filesystem::path& file, std::size_t, const Model& model) {
        return make_fcd_writer(file, window_, model);
    });
    add("--tripinfo", options.tripinfo, [](const std::filesystem::path& file, std::size_t, const Model& model) {
        return make_tripinfo_writer(file, model);
    });
    const double loop_s = parse_interval_s("--e1-interval", options.loop_interval, scenario, !options.loops.empty());
    add("--e1", options.loops, [loop_s](const std::filesystem::path& file, std::size_t, const Model& model) {
        return make_loop_writer(file, loop_s, model);
    });
    needs_detectors_ = !options.loops.empty();
    add("--greens", options.greens, [this](const std::filesystem::path& file, std::size_t k, const Model& model) {
        return make_green_writer(file, scenario_.populations[k].name, model);
    });
    RecordingWindow trajectories = window_;
    trajectories.interval_s = options.trajectory_interval_s;
    const std::string header =
        result_file("network/trajectories.csv", "", kTrajectoryHeader, options.column_names).text;
    add("--trajectories-file", options.trajectories,
        [this, trajectories, header](const std::filesystem::path& file, std::size_t k, const Model& model) {
            return make_trajectory_writer(file, trajectories, scenario_.populations[k].name, model, header);
        });
}

void RunFiles::add_outputs(CommandFiles& files) const {
    for (const FileKind& kind : kinds_) {
        for (std::size_t k = 0; k < scenario_.populations.size(); ++k) {
            files.add_output(population_file(kind.path, scenario_, k), kind.option);
        }
    }
}

void RunFiles::refuse_names_of_figures(const std::filesystem::path& folder) const {
    for (const FileKind& kind : kinds_) refuse_name_of_figure(kind.option, kind.path, folder);
}

void RunFiles::prepare() const {
    for (const FileKind& kind : kinds_) {
        for (std::size_t k = 0; k < scenario_.populations.size(); ++k) {
            prepare_output_file(population_file(kind.path, scenario_, k));
        }
    }
}

RunFiles::WriterMaker RunFiles::recording_maker(const RunFilesOptions& options, const Scenario& scenario,
                                                const std::string& command) {
    std::string record_command = command + " --record FILE --record-interval " + shell_word(options.interval);
    if (window_.from_s > 0.0) record_command += " --record-from " + shell_word(options.from);
    if (!options.until.empty()) record_command += " --record-until " + shell_word(options.until);
    const NetworkSettings& network = scenario.network;
    RunOrigin origin{record_command,
                     scenario.name,
                     scenario.title,
                     fmt::format("{:016x}", scenario.hash),
                     scenario.seed,
                     "",
                     network_kind(network).lane_width_m(network)};
    has_recording_ = true;
    return [this, origin](const std::filesystem::path& file, std::size_t k, const Model& model) {
        RunOrigin population_origin = origin;
        population_origin.population = scenario_.populations[k].name;
        return std::make_unique<RecordingWriter>(file, window_, population_origin, model);
    };
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
    std::vector<OpenFile>& files = open_files_[population];
    if (files.empty()) {
        for (const FileKind& kind : kinds_) {
            const std::filesystem::path path = population_file(kind.path, scenario_, population);
            files.push_back({path, kind.make_writer(path, population, simulation.model())});
        }
    }
    for (const OpenFile& file : files) file.writer->observe(simulation.state());
}

std::string RunFiles::finish() {
    if (kinds_.empty()) return "";
    std::string text = "\nWritten during the runs\n";
    for (const std::vector<OpenFile>& files : open_files_) {
        for (const OpenFile& file : files) {
            text += fmt::format("  {}: {}\n", file.path.string(), file.writer->finish());
        }
    }
    if (!has_recording_) return text;
    return text + fmt::format("To see the first run: {} {}\n", program_command("stopline-replay"),
                              shell_word(open_files_.front().front().path.string()));
}

}  // namespace stopline
