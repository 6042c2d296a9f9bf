// The experiment of Section III of the paper: a queue at one signal, one run for each population. The results are
// vehicles passed within a green time (Fig. 5), the improvement over the baseline (Fig. 6), steady-state headways
// beside those of the policies, and the start of the leader.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/counters.h"
#include "measure/headways.h"
#include "runs/run_populations.h"
#include "runs/single_light/platoon.h"

namespace stopline {

// Gaps and headways in steady state at the speed limit, downstream of the stop line. In a mixed population the mean of
// each policy is weighted with its share, so the result does not depend on which vehicles reach steady state.
struct SteadyFlow {
    int vehicles = 0;                // vehicles in steady state (platoon.h)
    double net_gap_m = 0.0;          // measured; NaN if a policy has no vehicle in steady state
    double headway_s = 0.0;          // measured; NaN as above
    double policy_gap_m = 0.0;       // gap of the policy at the limit
    double policy_headway_s = 0.0;   // (length + gap(limit)) / limit
    double deviation_percent = 0.0;  // deviation of the measured headway from that of the policy
};

struct QueueGaps {
    double mean_m = 0.0;
    double smallest_m = 0.0;
    double largest_m = 0.0;
};

struct PopulationSummary {
    std::string name;
    Counter counter{{}};                          // at the stop line, from the start of green
    std::vector<int> passed;                      // [green]
    std::vector<double> improvement_percent;      // [green]; NaN without a baseline
    double asymptotic_improvement_percent = 0.0;  // limit for long queues: ratio of the steady-state headways
    double emptied_s = 0.0;                       // passage of the last queued vehicle; NaN: not within the green
    Counter ideal{{}};                            // the same queue as an ideal platoon (ideal_platoon.h)
    std::vector<LinePassage> line;                // passages within the green
    LastPositionsFlow last_positions;             // the last ten queue positions of each lane
    SteadyFlow steady;
    LeaderStart leader;  // times from the start of green
    QueueGaps queue;     // net gaps at the start of green
};

struct SingleLightReport {
    Scenario scenario;
    std::vector<RunResult> runs;                 // [population] with trajectories around the green
    std::vector<PopulationSummary> populations;  // [population]
    std::optional<std::size_t> baseline;         // index of the baseline population
    double sample_interval_s = 0.0;              // time between the points that the summaries use

    // Returns the summary of a population; null if there is none of that name.
    const PopulationSummary* find(const std::string& population) const;
    // Returns the mean improvement of a population over the baseline, %; NaN without a baseline. The mean covers the
    // green times from `from_s` on, as long as both queues last and the signal is green.
    double mean_improvement_percent(const PopulationSummary& population, double from_s) const;
    // Returns the same mean for the ideal platoons.
    double ideal_improvement_percent(const PopulationSummary& population, double from_s) const;
    bool no_violations() const;
};

struct SingleLightOptions {
    int threads = 1;
    double trajectory_interval_s = 0.0;       // additional samples for a trajectory table; 0: none
    std::function<bool(double)> on_progress;  // see RunAllOptions
    Observation observation = {};
};

inline constexpr int kLastPositions = 10;
inline constexpr double kSampleInterval_s = 0.1;
// Trajectories are kept from kTrajectoryBefore_s before the green to kTrajectoryAfter_s after it. The last vehicles
// reach steady state within that time.
inline constexpr double kTrajectoryBefore_s = 5.0;
inline constexpr double kTrajectoryAfter_s = 25.0;

// Returns the points at whole multiples of `interval_s`. The interval is one step at least.
std::vector<TrajectoryPoint> thin_out(const std::vector<TrajectoryPoint>& points, double interval_s, double step_s);

// Returns the summary of one run. `points` are its trajectory around the green, sampled every `interval_s`. Comparisons
// with the baseline are not filled in.
PopulationSummary summary_of(const Scenario& scenario, std::size_t index, const RunResult& run,
                             const std::vector<TrajectoryPoint>& points, double interval_s);

// Runs all populations. Throws Interrupted if on_progress returns false.
SingleLightReport run_single_light(const Scenario& scenario, const SingleLightOptions& options = {});

}  // namespace stopline
