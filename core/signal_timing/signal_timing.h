// Start values of the signal of an intersection or a grid, from its demand and the measured saturation flow of each
// population: Webster's cycle and greens, and the capacity, delay and level of service that the HCM predicts for them.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "signal_timing/saturation_run.h"

namespace stopline {

// The settings of the section `signal` that a timing sets.
struct SignalTimes {
    StageGreens green_s{};  // signal.green and signal.cross_green
    double offset_s = 0.0;  // signal.offset; 0 for a single intersection

    bool operator==(const SignalTimes&) const = default;
};

// The lanes of a stage that have the same place in their approach. The demand is that of the lane with the most demand.
struct LaneTiming {
    LaneDemand demand;
    double saturation_flow_veh_h = 0.0;
    double capacity_variance_ratio = 0.0;  // LaneSaturation::capacity_variance_ratio
    double flow_ratio = 0.0;
    bool is_critical = false;  // the highest flow ratio of its stage
    // The values below are NaN if the demand is too high for a timing.
    double capacity_veh_h = 0.0;
    double saturation = 0.0;  // degree of saturation: demand / capacity
    double uniform_delay_s = 0.0;
    double incremental_delay_s = 0.0;

    double delay_s() const { return uniform_delay_s + incremental_delay_s; }
};

struct PopulationTiming {
    Saturation saturation;
    std::vector<LaneTiming> lanes;  // by stage, then from the left
    std::array<double, kTimingStages> critical_ratio{};
    std::array<double, kTimingStages> lost_time_s{};  // of each stage in each cycle
    double flow_ratio_sum = 0.0;
    double webster_cycle_s = 0.0;  // before rounding and minimum greens
    SignalTimes times;
    double cycle_s = 0.0;
    double delay_s = 0.0;      // mean over all vehicles
    bool greens_agree = true;  // false: the last measurement had other greens than the times

    bool is_oversaturated() const;  // no timing serves the demand; all times are NaN
    double highest_saturation() const;
};

struct TimingOptions {
    int threads = 1;
    double min_green_s = 5.0;
    bool pedestrians = false;                 // greens are long enough for pedestrians who cross the other street
    std::function<bool(double)> on_progress;  // gets the completed share, 0 .. 1; returns false to stop
};

// Throws InputError if the scenario has no start values: another kind of network or demand, phases or a controller that
// reacts to traffic. The message begins with the place of the field in `file` or in `overrides`.
void check_timing_scenario(const Scenario& scenario, const std::string& file,
                           const std::vector<std::string>& overrides);

// Returns the shortest greens that the options allow, in whole seconds.
std::array<double, kTimingStages> shortest_greens_s(const Scenario& scenario, const TimingOptions& options);

// Returns the timing for the demand and a measured saturation. Greens and offset are whole seconds.
PopulationTiming timing_of(const Scenario& scenario, const std::vector<LaneDemand>& demands,
                           const Saturation& saturation, const TimingOptions& options);

// Measures all populations at the same time in threads, and returns their timings. The measurement of a population is
// repeated with the greens of its timing until both agree within a second, but at most eight times. Results are the
// same to the bit for any number of threads. Throws Interrupted if on_progress returns false.
std::vector<PopulationTiming> time_signals(const Scenario& scenario, const TimingOptions& options);

// Returns a text that says which flow ratios are too high. The timing is oversaturated.
std::string oversaturation_text(const PopulationTiming& timing);

// Return the values for --set, such as "signal.green=17 s", and the section `signal` as YAML text.
std::vector<std::string> timing_overrides(const Scenario& scenario, const SignalTimes& times);
std::string timing_yaml(const Scenario& scenario, const SignalTimes& times);

// These functions return the result tables as CSV text. scenarios/COLUMNS.md explains the columns.
std::string timing_csv(const Scenario& scenario, const std::vector<PopulationTiming>& timings);  // timing.csv
std::string timing_lanes_csv(const std::vector<PopulationTiming>& timings);                      // lanes.csv

}  // namespace stopline
