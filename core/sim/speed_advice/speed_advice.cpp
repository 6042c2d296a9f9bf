#include "sim/speed_advice/speed_advice.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "base/simd/arithmetic.h"
#include "base/speed_thresholds.h"
#include "signals/signal_controller.h"
#include "sim/junction/arrivals.h"
#include "sim/state/lane_blocks.h"
#include "sim/state/queries/desired_gap.h"
#include "sim/state/queries/lane_end.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

// Advises the first vehicle of a lane that would arrive before it can pass the stop line. The vehicles ahead that stop
// before the green form a queue, which discharges first. It discharges at the desired gaps of their policies.
class LaneAdvice {
public:
    LaneAdvice(const Model& model, State& state, Partition& part, int lane)
        : model_(model),
          state_(state),
          part_(part),
          lane_(lane),
          line_m_(state.plan.lane(lane).stop_line_m),
          limit_mps_(state.plan.free_speed_mps(lane)) {}

    void advise() {
        const VehicleArrays& v = state_.vehicles;
        const LaneBlock& block = state_.blocks[at(lane_)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const double to_line_m = line_m_ - v.position_m[at(slot)];
            if (to_line_m <= 0.0) continue;
            const DriverPlan& driver = model_.driver_of(v.policy[at(slot)]);
            if (v.next_lane[at(slot)] < 0) return;
            const bool is_stopped = v.speed_mps[at(slot)] < kStoppedSpeed_mps;
            const double arrival_s = arrival_in_s(slot, to_line_m);
            if (!find_green(slot, is_stopped ? 0.0 : arrival_s)) return;
            const double passage_s = start_s_ + queue_s_;
            if (!is_stopped && !would_brake(slot, arrival_s, passage_s)) continue;
            if (!is_stopped && driver.has_speed_advice && to_line_m <= driver.speed_advice.range_m) {
                return slow_down(slot, to_line_m, passage_s, driver.speed_advice);
            }
            add_to_queue(slot);
        }
    }

private:
    double now_s_until(std::int64_t tick) const { return model_.time_s(tick - state_.tick); }

    double arrival_in_s(int slot, double to_line_m) const {
        const VehicleArrays& v = state_.vehicles;
        const double acceleration_mps2 = model_.driver_of(v.policy[at(slot)]).give_way.approach_acceleration_mps2;
        return earliest_arrival_s(to_line_m, v.speed_mps[at(slot)], acceleration_mps2, limit_mps_);
    }

    // Finds the first green in which the vehicle in `slot` can pass the stop line: it arrives in `arrival_s`, after the
    // queue. Returns false if the controller does not announce this green.
    bool find_green(int slot, double arrival_s) {
        const int group = state_.plan.signal_group_for(lane_, state_.vehicles.next_lane[at(slot)]);
        const DriverPlan& driver = model_.driver_of(state_.vehicles.policy[at(slot)]);
        const SignalPlans::Place& place = model_.signals.place_of(group);
        const SignalPlan& plan = model_.signals[place.signal];
        if (plan.controller->next_green == nullptr) return false;
        constexpr int kMostGreens = 3;
        const SignalView view(plan, place.signal, state_.tick, state_.signals);
        std::int64_t after_tick = std::max(state_.tick, used_until_tick_);
        for (int k = 0; k < kMostGreens; ++k) {
            const GreenWindow green = plan.controller->next_green(view, static_cast<int>(place.index), after_tick);
            if (!green.is_known()) return false;
            start_s_ = std::max(now_s_until(green.from_tick + driver.hesitation_ticks), 0.0);
            const double end_s = now_s_until(green.until_tick);
            if (std::max(arrival_s, start_s_ + queue_s_) < end_s) return true;
            // The vehicles of the queue that this green does not serve wait for the next one.
            queue_s_ = std::max(start_s_ + queue_s_ - end_s, 0.0);
            after_tick = used_until_tick_ = green.until_tick;
        }
        return false;
    }

