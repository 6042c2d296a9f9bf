// The scorecard: our numbers beside those of the paper, row by row of data/paper/targets.csv. A row is judged by a function
// that reads its answer from the measurements of one experiment; rows without one are open.
//
// A later section adds a file scorecard_section<N>.cpp with its experiments and row judges, and its two lines in scorecard.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "experiment/gnuplot.h"
#include "experiment/measurements.h"
#include "experiment/reductions.h"
#include "experiment/verdict.h"

namespace stopline {

struct ScorecardOptions {
    std::string section;                // rows of it and below; empty: all
    std::filesystem::path folder;       // measurements are kept here for the next time
    std::vector<std::string> settings;  // of every scenario that is run, as for load_scenario
    Reductions reductions;              // what is left out of sweeps and scenarios
    int threads = 1;
    std::function<bool(double)> on_progress;  // share of the experiment under way; false to stop
    std::function<void(double)> on_stored;    // share that a store had before; on_progress then counts from it
    std::function<void(const std::string&)> on_message;  // what is run and what is reused
};

// Something to be measured once for all rows that need it.
struct Experiment {
    const char* name;      // of its file in the folder of measurements
    const char* scenario;  // file in scenarios/ without .yaml
    bool runs;             // false: it reads files only, or keeps its runs itself
    Measurements (*measure)(const Scenario& scenario, const ScorecardOptions& options);
};

struct RowJudge {
    const char* id;          // of the row
    const char* experiment;  // that its answer is read from
    // Nothing where the experiment did not measure it (the row then stays open).
    std::optional<Answer> (*answer)(const Target& target, const Measurements& measurements);
};

std::span<const Experiment> experiments();
std::span<const RowJudge> row_judges();

// Throws std::logic_error for a name that no experiment has.
const Experiment& experiment_named(const std::string& name);

// The scenario that an experiment runs. Throws InputError as load_scenario does.
Scenario scenario_of(const Experiment& experiment, const ScorecardOptions& options);

struct ScoredRow {
    Target target;
    std::string ours;  // empty where open
    Verdict verdict = Verdict::open;
    std::string counted;  // how the row is counted
    std::string reason;   // of a miss; empty otherwise
};

struct Scorecard {
    std::vector<ScoredRow> rows;
    std::map<std::string, std::uint64_t> scenario_hashes;  // of the scenarios behind the rows
    std::vector<Figure> figures;
    double violations = 0.0;  // overlaps, entries on red and lost vehicles in all runs behind the rows
    int count(Verdict verdict) const;
};

// Throws InputError for a section without rows, and Interrupted.
Scorecard make_scorecard(const ScorecardOptions& options);

// The rows of a section (empty: of all) judged by what was measured, by name of the experiment; rows whose experiment is not among
// it are open. Throws InputError for a section without rows.
Scorecard score(const std::string& section, const std::map<std::string, Measurements>& measured);

// Columns id,section,paper,ours,unit,tolerance,verdict,explanation; the last says how it is counted and why it misses.
std::string scorecard_csv(const Scorecard& scorecard);

// data/paper/explanations.csv: how a row is counted, and why it misses where it does. By row id.
struct Explanation {
    std::string counted;
    std::string reason;
};
std::map<std::string, Explanation> load_explanations(const std::filesystem::path& file);

// The commands that show the runs behind the rows with tables and figures, one a section of the paper.
std::vector<std::string> commands_behind(const std::vector<ScoredRow>& rows);

// Puts the explanation beside the row; a miss without a reason says that it is not explained yet.
void explain(const std::map<std::string, Explanation>& explanations, ScoredRow& row);

}  // namespace stopline
