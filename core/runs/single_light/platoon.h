// Evaluates the trajectories of a platoon: the start of its leader, and the steady-state gaps at the speed limit.
#pragma once

#include <vector>

#include "runs/run.h"

namespace stopline {

// A speed within this tolerance of the speed limit counts as equal to the limit (Section III.B of the paper), because a
// driver without leader approaches the limit asymptotically.
inline constexpr double kAtLimit_mps = 0.5 / 3.6;

// Returns the points of one vehicle in the order of time.
std::vector<TrajectoryPoint> points_of(const std::vector<TrajectoryPoint>& trajectory, int vehicle);

struct LeaderStart {
    double start_s = 0.0;  // time of the last sample at rest, before the limit is reached
    double limit_s = 0.0;  // time of the first later sample within kAtLimit_mps of the limit; NaN: none
    double duration_s() const { return limit_s - start_s; }
};
// Returns the start of the leader from its trajectory points. The leader must be at rest at the first point.
LeaderStart leader_start(const std::vector<TrajectoryPoint>& points, double limit_mps);

// A follower in steady state at the speed limit.
struct SteadyVehicle {
    int vehicle = 0;
    int policy = 0;  // index into PopulationSettings::components
    double net_gap_m = 0.0;
    double headway_s = 0.0;  // (length of the leader + net gap) / speed
};
// Returns the vehicles that reach steady state, with their values at the last sample in steady state. A vehicle is in
// steady state if, for five seconds, its speed was within kAtLimit_mps of `cruise_mps` and its net gap changed by 0.1 m
// or less. `cruise_mps` is the speed of a vehicle without leader. The samples must be `interval_s` apart.
std::vector<SteadyVehicle> steady_vehicles(const std::vector<TrajectoryPoint>& trajectory, double interval_s,
                                           double cruise_mps);
// Returns the vehicles that kept their net gap for five seconds at a speed of at least `cruise_mps` - kAtLimit_mps.
// There is no upper limit, because a vehicle that closes a gap drives faster than `cruise_mps`. The vehicles behind it
// follow at the same speed, with gaps that stay too large meanwhile.
std::vector<SteadyVehicle> cruising_vehicles(const std::vector<TrajectoryPoint>& trajectory, double interval_s,
                                             double cruise_mps);

// Returns true if a vehicle has reached the gap of its policy. The limit of 1.25 times this gap plus 0.5 m is far above
// all errors of the controllers, so a vehicle with a larger gap has not closed up yet.
inline bool has_closed_up(double net_gap_m, double policy_gap_m) { return net_gap_m <= 1.25 * policy_gap_m + 0.5; }

}  // namespace stopline
