// A job is one part of the reproduction of the paper. It runs simulations and writes measurements, tables and figures
// into its own folder. It also writes a record (job.json) that lists these files. A job with a valid record is not
// repeated.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "paper/measurements.h"
#include "paper/reductions.h"
#include "paper/scorecard.h"

namespace stopline {

// Output of a job. File names are relative to the folder of the job.
struct JobOutput {
    std::vector<std::string> figures;   // file names without .svg and .png
    std::vector<std::string> tables;    // file names with .csv
    std::vector<std::string> measured;  // names of scorecard experiments; each has a file measured_NAME.csv
    std::vector<std::pair<std::string, std::string>> conditions;  // conditions of the runs, as name and text
    std::vector<std::string> commands;                            // command lines that repeat the runs
    std::set<std::uint64_t> seeds;
    std::map<std::string, std::uint64_t> scenario_hashes;
    // Overlaps of vehicles, entries on red and lost vehicles: number of violations, or of runs with violations.
    std::int64_t violations = 0;
};

// Input of a job.
struct JobContext {
    std::filesystem::path folder;  // folder of this job
    std::filesystem::path stores;  // folder of the files that store finished runs, shared by all jobs
    Reductions reductions;         // empty for a full job
    std::string key;               // identifies the program, its input files, and whether there are reductions
    int threads = 1;
    // Receives the finished share of the job, 0..1. The job stops if the function returns false.
    std::function<bool(double)> on_progress;
    // Receives the share of the job that is already done, because the stores hold its runs from an earlier session.
    std::function<void(double)> on_stored;

    bool reduced() const { return !reductions.rows().empty(); }
    // Returns the options with which the job runs experiments of the scorecard.
    ScorecardOptions scorecard() const;
};

struct Job {
    const char* name;     // also the name of the job's folder
    const char* section;  // main section of the paper, such as III
    const char* title;
    double expected_s;        // expected duration of the full job on one thread (see WorkEstimate)
    double quick_expected_s;  // expected duration with the reductions of a quick run, on one thread
    bool (*is_needed_by)(const std::string& section);
    JobOutput (*run)(const JobContext& context);
};

// Returns all jobs in the order of execution.
const std::vector<Job>& all_jobs();
// Returns the jobs that a section needs, or every job for "all". Returns nothing for an unknown section.
std::vector<const Job*> jobs_of(const std::string& section);

// Writes the record of a job. Call it after all files are written, so that an interrupted job has no record.
void store_record(const std::filesystem::path& folder, const std::string& key, const JobOutput& output);
// Reads the record of a job. Returns std::nullopt if the record is missing, is damaged or has a key other than `key`,
// or if one of the listed files is missing or has changed.
std::optional<JobOutput> load_record(const std::filesystem::path& folder, const std::string& key);

// Returns the path of the file in the job's folder that holds the measurements of an experiment.
std::filesystem::path measured_file(const std::filesystem::path& folder, const std::string& experiment);

}  // namespace stopline