    // Returns true if the vehicle would brake for the red light or for the queue, although it may pass in `passage_s`.
    bool would_brake(int slot, double arrival_s, double passage_s) const {
        return passage_s > 0.0 && arrival_s < passage_s + braking_onset_m(slot, limit_mps_) / limit_mps_;
    }

    // Adds the time that a waiting vehicle needs to pass the stop line.
    void add_to_queue(int slot) {
        constexpr double kStartUpLostTime_s = 2.0;  // Highway Capacity Manual, 7th edition
        if (queue_s_ == 0.0) queue_s_ = kStartUpLostTime_s;
        const int policy = state_.vehicles.policy[at(slot)];
        const double length_m = state_.vehicles.length_m[at(slot)];
        queue_s_ += (length_m + desired_gap_m(model_, policy, limit_mps_)) / limit_mps_;
    }

    // Returns the distance to the stop line at which the vehicle would begin to brake for a red light.
    double braking_onset_m(int slot, double speed_mps) const {
        const int policy = state_.vehicles.policy[at(slot)];
        const DriverTables& driver = model_.driver_of(policy).tables;
        const double margin_m = driver.stop.margin_m;
        if (!model_.meso) return margin_m + kBrakingReaction_s * speed_mps + stopping_distance_m(driver, speed_mps);
        const FollowingBraking braking = stop_line_braking(model_, policy);
        return margin_m + braking.reaction_s * speed_mps + 0.5 * square(speed_mps) / braking.deceleration_mps2;
    }

    // Sets a target speed with which the vehicle reaches the braking distance of the stop line when it may pass. If it
    // came nearer before, it would brake for the red light.
    void slow_down(int slot, double to_line_m, double passage_s, const SpeedAdviceSettings& advice) {
        constexpr int kIterations = 4;
        const double speed_mps = state_.vehicles.speed_mps[at(slot)];
        double advised_mps = std::min(to_line_m / passage_s, limit_mps_);
        for (int k = 0; k < kIterations; ++k) {
            const double safe_mps = std::max(advised_mps, advice.min_speed_mps);
            const double arrival_s = passage_s + braking_onset_m(slot, safe_mps) / safe_mps;
            advised_mps = speed_for_arrival_mps(speed_mps, to_line_m, arrival_s, advice.deceleration_mps2);
        }
        const double target_mps = std::max(advised_mps, advice.min_speed_mps);
        if (target_mps >= limit_mps_) return;
        add_speed_target(state_, part_, lane_, {slot, target_mps, advice.deceleration_mps2});
        ++part_.advised;
    }

    const Model& model_;
    State& state_;
    Partition& part_;
    const int lane_;
    double line_m_;
    double limit_mps_;
    double start_s_ = 0.0;              // time until drivers react to the start of the green found; 0: they react
    double queue_s_ = 0.0;              // time from start_s_ on that the queue ahead needs to discharge
    std::int64_t used_until_tick_ = 0;  // greens that end before this tick are too early for the remaining vehicles
};

}  // namespace

double speed_for_arrival_mps(double speed_mps, double distance_m, double time_s, double deceleration_mps2) {
    if (speed_mps * time_s <= distance_m) return distance_m / time_s;
    // Braking from v to w takes (v - w) / b and covers (v^2 - w^2) / (2 b); the rest of the distance is driven at w.
    // The equation for the time is quadratic in w.
    const double b = deceleration_mps2;
    const double root = square(b * time_s) - 2.0 * b * (speed_mps * time_s - distance_m);
    if (root < 0.0) return 0.0;
    return std::max(speed_mps - b * time_s + std::sqrt(root), 0.0);
}

void advise_speeds(const Model& model, State& state, Partition& part) {
    for (const int lane : part.occupied) {
        if (state.plan.lane(lane).signal_group >= 0) LaneAdvice(model, state, part, lane).advise();
    }
}

}  // namespace stopline
