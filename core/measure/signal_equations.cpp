#include "measure/signal_equations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <fmt/format.h>

#include "base/input_error.h"

namespace stopline {

double flow_ratio(double demand_veh_h, double saturation_flow_veh_h) {
    if (!(saturation_flow_veh_h > 0.0)) throw InputError("a flow ratio needs a saturation flow above 0");
    return demand_veh_h / saturation_flow_veh_h;
}

double webster_cycle_s(double lost_time_s, double flow_ratio_sum) {
    if (!(flow_ratio_sum < kMaxFlowRatioSum)) {
        throw InputError(fmt::format("the critical flow ratios sum to {:.3f}; a cycle exists only below {}",
                                     flow_ratio_sum, kMaxFlowRatioSum));
    }
    return (1.5 * lost_time_s + 5.0) / (1.0 - flow_ratio_sum);
}

std::vector<double> effective_greens_s(double cycle_s, double lost_time_s, std::span<const double> flow_ratios) {
    const double sum = std::accumulate(flow_ratios.begin(), flow_ratios.end(), 0.0);
    const double green_s = cycle_s - lost_time_s;
    std::vector<double> greens_s;
    for (const double ratio : flow_ratios) {
        const double share = sum > 0.0 ? ratio / sum : 1.0 / static_cast<double>(flow_ratios.size());
        greens_s.push_back(share * green_s);
    }
    return greens_s;
}

double pedestrian_green_s(double crossing_m, double yellow_s, double all_red_s) {
    constexpr double kWalk_s = 7.0;
    constexpr double kWalking_mps = 1.07;
    return kWalk_s + std::max(crossing_m / kWalking_mps - yellow_s - all_red_s, 0.0);
}

double capacity_veh_h(double saturation_flow_veh_h, double effective_green_s, double cycle_s) {
    return saturation_flow_veh_h * effective_green_s / cycle_s;
}

double uniform_delay_s(double cycle_s, double effective_green_s, double saturation) {
    const double share = effective_green_s / cycle_s;
    if (share >= 1.0) return 0.0;
    return 0.5 * cycle_s * (1.0 - share) * (1.0 - share) / (1.0 - std::min(1.0, saturation) * share);
}

double incremental_delay_s(double saturation, double capacity_veh_h, double period_h, double k, double variance_i) {
    const double excess = saturation - 1.0;
    const double random = 8.0 * k * variance_i * saturation / (capacity_veh_h * period_h);
    return 900.0 * period_h * (excess + std::sqrt(excess * excess + random));
}

double initial_queue_delay_s(double queue_veh, double volume_veh_h, double capacity_veh_h, double period_h) {
    if (!(queue_veh > 0.0)) return 0.0;
    const double spare_veh_h = std::max(capacity_veh_h - volume_veh_h, 0.0);
    const double clears_h = spare_veh_h > 0.0 ? std::min(queue_veh / spare_veh_h, period_h) : period_h;
    const double mean_queue_veh = clears_h / period_h * (queue_veh - 0.5 * clears_h * spare_veh_h);
    return 3600.0 * mean_queue_veh / capacity_veh_h;
}

double BackOfQueue::first_term_veh() const {
    const double share = effective_green_s / cycle_s;
    if (share >= 1.0) return 0.0;
    const double saturation = std::min(1.0, volume_veh_h / capacity_veh_h);
    return volume_veh_h / 3600.0 * cycle_s * (1.0 - share) / (1.0 - saturation * share);
}

double BackOfQueue::percentile_veh(double z) const {
    constexpr double kMaxFactor = 1.8;
    const double mean_veh = first_term_veh() + second_term_veh();
    if (!(mean_veh > 0.0)) return mean_veh + third_term_veh();
    const double saturation = volume_veh_h / capacity_veh_h;
    double factor = 1.0 + z / std::sqrt(mean_veh);
    if (saturation >= 1.0 && z > 0.0) {
        const double share = effective_green_s / cycle_s;
        factor += 0.6 * std::pow(z, 0.24) * std::pow(share, 0.33) * (1.0 - std::exp(2.0 - 2.0 * saturation));
    }
    return mean_veh * std::min(kMaxFactor, factor) + third_term_veh();
}

char level_of_service(double control_delay_s, double saturation) {
    constexpr std::array<double, 5> kLongest_s{10.0, 20.0, 35.0, 55.0, 80.0};  // of the levels A to E
    if (saturation > 1.0) return 'F';
    const auto level = std::lower_bound(kLongest_s.begin(), kLongest_s.end(), control_delay_s) - kLongest_s.begin();
    return static_cast<char>('A' + level);
}

}  // namespace stopline
