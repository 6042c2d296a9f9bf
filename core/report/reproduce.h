// The paper's experiments one after another: what was done before is taken as it is, what fails costs only itself.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "report/job.h"

namespace stopline {

struct ReproduceProgress {
    double share;   // of what this session has to do, 0..1
    double left_s;  // until the last job is done, as far as can be told
    std::string doing;
};

struct ReproduceOptions {
    std::string section = "all";   // III to VII, or all
    Reductions reductions;         // none: the whole
    std::filesystem::path folder;  // of the report; jobs and stores are in a folder within
    int threads = 1;
    std::function<bool(const ReproduceProgress&)> on_progress;  // false to stop
    std::function<void(const std::string&)> on_message;         // a line for each job that has ended
};

// How one job ended.
struct JobEnd {
    const Job* job;
    std::filesystem::path folder;  // of its files
    JobOutput output;
    std::string problem;  // "": done
    std::map<std::string, Measurements> measured;
};

// The sections that can be asked for, "all" last.
std::vector<std::string> known_sections();

// Throws InputError for an unknown section, where nothing can be drawn or written, or the program cannot be read; and Interrupted.
// What a job throws becomes its problem. How long each took in the session that ended it is in times.csv beside the jobs.
std::vector<JobEnd> run_jobs(const ReproduceOptions& options);

// Where the jobs of these options are.
std::filesystem::path jobs_folder(const ReproduceOptions& options);

}  // namespace stopline
