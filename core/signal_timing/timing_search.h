// Searches green times and offsets by simulation: a plain grid around the start values of one population, with several
// seeds. The runs are those of a sweep, so its store keeps each finished run, and a killed search continues.
//
// The objective of a run is measured over its last three quarters. The delay counts all vehicles in the network and
// those that wait to enter it: per vehicle, the time in which it does not move at the speed limit of its lane.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "measure/confidence.h"
#include "runs/run_metrics.h"
#include "signal_timing/signal_timing.h"
#include "sweeps/sweep_run.h"

namespace stopline {

// Length of a run if the scenario has none (duration 0 s).
inline constexpr double kSearchDuration_s = 2700.0;

enum class Objective { delay, throughput };

struct SearchOptions {
    std::vector<std::string> overrides;            // from --set
    std::string file;                              // path of the scenario
    std::vector<std::string> populations_in_file;  // other names of populations are those of policies
    int seeds = 3;
    int greens = 5;      // number of values of each green
    int offsets = 6;     // number of offsets in a network of several intersections
    double range = 1.6;  // largest green over the start value, and the start value over the smallest green
    Objective objective = Objective::delay;
};

// Runs one population and returns delay and throughput, and the counts of violations. A RunFunction of the sweep.
std::vector<RunMetric> timing_metrics(const Scenario& scenario, std::size_t population,
                                      const std::function<bool()>& keep_going);

// Returns the values of a green in the search: `count` whole seconds from start / range to start x range at equal
// ratios. Values below `shortest_s` and repeated values are left out; the start value is always in the list.
std::vector<double> searched_greens_s(double start_s, double shortest_s, int count, double range);
// Returns the offsets in the search: `count` whole seconds at equal distances within a cycle, and the start value.
std::vector<double> searched_offsets_s(double start_s, double cycle_s, int count);

// Returns the sweep of the search for one population.
SweepSettings search_settings(const Scenario& scenario, const PopulationTiming& start, const SearchOptions& options,
                              const TimingOptions& timing);
// Returns the overrides of the sweep: those of the options, except the fields that the search varies or sets itself.
std::vector<std::string> search_overrides(const Scenario& scenario, const std::string& population,
                                          const SearchOptions& options);

// One setting of the search, with the results of all seeds in ascending order of the seed.
struct SearchedTimes {
    SignalTimes times;
    double cycle_s = 0.0;
    std::vector<double> delay_s;           // [seed]
    std::vector<double> throughput_veh_h;  // [seed]

    const std::vector<double>& values(Objective objective) const {
        return objective == Objective::delay ? delay_s : throughput_veh_h;
    }
};

struct TimingSearch {
    std::string population;
    Objective objective = Objective::delay;
    std::vector<SearchedTimes> all;  // in the order of the sweep
    std::size_t start = 0;           // index of the start values
    std::vector<std::size_t> best;   // all settings, the best one first; equal settings in the order of the sweep
};

// Returns the results of a finished search from the table of its sweep (sweeps/sweep_results.h).
TimingSearch search_results(const Scenario& scenario, const std::string& csv, const PopulationTiming& start,
                            Objective objective);

// A mean with its 95 % confidence interval; the bounds are NaN for fewer than two seeds.
struct MeanInterval {
    double mean = 0.0;
    Interval interval;
};
MeanInterval mean_interval(const std::vector<double>& values);
// Returns the difference of a setting to the start values, paired by seed.
MeanInterval difference_to_start(const TimingSearch& search, std::size_t setting);

// Returns true if the best setting has the longest or shortest green of a search with several values of it, so that a
// setting beyond may be better. The shortest green that is allowed is no border.
bool is_best_at_border(const TimingSearch& search, const std::array<double, kTimingStages>& shortest_s);

// Returns search.csv, with one row for each population and setting.
std::string search_csv(const std::vector<TimingSearch>& searches);

}  // namespace stopline
