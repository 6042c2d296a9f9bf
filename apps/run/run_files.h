// Files that stopline-run writes during the simulation: recordings for stopline-replay, output files in formats of
// SUMO, the greens of signals, and trajectories of networks. Each population gets a file of its own.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/io/command_files.h"
#include "common/options.h"
#include "record/recording/frame_clock.h"
#include "record/run_writer.h"
#include "runs/observation.h"
#include "runs/tables/column_aliases.h"
#include "scenario/scenario.h"

namespace stopline {

struct RunFilesOptions {
    // Paths of the files. If a path is empty, that file is not written.
    std::string record;
    std::string fcd;
    std::string tripinfo;
    std::string loops;
    std::string greens;
    std::string trajectories;  // only for networks of several intersections
    // Times of the frames in the files of --record and --fcd.
    std::string interval = "1 s";
    std::string from = "0 s";
    std::string until;                   // time of the last frame; empty: end of the run
    std::string loop_interval = "60 s";  // counting interval of --e1
    double trajectory_interval_s = 0.1;
    ColumnNames column_names = ColumnNames::current;  // column names in the trajectories
};

void add_run_files_options(Options& app, RunFilesOptions& options);

class RunFiles {
public:
    // `command` is the command line of the run, which recordings store. If an option has a wrong value, throws an
    // InputError that names the option.
    RunFiles(const RunFilesOptions& options, const Scenario& scenario, const std::string& command);

    // Adds the files of all populations to the outputs of the command.
    void add_outputs(CommandFiles& files) const;
    // Throws InputError if a file has the name of a figure in this folder: its ending is .svg, .png, .gp or .dat.
    void refuse_names_of_figures(const std::filesystem::path& folder) const;
    // Creates the folders of the files and checks that the files can be written. Throws InputError if not.
    void prepare() const;

    // Returns the observer to pass to the runs. The observer must not outlive this object.
    Observation observation();
    // Completes all files after the runs. Returns a text that lists the files for the user; empty if there are no
    // files.
    std::string finish();

private:
    struct OpenFile {
        std::filesystem::path path;
        std::unique_ptr<RunWriter> writer;
    };
    // Creates the writer for the file of one population.
    using WriterMaker =
        std::function<std::unique_ptr<RunWriter>(const std::filesystem::path&, std::size_t, const Model&)>;
    struct FileKind {
        std::string option;  // option that names the file
        std::string path;    // path from the command line
        WriterMaker make_writer;
    };
    WriterMaker recording_maker(const RunFilesOptions& options, const Scenario& scenario, const std::string& command);
    void look(std::size_t population, const Simulation& simulation);

    const Scenario& scenario_;
    RecordingWindow window_;
    std::vector<FileKind> kinds_;
    std::vector<std::vector<OpenFile>> open_files_;  // [population][kind of file]
    bool needs_detectors_ = false;
    bool has_recording_ = false;
};

}  // namespace stopline
