// A job is one part of the reproduction of the paper. It makes runs, measurements, tables and figures in its own
// folder, and a record of them. A job with a valid record is not repeated.
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

// Output of a job. File names are relative to its folder.
struct JobOutput {
    std::vector<std::string> figures;   // NAME of NAME.svg and NAME.png
    std::vector<std::string> tables;    // NAME.csv
    std::vector<std::string> measured;  // experiments of the scorecard, NAME of measured_NAME.csv
    std::vector<std::pair<std::string, std::string>> conditions;  // name and text
    std::vector<std::string> commands;                            // commands that repeat the runs
    std::set<std::uint64_t> seeds;
    std::map<std::string, std::uint64_t> scenario_hashes;
    std::int64_t violations = 0;  // runs with overlaps, entries on red or lost vehicles
};

// Input of a job.
struct JobContext {
    std::filesystem::path folder;  // folder of this job
    std::filesystem::path stores;  // folder of the stored runs of all jobs
    Reductions reductions;         // empty: the full job
    std::string key;               // identifies the program, its input files, and full or reduced jobs
    int threads = 1;
    std::function<bool(double)> on_progress;  // gets the share done; false: stop
    std::function<void(double)> on_stored;    // gets the share that was stored before

    bool reduced() const { return !reductions.rows().empty(); }
    // Returns the options for experiments of the scorecard.
    ScorecardOptions scorecard() const;
};

struct Job {
    const char* name;     // name of its folder
    const char* section;  // main section of the paper, such as III
    const char* title;
    double expected_s;        // expected duration on one thread (see WorkEstimate)
    double quick_expected_s;  // the same for the reduced job
    bool (*is_needed_by)(const std::string& section);
    JobOutput (*run)(const JobContext& context);
};

// Returns all jobs in the order of execution.
const std::vector<Job>& all_jobs();
// Returns the jobs that a section needs, or every job for "all". Returns nothing for an unknown section.
std::vector<const Job*> jobs_of(const std::string& section);

// Writes the record. It is written last, so an interrupted job has none.
void store_record(const std::filesystem::path& folder, const std::string& key, const JobOutput& output);
// Reads the record. Returns nothing if there is none, its key differs, or one of its files is missing or changed.
std::optional<JobOutput> load_record(const std::filesystem::path& folder, const std::string& key);

// Returns the file of the measurements of an experiment.
std::filesystem::path measured_file(const std::filesystem::path& folder, const std::string& experiment);

}  // namespace stopline
