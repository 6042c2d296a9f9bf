// What stopline-run writes while the simulation runs, one file a population: recordings for stopline-replay.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "experiment/observation.h"
#include "record/recorder.h"
#include "scenario/scenario.h"

namespace stopline {

struct RunFilesOptions {
    std::string record;  // file; empty: none
    std::string interval = "0.5 s";
    std::string from = "0 s";
    std::string until;  // empty: to the end
};

void add_run_files_options(CLI::App& app, RunFilesOptions& options);

class RunFiles {
public:
    // `command` makes the run again. Throws InputError with the option that cannot be used.
    RunFiles(const RunFilesOptions& options, const Scenario& scenario, const std::string& command);

    // To be given to the runs; refers to this.
    Observation observation();
    // After the runs: puts all files in their places. What was written, for the user; empty where nothing was asked for.
    std::string finish();

private:
    struct Run {
        RunOrigin origin;
        std::filesystem::path record;
        std::unique_ptr<Recorder> recorder;
    };
    void look(std::size_t population, const Simulation& simulation);

    RecordingWindow window_;
    std::vector<Run> runs_;  // [population]
    bool wanted_ = false;
};

}  // namespace stopline
