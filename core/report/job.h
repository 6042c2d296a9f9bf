// A part of the paper's reproduction that is done as a whole: some runs, what was measured, tables and figures in a folder of its own, and
// a record of all that. A job whose record is there and fits is not done again.
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

#include "experiment/measurements.h"
#include "experiment/reductions.h"
#include "experiment/scorecard.h"

namespace stopline {

// What a job leaves. Names of files are relative to its folder.
struct JobOutput {
    std::vector<std::string> figures;   // NAME of NAME.svg and NAME.png
    std::vector<std::string> tables;    // NAME.csv
    std::vector<std::string> measured;  // experiments of the scorecard, NAME of measured_NAME.csv
    std::vector<std::pair<std::string, std::string>> conditions;  // what, and in which words
    std::vector<std::string> commands;                            // that make the same, one each
    std::set<std::uint64_t> seeds;
    std::map<std::string, std::uint64_t> scenario_hashes;
    std::int64_t violations = 0;  // runs with overlaps, entries on red or lost vehicles
};

// What a job is given.
struct JobContext {
    std::filesystem::path folder;  // of its own
    std::filesystem::path stores;  // of the runs of all jobs
    Reductions reductions;         // none: the whole
    std::string key;               // what its results depend on
    int threads = 1;
    std::function<bool(double)> on_progress;  // share of it; false to stop
    std::function<void(double)> on_stored;    // share of it that stores had before

    bool reduced() const { return !reductions.rows().empty(); }
    // For experiments of the scorecard.
    ScorecardOptions scorecard() const;
};

struct Job {
    const char* name;     // of its folder
    const char* section;  // of the paper, without what is below it
    const char* title;
    double expected_s;                           // on one thread, see WorkEstimate: of the whole ...
    double quick_s;                              // ... and of the reduced one
    bool (*wanted)(const std::string& section);  // whether a section needs it
    JobOutput (*run)(const JobContext& context);
};

// All of them, in the order in which they are done.
const std::vector<Job>& all_jobs();
// Those that a section needs ("all": every one). Empty for a section that has none.
std::vector<const Job*> jobs_of(const std::string& section);

// The record. Written last, so that a job that was killed has none.
void store_record(const std::filesystem::path& folder, const std::string& key, const JobOutput& output);
// Nothing where there is none, it has another key, or a file that it names is missing or is not as it was.
std::optional<JobOutput> load_record(const std::filesystem::path& folder, const std::string& key);

// The file of what was measured for an experiment.
std::filesystem::path measured_file(const std::filesystem::path& folder, const std::string& experiment);

}  // namespace stopline
