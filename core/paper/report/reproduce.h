// Runs the jobs of the reproduction one after another. Finished jobs are not repeated. If a job fails, the next job
// still runs.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "paper/report/job.h"

namespace stopline {

struct ReproduceProgress {
    double share;        // finished share of the work that was left when the program started, 0..1
    double remaining_s;  // estimated time until the end of the last job, s
    std::string job;     // section and title of the current job
};

struct ReproduceOptions {
    std::string section = "all";   // section of the paper, III to VII, or "all"
    Reductions reductions;         // empty for a full reproduction
    std::filesystem::path folder;  // folder of the report; the folder of the jobs lies in it
    int threads = 1;
    std::function<bool(const ReproduceProgress&)> on_progress;  // returns false to stop the reproduction
    std::function<void(const std::string&)> on_message;         // receives a line for each job that has ended
};

// Result of one job.
struct JobResult {
    const Job* job;
    std::filesystem::path folder;  // folder of the job's files
    JobOutput output;
    std::string problem;                           // error message of a failed job; empty for a finished job
    std::map<std::string, Measurements> measured;  // by name of the scorecard experiment
};

// Returns the sections that have jobs, followed by "all".
std::vector<std::string> known_sections();

// Runs the unfinished jobs of a section. Returns the results of all jobs of the section, including the jobs that were
// finished before. If a job throws an exception, the job has failed, and JobResult::problem holds the message. The
// durations of the jobs are stored in times.csv in the folder of the jobs. Throws InputError if the section is unknown,
// gnuplot is not installed, the folder cannot be written or the program file cannot be read. Throws Interrupted if
// on_progress returns false.
std::vector<JobResult> run_jobs(const ReproduceOptions& options);

// Returns the folder that contains one folder for each job. Full and reduced reproductions use different folders.
std::filesystem::path jobs_folder(const ReproduceOptions& options);

}  // namespace stopline
