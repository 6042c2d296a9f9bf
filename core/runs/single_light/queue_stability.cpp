#include "runs/single_light/queue_stability.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/containers/index.h"
#include "base/nan.h"
#include "spacing_laws/gap_policy.h"

namespace stopline {

namespace {

// Returns the policies of the components, ready for use.
std::vector<GapPolicy> policies_of(const Scenario& scenario, const PopulationSettings& population) {
    std::vector<GapPolicy> policies;
    for (const PopulationSettings::Component& component : population.components) {
        // load_scenario() has checked that the policy exists.
        policies.push_back(make_gap_policy(
            *std::find_if(scenario.policies.begin(), scenario.policies.end(),
                          [&](const GapPolicySettings& policy) { return policy.name == component.policy; })));
    }
    return policies;
}

double larger_of(double value, double other) { return std::isnan(value) ? other : std::max(value, other); }
double smaller_of(double value, double other) { return std::isnan(value) ? other : std::min(value, other); }

}  // namespace

QueueStability queue_stability(const Scenario& scenario, const PopulationSettings& population,
                               const std::vector<LinePassage>& line, const std::vector<TrajectoryPoint>& points,
                               double green_start_s) {
    QueueStability result{kNan, kNan, kNan, kNan};
    std::map<int, double> largest_mps2;           // vehicle -> largest absolute acceleration
    std::map<int, std::vector<int>> vehicles_of;  // lane -> vehicles in the order of their passages
    for (const LinePassage& passage : line) {
        vehicles_of[passage.lane].push_back(passage.vehicle);
        largest_mps2[passage.vehicle] = 0.0;
    }
    const std::vector<GapPolicy> policies = policies_of(scenario, population);
    for (const TrajectoryPoint& point : points) {
        const auto vehicle = largest_mps2.find(point.vehicle);
        if (vehicle == largest_mps2.end() || point.time_s < green_start_s) continue;
        vehicle->second = std::max(vehicle->second, std::abs(point.acceleration_mps2));
        // The first vehicle of a lane has no leader.
        if (std::isnan(point.net_gap_m)) continue;
        const double desired_m = equilibrium_gap_m(policies[at(point.policy)], point.speed_mps);
        result.gap_error_m = larger_of(result.gap_error_m, std::abs(point.net_gap_m - desired_m));
        result.smallest_gap_m = smaller_of(result.smallest_gap_m, point.net_gap_m);
    }
    for (const auto& [lane, vehicles] : vehicles_of) {
        for (std::size_t k = 1; k < vehicles.size(); ++k) {
            const double own_mps2 = largest_mps2[vehicles[k]];
            result.linf_ratio = larger_of(result.linf_ratio, own_mps2 / largest_mps2[vehicles[k - 1]]);
            result.linf_from_head = larger_of(result.linf_from_head, own_mps2 / largest_mps2[vehicles[0]]);
        }
    }
    return result;
}

}  // namespace stopline
