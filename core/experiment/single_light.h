// The experiment of Section III: a queue at one traffic light, one run for each population, and what is read from it -
// vehicles passed within a green time (Fig. 5), improvement over the baseline (Fig. 6), the headway that each spacing
// policy settles at beside its closed form, and how the leader starts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiment/platoon.h"
#include "experiment/run_populations.h"
#include "measure/counters.h"
#include "measure/headways.h"

namespace stopline {

// How vehicles follow each other once they have passed the line and drive at the limit, beside what their policy says. For a population of several
// policies each policy's mean is weighted with its share, so that a mix is comparable whatever vehicles have settled.
struct SettledFlow {
    int vehicles = 0;                // that have settled (platoon.h); the values below are NaN where a policy has none
    double net_gap_m = 0.0;          // measured
    double headway_s = 0.0;          // measured
    double policy_gap_m = 0.0;       // gap(limit)
    double policy_headway_s = 0.0;   // (length + gap(limit)) / limit
    double deviation_percent = 0.0;  // of the measured headway from the policy's
};

struct QueueGaps {
    double mean_m = 0.0;
    double smallest_m = 0.0;
    double largest_m = 0.0;
};

struct PopulationSummary {
    std::string name;
    Counter counter{{}};                      // at the stop line, from the start of green
    std::vector<int> passed;                  // [green]
    std::vector<double> improvement_percent;  // [green]; NaN without a baseline
    double asymptotic_improvement_percent =
        0.0;                 // ratio of the measured settled headways: where the improvement tends to
    double emptied_s = 0.0;  // time at which the last of the queue passed; NaN: not within the green
    Counter ideal{{}};       // of the same queue behind the same leader, were each gap kept exactly (ideal_platoon.h)
    std::vector<LinePassage> line;  // passages within the green
    LateFlow late;                  // the last ten positions of each lane, whatever their speed
    SettledFlow settled;
    LeaderStart leader;  // times from the start of green
    QueueGaps queue;     // net gaps at the start of green
};

struct SingleLight {
    Scenario scenario;
    std::vector<RunResult> runs;                 // [population]; with trajectories around the green
    std::vector<PopulationSummary> populations;  // [population]
    std::optional<std::size_t> baseline;         // index of the population that improvements refer to
    double sample_interval_s = 0.0;              // of the points that the summaries are made from, about 0.1 s

    const PopulationSummary* find(const std::string& population) const;
    // Of one population over the baseline, averaged over the green times from `from_s` on for as long as both queues last
    // and the light is green. NaN without a baseline.
    double mean_improvement_percent(const PopulationSummary& population, double from_s) const;
    // The same of the ideal platoons.
    double ideal_improvement_percent(const PopulationSummary& population, double from_s) const;
    bool no_violations() const;
};

struct SingleLightOptions {
    int threads = 1;
    double trajectory_interval_s = 0.0;       // finer samples, if wanted; those of the summaries are kept in any case
    std::function<bool(double)> on_progress;  // see RunAllOptions
    Observation observation = {};
};

inline constexpr int kLatePositions = 10;
inline constexpr double kSampleInterval_s = 0.1;
// Trajectories are kept from this before the green ...
inline constexpr double kLeadIn_s = 5.0;
// ... to this after it: enough for the last vehicles to settle, and no memory for what nobody looks at.
inline constexpr double kLeadOut_s = 25.0;

// The points at whole multiples of `interval_s` (of at least one step).
std::vector<TrajectoryPoint> thinned(const std::vector<TrajectoryPoint>& points, double interval_s, double step_s);

// The summary of one run from its points, sampled every `interval_s` from kLeadIn_s before the green to kLeadOut_s after it.
// What compares with a baseline is left out.
PopulationSummary summary_of(const Scenario& scenario, std::size_t index, const RunResult& run,
                             const std::vector<TrajectoryPoint>& points, double interval_s);

SingleLight run_single_light(const Scenario& scenario, const SingleLightOptions& options = {});

}  // namespace stopline
