// Runs the jobs one after another. Finished jobs are not repeated. A failed job does not stop the others.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "paper/report/job.h"

namespace stopline {

struct ReproduceProgress {
    double share;        // share of the work of this session that is done, 0..1
    double remaining_s;  // estimated time until the last job is done
    std::string job;     // section and title of the current job
};

struct ReproduceOptions {
    std::string section = "all";   // III to VII, or all
    Reductions reductions;         // empty: the full reproduction
    std::filesystem::path folder;  // folder of the report; it contains the folder of the jobs
    int threads = 1;
    std::function<bool(const ReproduceProgress&)> on_progress;  // false: stop
    std::function<void(const std::string&)> on_message;         // gets a line for each job that has ended
};

// Result of one job.
struct JobResult {
    const Job* job;
    std::filesystem::path folder;  // folder of its files
    JobOutput output;
    std::string problem;  // error message; empty: the job is done
    std::map<std::string, Measurements> measured;
};

// Returns the sections that have jobs, and "all" as the last.
std::vector<std::string> known_sections();

// Runs the missing jobs of a section. An exception in a job becomes its problem. The duration of each job is stored in
// times.csv in the folder of the jobs. Throws InputError for an unknown section, without gnuplot, or if the folder
// cannot be written or the program file cannot be read. Throws Interrupted.
std::vector<JobResult> run_jobs(const ReproduceOptions& options);

// Returns the folder of the jobs.
std::filesystem::path jobs_folder(const ReproduceOptions& options);

}  // namespace stopline
