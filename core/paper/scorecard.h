// The scorecard compares our numbers with the numbers of the paper, one row of data/paper/targets.csv at a time. It
// also has the rows of data/paper/own_rows.csv: results of ours that the paper does not have. A row function reads our
// answer to a row from the measurements of one experiment. A row without a function has the verdict 'open'.
//
// Each section of the paper has a file sections/scorecard_section<N>.cpp with its experiments and row functions. The
// own rows have a file for each subject. scorecard.cpp concatenates the lists of all files.
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
    std::string section;                // section, subsections included; empty: all sections
    std::filesystem::path folder;       // folder of the stored measurements
    std::vector<std::string> settings;  // overrides "PATH=VALUE" for every scenario
    Reductions reductions;              // for a quick run; empty: full experiments
    int threads = 1;
    // Receives the finished share of the current experiment, 0..1. The experiment stops if the function returns false.
    std::function<bool(double)> on_progress;
    // Receives the share of the current experiment whose runs are already stored. on_progress starts from this share.
    std::function<void(double)> on_stored;
    // Receives a message for each experiment. The message says whether the experiment is run, or its stored
    // measurements are reused.
    std::function<void(const std::string&)> on_message;
};

// Makes the measurements that one or more rows need, by simulation runs or from input files.
struct Experiment {
    const char* name;      // also the name of the CSV file with the measurements, without .csv
    const char* scenario;  // name of the scenario file in scenarios/, without .yaml
    // true: the scorecard stores the measurements in this CSV file; false: `measure` only reads files, or stores its
    // runs itself.
    bool is_stored;
    Measurements (*measure)(const Scenario& scenario, const ScorecardOptions& options);
};

// Row function: reads our answer to one row from the measurements of an experiment.
struct RowJudge {
    const char* id;          // id of the row
    const char* experiment;  // name of the experiment
    // Returns std::nullopt if the experiment did not measure the value. The verdict of the row is then 'open'.
    std::optional<Answer> (*answer)(const Target& target, const Measurements& measurements);
};

// Return the experiments and row functions of all sections.
std::span<const Experiment> experiments();
std::span<const RowJudge> row_judges();

// Returns an experiment by name. Throws std::logic_error for an unknown name.
const Experiment& experiment_named(const std::string& name);

// Loads the scenario of an experiment with the reductions and overrides of the options. Throws InputError if the file
// is invalid.
Scenario scenario_of(const Experiment& experiment, const ScorecardOptions& options);

struct ScoredRow {
    Target target;
    std::string ours;  // our value or answer as text; empty if not measured
    Verdict verdict = Verdict::open;
    std::string measured_as;  // how we measure the quantity
    std::string explanation;  // if the verdict is 'miss': why our value deviates; otherwise empty
};

struct Scorecard {
    std::vector<ScoredRow> rows;
    std::map<std::string, std::uint64_t> scenario_hashes;  // by scenario name
    std::vector<Figure> figures;
    // Number of violations, summed over all experiments: overlaps of vehicles, entries on red, and lost vehicles. Some
    // experiments count every violation. Other experiments count the runs that have violations.
    double violations = 0.0;
    // One warning for each column of explanations.csv that still has its name of the previous release.
    std::vector<std::string> warnings;
    int count(Verdict verdict) const;
};

// Runs the experiments that the rows of the section need, or loads their stored measurements, and judges the rows.
// Throws InputError for a section without rows. Throws Interrupted if on_progress returns false.
Scorecard make_scorecard(const ScorecardOptions& options);

// Judges the rows of a section, or all rows if `section` is empty. `measured` maps experiment names to measurements. A
// row whose experiment is missing has the verdict 'open'. Throws InputError for a section without rows.
Scorecard score(const std::string& section, const std::map<std::string, Measurements>& measured);

// Returns a text that says how the row is measured and, if the verdict is 'miss', why our value deviates.
std::string explanation_text(const ScoredRow& row);

// Returns the scorecard as CSV with the columns id,section,paper,ours,unit,tolerance,verdict,explanation.
std::string scorecard_csv(const Scorecard& scorecard);

// A row of data/paper/explanations.csv.
struct Explanation {
    std::string measured_as;  // how we measure the quantity
    std::string explanation;  // why our value deviates; used if the verdict is 'miss'
};
// Loads the explanations. Returns a map from row id to explanation. Sets `warnings` to one warning for each column of
// the file that still has its name of the previous release.
std::map<std::string, Explanation> load_explanations(const std::filesystem::path& file,
                                                     std::vector<std::string>& warnings);

// Returns the commands that repeat the runs behind `rows` and write their tables and figures. There is one command for
// each section of the paper, and for each part of Section VI. If sections share a command, it is listed once.
std::vector<std::string> commands_behind(const std::vector<ScoredRow>& rows);

// Sets row.measured_as and, if the verdict is 'miss', row.explanation. A miss without an explanation in the file gets
// the text "Not explained yet."
void explain(const std::map<std::string, Explanation>& explanations, ScoredRow& row);

}  // namespace stopline
