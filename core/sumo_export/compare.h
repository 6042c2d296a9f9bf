// Runs SUMO and the mesoscale mode of Stopline with the same network, signals and vehicles, and compares the results
// for each seed. The words 'ours' and 'our run' refer to the run of Stopline.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "figures/gnuplot.h"
#include "measure/confidence.h"
#include "scenario/scenario.h"
#include "sumo_export/facts.h"

namespace stopline {

struct ComparedRun {
    std::uint64_t seed = 0;
    RunFacts ours;
    RunFacts sumo;
    std::int64_t violations = 0;  // violations of all kinds in our run
    double ours_wall_s = 0.0;     // wall-clock time of our run, from the first step to the last
    double sumo_wall_s = 0.0;     // wall-clock time of SUMO, from program start to end
};

struct ComparedMetric {
    std::string name;          // name in the tables, with its unit
    std::vector<double> ours;  // [run] value of the metric in our run
    std::vector<double> sumo;  // [run] value of the metric in SUMO's run
    bool sumo_only = false;    // only SUMO's runs have this metric, so there is nothing to compare

    // Returns by how many percent our mean exceeds SUMO's mean. Returns NaN if `sumo_only` is set or SUMO's mean is 0.
    double difference_percent() const;
    // Returns the 95 % confidence interval of SUMO's mean. Band::paper (the formula of the paper) needs at least three
    // runs, and Band::student (the usual formula) at least two.
    Interval band(Band kind) const;
};

struct Comparison {
    std::string note = {};  // sentence for the user if the population uses a model that SUMO lacks, else ""
    std::string population;
    double from_s = 0.0;  // start of the compared period
    double to_s = 0.0;    // end of the compared period
    std::vector<ComparedRun> runs = {};
    bool imported = false;       // the network is imported, so both programs have the same planned departures
    bool has_stop_lines = true;  // the network has stop lines with a signal, at which passages are counted

    std::vector<ComparedMetric> metrics() const;
};

struct CompareOptions {
    int repetitions = 3;           // number of runs; run k, counted from 0, has the scenario's seed + k
    double from_s = -1.0;          // start of the compared period; < 0: start of the scenario's measured period
    double sumo_limit_s = 1800.0;  // longest wall-clock time of one run of SUMO
    std::function<bool(double)> on_progress;  // gets the finished share of the work, 0 .. 1; returns false to stop
};

// Runs both programs. On an imported network, SUMO runs the network file of the scenario with the planned vehicles
// (imported.h). On other networks, SUMO gets the vehicles that entered our run (inputs.h). The files of each seed stay
// in FOLDER/seed_N. Throws InputError if SUMO is missing, fails or exceeds its time limit. Throws Interrupted if
// on_progress returns false. If the comparison is rejected before a file is written, no new folder remains.
Comparison compare_with_sumo(const Scenario& scenario, std::size_t population, const std::filesystem::path& folder,
                             const CompareOptions& options);

// Returns all metrics of all runs as CSV.
std::string comparison_csv(const Comparison& comparison);
// Returns, for every stop line, the mean number of passages in our runs and in SUMO's runs as CSV.
std::string stop_lines_csv(const Comparison& comparison);
// Returns figures over time: cumulative passages of stop lines (if counted), cumulative completed trips, and stopped
// vehicles. The curves are means over the seeds. With several seeds, the figures also show the confidence band of
// SUMO's mean.
std::vector<Figure> comparison_figures(const Comparison& comparison, const std::string& title);

}  // namespace stopline
