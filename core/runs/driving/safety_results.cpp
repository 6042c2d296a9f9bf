#include "runs/driving/safety_results.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"

namespace stopline {

void SafetyDistribution::add(double value) {
    const double bin = std::floor((value - axis_.from) / axis_.width);
    ++samples_[at(static_cast<int>(std::clamp(bin, 0.0, static_cast<double>(axis_.bins - 1))))];
    ++count_;
    smallest_ = std::min(smallest_, value);
    largest_ = std::max(largest_, value);
}

double SafetyDistribution::quantile(double share) const {
    if (count_ == 0) return kNan;
    const double wanted = share * static_cast<double>(count_);
    double below = 0.0;
    for (std::size_t bin = 0; bin < samples_.size(); ++bin) {
        const auto here = static_cast<double>(samples_[bin]);
        if (here > 0.0 && below + here >= wanted) {
            const double value = axis_.from + axis_.width * (static_cast<double>(bin) + (wanted - below) / here);
            return std::clamp(value, smallest_, largest_);
        }
        below += here;
    }
    return largest_;
}

double time_to_collision_s(const FollowingState& state) {
    const double closing_mps = state.speed_mps - state.leader_mps;
    if (closing_mps <= 0.0) return std::numeric_limits<double>::infinity();
    return std::max(state.net_gap_m, 0.0) / closing_mps;
}

double required_deceleration_mps2(const FollowingState& state) {
    constexpr double kSmallestGap_m = 0.01;  // avoids a division by 0 when bumpers touch
    const double gap_m = std::max(state.net_gap_m, kSmallestGap_m);
    const double closing_mps = state.speed_mps - state.leader_mps;
    const bool leader_brakes = state.leader_mps2 < 0.0 && state.leader_mps > 0.0;
    // The follower brakes to the speed of the leader within the gap.
    const double match_mps2 =
        closing_mps > 0.0 ? std::max(closing_mps * closing_mps / (2.0 * gap_m) - state.leader_mps2, 0.0) : 0.0;
    if (!leader_brakes) return match_mps2;
    // The leader may stop before the speeds are equal. The follower then stops behind the place where the leader stops.
    const double stop_s = state.leader_mps / -state.leader_mps2;
    const double equal_s = closing_mps > 0.0 ? 2.0 * gap_m / closing_mps : std::numeric_limits<double>::infinity();
    if (equal_s <= stop_s) return match_mps2;
    const double leader_stop_m = state.leader_mps * state.leader_mps / (2.0 * -state.leader_mps2);
    return state.speed_mps * state.speed_mps / (2.0 * (gap_m + leader_stop_m));
}

}  // namespace stopline
