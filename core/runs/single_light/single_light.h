// The experiment of Section III of the paper: a queue at one signal, with one run for each population. The results are
// the number of vehicles that pass within a green time (Fig. 5), the improvement over the baseline (Fig. 6), the
// steady-state headways compared with the policies, and the start of the leader.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/counters.h"
#include "measure/headways.h"
#include "runs/run_populations.h"
#include "runs/single_light/platoon.h"

namespace stopline {

// Mean gaps and headways in steady state at the cruise speed, downstream of the stop line. In a mixed population the
// mean of each policy is weighted with the share of the policy, so the mean does not depend on which vehicles reach
// steady state. Vehicles that have not closed up (platoon.h) are counted apart.
struct SteadyFlow {
    int vehicles = 0;                // number of vehicles that reach steady state and have closed up
    double net_gap_m = 0.0;          // simulated net gap; NaN if a policy has no vehicle in steady state
    double headway_s = 0.0;          // simulated headway; NaN if net_gap_m is NaN
    double policy_gap_m = 0.0;       // net gap that the policy prescribes at the cruise speed
    double policy_headway_s = 0.0;   // headway of the policy at the cruise speed: (length + net gap) / speed
    double deviation_percent = 0.0;  // deviation of headway_s from policy_headway_s
    int not_closed_up = 0;           // number of vehicles with a steady gap that have not closed up
    double open_gap_m = 0.0;         // mean net gap of the vehicles in not_closed_up; NaN if there are none
};

// Returns the cruise speed: the speed of a vehicle without leader on the road of a single light. In full dynamics, this
// is the speed limit. In the mesoscale mode, it is the speed limit times calibrated factors.
double cruise_speed_mps(const Scenario& scenario);

// Net gaps in a queue. All are NaN without followers. A vehicle has closed up if its net gap exceeds its own standstill
// gap by 1 m or less.
struct QueueGaps {
    double mean_m = 0.0;
    double smallest_m = 0.0;
    double largest_m = 0.0;
    double largest_open_m = 0.0;  // largest gap of the vehicles that have not closed up; NaN: all have
};

// Growth of accelerations along the queue after the start of green, for the vehicles that pass the stop line within the
// green. All values are NaN unless measure.string_stability is on and a lane has at least one follower.
struct QueueStability {
    double linf_ratio = 0.0;      // largest ratio of a vehicle's largest acceleration to that of its leader
    double linf_from_head = 0.0;  // the same, compared with the first vehicle of the lane
    double gap_error_m = 0.0;     // largest absolute difference between net gap and spacing policy
    double smallest_gap_m = 0.0;
};

struct PopulationSummary {
    std::string name;
    Counter counter{{}};                          // counts vehicles that pass the stop line, from the start of green on
    std::vector<int> passed;                      // [green] vehicles that pass within this green time (measure.green)
    std::vector<double> improvement_percent;      // [green] improvement over the baseline; NaN without a baseline
    double asymptotic_improvement_percent = 0.0;  // improvement for very long queues, from the steady-state headways
    double emptied_s = 0.0;                       // when the last queued vehicle passes; NaN: not within the green
    Counter ideal{{}};                            // like `counter`, for ideal platoons (ideal_platoon.h)
    std::vector<LinePassage> line;                // passages of the stop line within the green
    LastPositionsFlow last_positions;             // flow over the last kLastPositions queue positions of each lane
    SteadyFlow steady;
    LeaderStart leader;  // start of the leader on the first lane; times count from the start of green
    QueueGaps queue;     // net gaps in the queue at the start of green
    QueueStability stability;
};

struct SingleLightReport {
    Scenario scenario;
    std::vector<RunResult> runs;                 // [population] each with trajectories around the green
    std::vector<PopulationSummary> populations;  // in the order of scenario.populations
    std::optional<std::size_t> baseline;         // index of the baseline in `populations`
    double sample_interval_s = 0.0;              // time between the trajectory points that the summaries use

    // Returns the summary of the population with this name; null if there is none.
    const PopulationSummary* find(const std::string& population) const;
    // Returns the mean improvement of a population over the baseline, %; NaN without a baseline. The mean covers the
    // time from `from_s` until one of the two queues has passed the stop line, at most until the end of green.
    double mean_improvement_percent(const PopulationSummary& population, double from_s) const;
    // Returns the mean improvement like mean_improvement_percent(), but for ideal platoons.
    double ideal_improvement_percent(const PopulationSummary& population, double from_s) const;
    bool no_violations() const;
};

struct SingleLightOptions {
    int threads = 1;
    double trajectory_interval_s = 0.0;       // sampling interval for a trajectory table; 0: no table
    std::function<bool(double)> on_progress;  // gets the completed share, 0 .. 1; returns false to stop
    Observation observation = {};
};

inline constexpr int kLastPositions = 10;
inline constexpr double kSampleInterval_s = 0.1;
// Trajectories are kept from kTrajectoryBefore_s before the green to kTrajectoryAfter_s after it. This is long enough
// for the last queued vehicles to reach steady state.
inline constexpr double kTrajectoryBefore_s = 5.0;
inline constexpr double kTrajectoryAfter_s = 25.0;

// Rounds `interval_s` to a whole number of steps, at least one. Returns the points whose time is a multiple of the
// rounded interval.
std::vector<TrajectoryPoint> thin_out(const std::vector<TrajectoryPoint>& points, double interval_s, double step_s);

// Returns the summary of the run of scenario.populations[index]. `points` are the trajectories around the green,
// sampled every `interval_s`. The improvements over the baseline are not set.
PopulationSummary summary_of(const Scenario& scenario, std::size_t index, const RunResult& run,
                             const std::vector<TrajectoryPoint>& points, double interval_s);

// Runs all populations. Throws Interrupted if on_progress returns false.
SingleLightReport run_single_light(const Scenario& scenario, const SingleLightOptions& options = {});

}  // namespace stopline
