// Evaluates the trajectories of a platoon: the start of its leader, and the gaps at the speed limit.
#pragma once

#include <vector>

#include "runs/run.h"

namespace stopline {

// Tolerance of the speed limit (Section III.B of the paper). A free driver approaches the limit asymptotically.
inline constexpr double kAtLimit_mps = 0.5 / 3.6;

// Returns the points of one vehicle in the order of time.
std::vector<TrajectoryPoint> points_of(const std::vector<TrajectoryPoint>& trajectory, int vehicle);

struct LeaderStart {
    double start_s = 0.0;  // last sample at rest
    double limit_s = 0.0;  // first sample after it within kAtLimit_mps of the limit; NaN: never
    double duration_s() const { return limit_s - start_s; }
};
// Evaluates the points of the leader. The first point must be at rest.
LeaderStart leader_start(const std::vector<TrajectoryPoint>& points, double limit_mps);

// A vehicle that follows another one in steady state at the speed limit.
struct SteadyVehicle {
    int vehicle = 0;
    int policy = 0;
    double net_gap_m = 0.0;
    double headway_s = 0.0;  // (length + net gap) / speed
};
// Returns the vehicles that reach steady state, each at its last such time. A vehicle is in steady state if it has
// driven within kAtLimit_mps of the limit for five seconds and its net gap has changed by 0.1 m or less. The samples
// must be `interval_s` apart.
std::vector<SteadyVehicle> steady_vehicles(const std::vector<TrajectoryPoint>& trajectory, double interval_s,
                                           double limit_mps, double length_m);

}  // namespace stopline
