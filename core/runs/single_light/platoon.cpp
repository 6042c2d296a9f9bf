#include "runs/single_light/platoon.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>

#include "base/nan.h"

namespace stopline {

namespace {

constexpr double kSteadyTime_s = 5.0;
constexpr double kSteadyGapChange_m = 0.1;

// A range of speeds, both ends included.
struct SpeedRange {
    double low_mps;
    double high_mps;
    bool contains(double speed_mps) const { return speed_mps >= low_mps && speed_mps <= high_mps; }
};

// Returns the last steady sample of a vehicle, or null if there is none. A sample is steady if the speed was in the
// range for kSteadyTime_s, and the net gap at both ends of this time differs by at most kSteadyGapChange_m.
const TrajectoryPoint* last_steady_point(std::span<const TrajectoryPoint> points, double interval_s,
                                         const SpeedRange& range) {
    const auto window = static_cast<std::size_t>(std::lround(kSteadyTime_s / interval_s));
    const TrajectoryPoint* last = nullptr;
    std::size_t steady = 0;  // number of successive samples in the range
    for (std::size_t k = 0; k < points.size(); ++k) {
        steady = range.contains(points[k].speed_mps) ? steady + 1 : 0;
        if (steady <= window) continue;
        // Without a leader the net gap is NaN and the comparison is false.
        if (std::abs(points[k].net_gap_m - points[k - window].net_gap_m) <= kSteadyGapChange_m) last = &points[k];
    }
    return last;
}

// Returns the vehicles that have a steady sample, with their values at the last steady sample.
std::vector<SteadyVehicle> vehicles_in_range(const std::vector<TrajectoryPoint>& trajectory, double interval_s,
                                             const SpeedRange& range) {
    std::vector<TrajectoryPoint> points = trajectory;
    std::stable_sort(points.begin(), points.end(),
                     [](const TrajectoryPoint& a, const TrajectoryPoint& b) { return a.vehicle < b.vehicle; });
    std::vector<SteadyVehicle> steady;
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
        while (end < points.size() && points[end].vehicle == points[begin].vehicle) ++end;
        const TrajectoryPoint* const last = last_steady_point({&points[begin], end - begin}, interval_s, range);
        if (last == nullptr) continue;
        steady.push_back({last->vehicle, last->policy, last->net_gap_m,
                          (last->leader_length_m + last->net_gap_m) / last->speed_mps});
    }
    return steady;
}

}  // namespace

std::vector<TrajectoryPoint> points_of(const std::vector<TrajectoryPoint>& trajectory, int vehicle) {
    std::vector<TrajectoryPoint> points;
    std::copy_if(trajectory.begin(), trajectory.end(), std::back_inserter(points),
                 [&](const TrajectoryPoint& point) { return point.vehicle == vehicle; });
    return points;
}

LeaderStart leader_start(const std::vector<TrajectoryPoint>& points, double limit_mps) {
    constexpr double kAtRest_mps = 0.01;
    LeaderStart start{kNan, kNan};
    for (const TrajectoryPoint& point : points) {
        if (point.speed_mps < kAtRest_mps) {
            start.start_s = point.time_s;
        } else if (point.speed_mps >= limit_mps - kAtLimit_mps) {
            start.limit_s = point.time_s;
            break;
        }
    }
    return start;
}

std::vector<SteadyVehicle> steady_vehicles(const std::vector<TrajectoryPoint>& trajectory, double interval_s,
                                           double cruise_mps) {
    return vehicles_in_range(trajectory, interval_s, {cruise_mps - kAtLimit_mps, cruise_mps + kAtLimit_mps});
}

std::vector<SteadyVehicle> cruising_vehicles(const std::vector<TrajectoryPoint>& trajectory, double interval_s,
                                             double cruise_mps) {
    constexpr double kAny_mps = std::numeric_limits<double>::max();
    return vehicles_in_range(trajectory, interval_s, {cruise_mps - kAtLimit_mps, kAny_mps});
}

}  // namespace stopline
