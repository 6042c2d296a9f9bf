// What trajectories tell of a platoon: how its leader starts, and the gaps its vehicles keep once they drive at the limit.
#pragma once

#include <vector>

#include "experiment/run.h"

namespace stopline {

// Speeds count as the limit within this (Section III.B of the paper; free drivers approach the limit without end).
inline constexpr double kAtLimit_mps = 0.5 / 3.6;

// The points of one vehicle in order of time.
std::vector<TrajectoryPoint> points_of(const std::vector<TrajectoryPoint>& trajectory, int vehicle);

struct LeaderStart {
    double starts_s = 0.0;   // last sample at which it stands
    double reaches_s = 0.0;  // first sample after it within kAtLimit_mps of the limit; NaN: never
    double duration_s() const { return reaches_s - starts_s; }
};
// `points` are those of the leader, from a time at which it stands; times are as in the points.
LeaderStart leader_start(const std::vector<TrajectoryPoint>& points, double limit_mps);

// A vehicle that has settled behind another at the limit.
struct SettledVehicle {
    int vehicle = 0;
    int policy = 0;
    double net_gap_m = 0.0;
    double headway_s = 0.0;  // (length + net gap) / speed: time between two fronts at a fixed place
};
// One entry for each vehicle that at some time has driven within kAtLimit_mps of the limit for five seconds while its net gap
// changed by at most 0.1 m; the values are those at the last such time. Samples must be `interval_s` apart.
std::vector<SettledVehicle> settled_vehicles(const std::vector<TrajectoryPoint>& trajectory, double interval_s,
                                             double limit_mps, double length_m);

}  // namespace stopline
