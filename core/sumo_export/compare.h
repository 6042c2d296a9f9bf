// Runs SUMO and the mesoscale mode on the same network, signals and vehicles, and compares the results seed by seed.
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
    std::string name;          // name of the column, with its unit
    std::vector<double> ours;  // [run]
    std::vector<double> sumo;  // [run]
    bool sumo_only = false;    // our runs do not have this metric, so it is not compared

    // Returns the difference of our mean from SUMO's mean in percent, or NaN if it is undefined.
    double difference_percent() const;
    // Returns the confidence band of SUMO's mean. Needs at least three runs for the paper's band, two for Student's.
    Interval band(Band kind) const;
};

struct Comparison {
    std::string note = {};  // features of the population that SUMO lacks
    std::string population;
    double from_s = 0.0;  // start of the compared time
    double to_s = 0.0;
    std::vector<ComparedRun> runs = {};
    bool imported = false;       // both programs have the same planned departures, so departure delays are comparable
    bool has_stop_lines = true;  // passages of stop lines are counted

    std::vector<ComparedMetric> metrics() const;
};

struct CompareOptions {
    int repetitions = 3;   // number of runs; run k has the scenario's seed + k
    double from_s = -1.0;  // start of the compared time; below 0: the time that the scenario measures
    std::function<bool(double)> on_progress;  // gets the share done; returns false to stop
};

// Runs both programs. On an imported network SUMO runs the scenario's own network with the planned vehicles
// (imported.h). On other networks SUMO gets the vehicles that entered our run (inputs.h). The files of each seed stay
// in FOLDER/seed_N. Throws InputError if SUMO is missing or fails, and Interrupted. A comparison that is rejected
// creates no folder.
Comparison compare_with_sumo(const Scenario& scenario, std::size_t population, const std::filesystem::path& folder,
                             const CompareOptions& options);

std::string comparison_csv(const Comparison& comparison);
// Returns the mean number of passages of every stop line in both programs as CSV.
std::string stop_lines_csv(const Comparison& comparison);
// Returns figures over time: cumulative passages of stop lines (if counted), cumulative completed trips, and stopped
// vehicles. They show means of the seeds, and the confidence band of SUMO's mean if there are several seeds.
std::vector<Figure> comparison_figures(const Comparison& comparison, const std::string& title);

}  // namespace stopline
