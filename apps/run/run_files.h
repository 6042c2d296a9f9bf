// What stopline-run writes while the simulation runs, one file a population each: recordings for stopline-replay, tables for SUMO's
// tools, and trajectories of grids.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "experiment/observation.h"
#include "record/frame_clock.h"
#include "record/run_writer.h"
#include "scenario/scenario.h"

namespace stopline {

struct RunFilesOptions {
    // Files; empty: none.
    std::string record;
    std::string fcd;
    std::string tripinfo;
    std::string loops;
    std::string trajectories;  // of a grid
    std::string interval = "1 s";
    std::string from = "0 s";
    std::string until;  // empty: to the end
    std::string loop_interval = "60 s";
    double trajectory_interval_s = 0.1;
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
    struct Writing {
        std::filesystem::path file;
        std::unique_ptr<RunWriter> writer;
    };
    // Of one kind of file: its name, and what writes it for a population.
    struct Kind {
        std::string file;
        std::function<std::unique_ptr<RunWriter>(const std::filesystem::path&, std::size_t, const Model&)> make;
    };
    void add_recording(const RunFilesOptions& options, const Scenario& scenario, const std::string& command);
    void look(std::size_t population, const Simulation& simulation);

    const Scenario& scenario_;
    RecordingWindow window_;
    std::vector<Kind> kinds_;
    std::vector<std::vector<Writing>> runs_;  // [population]
    bool needs_detectors_ = false;
    bool records_ = false;
};

}  // namespace stopline
