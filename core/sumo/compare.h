// SUMO and the mesoscale mode on the same network, lights and vehicles (sumo/export.h): what both say, seed by seed.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "experiment/gnuplot.h"
#include "measure/confidence.h"
#include "scenario/scenario.h"
#include "sumo/facts.h"

namespace stopline {

struct ComparedRun {
    std::uint64_t seed = 0;
    RunFacts ours;
    RunFacts sumo;
    std::int64_t overlaps = 0;  // of ours; also all other violations
    double ours_took_s = 0.0;   // by the clock: from the first step to the last, ...
    double sumo_took_s = 0.0;   // ... and the whole program
};

struct ComparedMetric {
    std::string name;          // with its unit, as a column
    std::vector<double> ours;  // [run]
    std::vector<double> sumo;
    bool of_sumo_alone = false;  // ours has none of it by construction: not compared

    double difference_percent() const;  // of the means, of SUMO's; NaN: SUMO's is 0, or there is nothing to compare
    Interval band(Band kind) const;     // of SUMO's mean; three runs at least
};

struct Comparison {
    std::string note = {};  // what SUMO cannot do of this population
    std::string population;
    double from_s = 0.0;  // what is before is not compared
    double to_s = 0.0;
    std::vector<ComparedRun> runs = {};
    bool imported = false;       // both get the same planned departures, so that waiting outside can be compared
    bool has_stop_lines = true;  // that are counted

    std::vector<ComparedMetric> metrics() const;
};

struct CompareOptions {
    int repetitions = 3;   // seeds: the scenario's, + 1, + 2
    double from_s = -1.0;  // below 0: what the scenario measures
    std::function<bool(double)> on_progress;
};

// Imported networks: SUMO runs the scenario's own network with the vehicles that the import planned (sumo/imported.h); others: both run the
// vehicles that entered our run (sumo/inputs.h). Leaves the files of each seed in FOLDER/seed_N, and makes no folder for what is refused. Throws InputError where SUMO is missing or
// fails, Interrupted.
Comparison compare_with_sumo(const Scenario& scenario, std::size_t population, const std::filesystem::path& folder,
                             const CompareOptions& options);

std::string comparison_csv(const Comparison& comparison);
// By stop line: passages of both, mean of the seeds.
std::string stop_lines_csv(const Comparison& comparison);
// Over time: vehicles past all stop lines (if there are any), trips that have ended, and vehicles that stand; means of the seeds, with the
// band of SUMO's where there are several.
std::vector<Figure> comparison_figures(const Comparison& comparison, const std::string& title);

}  // namespace stopline
