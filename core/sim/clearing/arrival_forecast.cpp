#include "sim/clearing/arrival_forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "signals/signal_controller.h"

namespace stopline {

double travel_time_s(double distance_m, double speed_mps, double acceleration_mps2, double limit_mps) {
    if (distance_m <= 0.0) return 0.0;
    const double top_mps = std::max(limit_mps, speed_mps);
    const double ramp_m = 0.5 * (square(top_mps) - square(speed_mps)) / acceleration_mps2;
    if (distance_m < ramp_m) {
        return (std::sqrt(square(speed_mps) + 2.0 * acceleration_mps2 * distance_m) - speed_mps) / acceleration_mps2;
    }
    return (top_mps - speed_mps) / acceleration_mps2 + (distance_m - ramp_m) / top_mps;
}

double ArrivalForecast::next_s(int slot) {
    const VehicleArrays& v = state_.vehicles;
    const LanePlan& plan = state_.plan.lane(lane_);
    const int policy = v.policy[at(slot)];
    const ClearingPolicy& forecast = state_.clearing.policies[at(policy)];
    const double free_mps = model_.leader_speed_share * state_.plan.free_speed_mps(lane_, policy);
    const double distance_m = plan.stop_line_m - v.position_m[at(slot)];
    double arrival_s = travel_time_s(distance_m, v.speed_mps[at(slot)], forecast.acceleration_mps2, free_mps);
    const int next = v.next_lane[at(slot)];
    const double entry_mps = next >= 0 ? state_.plan.entry_speed_mps(next) : free_mps;
    if (entry_mps < free_mps && distance_m > 0.0) {
        // The vehicle slows down for its turn. This is the loss of time if it brakes from its free speed.
        const double deceleration_mps2 = model_.driver_of(policy).tables.deceleration_mps2;
        arrival_s += 0.5 * square(free_mps - entry_mps) / (deceleration_mps2 * free_mps);
    }
    if (previous_s_ >= 0.0 && distance_m > 0.0) {
        const double space_m = previous_length_m_ + static_cast<double>(v.standstill_gap_m[at(slot)]);
        arrival_s = std::max(arrival_s, previous_s_ + space_m / discharge_mps_ + forecast.time_gap_s);
        // The vehicles behind a turning one accelerate again.
        discharge_mps_ = std::sqrt(square(discharge_mps_) + 2.0 * forecast.acceleration_mps2 * space_m);
    }
    discharge_mps_ = std::min({discharge_mps_, free_mps, entry_mps});
    previous_s_ = arrival_s;
    previous_length_m_ = static_cast<double>(v.length_m[at(slot)]);
    return arrival_s;
}

double remaining_green_s(const Model& model, const State& state, int group) {
    if (group < 0) return std::numeric_limits<double>::max();
    if (state.signals.lights[at(group)] != Light::green) return 0.0;
    if (!model.signals.plan_of(group).controller->follows_programme) return 0.0;
    return model.time_s(model.signals.programme(group).next_change_tick(state.tick) - state.tick);
}

double next_green_duration_s(const Model& model, const State& state, int group) {
    constexpr int kMaxStages = 8;
    const GroupProgramme& programme = model.signals.programme(group);
    std::int64_t begin = state.tick;
    for (int k = 0; k < kMaxStages; ++k) {
        begin = programme.next_change_tick(begin);
        if (begin == std::numeric_limits<std::int64_t>::max()) return 0.0;
        if (programme.light(begin) == Light::green) {
            return model.time_s(programme.next_change_tick(begin) - begin);
        }
    }
    return 0.0;
}

}  // namespace stopline
