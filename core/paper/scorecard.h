// The scorecard compares our numbers with those of the paper, row by row of data/paper/targets.csv. Each row has a
// function that reads our answer from the measurements of one experiment. A row without such a function is open.
//
// Each section of the paper has a file sections/scorecard_section<N>.cpp with its experiments and row functions.
// scorecard.cpp joins the lists of experiments and of rows.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "figures/gnuplot.h"
#include "paper/measurements.h"
#include "paper/reductions.h"
#include "paper/verdict.h"

namespace stopline {

struct ScorecardOptions {
    std::string section;                // section whose rows are judged, with its subsections; empty: all
    std::filesystem::path folder;       // folder of the stored measurements
    std::vector<std::string> settings;  // overrides for every scenario, as for load_scenario
    Reductions reductions;              // parts of sweeps and scenarios to leave out
    int threads = 1;
    std::function<bool(double)> on_progress;  // gets the share of the current experiment; false: stop
    std::function<void(double)> on_stored;    // gets the share that a store already has; on_progress starts from it
    std::function<void(const std::string&)> on_message;  // gets a message for each experiment run or reused
};

// A measurement that several rows share.
struct Experiment {
    const char* name;      // name of its file of measurements, without .csv
    const char* scenario;  // file in scenarios/, without .yaml
    bool is_stored;        // false: it reads only files, or it stores its own runs
    Measurements (*measure)(const Scenario& scenario, const ScorecardOptions& options);
};

struct RowJudge {
    const char* id;          // id of the row
    const char* experiment;  // experiment that gives the answer
    // Returns nothing if the experiment did not measure the value. The row then stays open.
    std::optional<Answer> (*answer)(const Target& target, const Measurements& measurements);
};

std::span<const Experiment> experiments();
std::span<const RowJudge> row_judges();

// Throws std::logic_error for an unknown name.
const Experiment& experiment_named(const std::string& name);

// Returns the scenario of an experiment. Throws InputError as load_scenario does.
Scenario scenario_of(const Experiment& experiment, const ScorecardOptions& options);

struct ScoredRow {
    Target target;
    std::string ours;  // empty if there is no answer
    Verdict verdict = Verdict::open;
    std::string measured_as;  // how we measure the quantity
    std::string explanation;  // cause of a miss; empty for other rows
};

struct Scorecard {
    std::vector<ScoredRow> rows;
    std::map<std::string, std::uint64_t> scenario_hashes;  // by scenario name
    std::vector<Figure> figures;
    double violations = 0.0;  // overlaps, entries on red and lost vehicles in all runs
    int count(Verdict verdict) const;
};

// Runs what the rows need and judges them. Throws InputError for a section without rows, and Interrupted.
Scorecard make_scorecard(const ScorecardOptions& options);

// Judges the rows of a section (empty: all sections) with the given measurements, by experiment name. A row is open if
// its experiment is missing. Throws InputError for a section without rows.
Scorecard score(const std::string& section, const std::map<std::string, Measurements>& measured);

// Returns how the row is measured and, for a miss, its cause.
std::string explanation_text(const ScoredRow& row);

// Returns the columns id,section,paper,ours,unit,tolerance,verdict,explanation.
std::string scorecard_csv(const Scorecard& scorecard);

// A row of data/paper/explanations.csv.
struct Explanation {
    std::string measured_as;
    std::string explanation;  // cause of a miss
};
// Returns the explanations by row id.
std::map<std::string, Explanation> load_explanations(const std::filesystem::path& file);

// Returns the commands that repeat the runs of the rows with tables and figures, one for each section of the paper.
std::vector<std::string> commands_behind(const std::vector<ScoredRow>& rows);

// Adds the explanation to the row. A miss without one gets the text "Not explained yet."
void explain(const std::map<std::string, Explanation>& explanations, ScoredRow& row);

}  // namespace stopline
