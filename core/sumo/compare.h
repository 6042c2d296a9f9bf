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
    std::vector<ComparedRun> runs;

    std::vector<ComparedMetric> metrics() const;
};

struct CompareOptions {
    int repetitions = 3;   // seeds: the scenario's, + 1, + 2
    double from_s = -1.0;  // below 0: what the scenario measures
    std::function<bool(double)> on_progress;
};

// Leaves the files of each seed in FOLDER/seed_N, and makes no folder for what is refused. Throws InputError where SUMO is missing or
// fails, Interrupted.
Comparison compare_with_sumo(const Scenario& scenario, std::size_t population, const std::filesystem::path& folder,
                             const CompareOptions& options);

std::string comparison_csv(const Comparison& comparison);
// By stop line: passages of both, mean of the seeds.
std::string stop_lines_csv(const Comparison& comparison);
// Vehicles past all stop lines and vehicles that stand, over time, of the first seed.
std::vector<Figure> comparison_figures(const Comparison& comparison, const std::string& title);

}  // namespace stopline
