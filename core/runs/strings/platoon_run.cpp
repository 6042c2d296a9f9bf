#include "runs/strings/platoon_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "base/speed_thresholds.h"
#include "scenario/build_model.h"
#include "scenario/fleets.h"
#include "scenario/kinds/network_kind.h"
#include "sim/step/simulation.h"

namespace stopline {

namespace {

using Kind = Manoeuvre::Kind;

constexpr int kLeaderId = 0;  // ids count the inserted vehicles
// Time in which one more vehicle enters the queue and stops, and time in which one more vehicle reaches equilibrium.
constexpr double kQueueTime_s = 8.0;
constexpr double kSettleTime_s = 4.0;
constexpr double kLongestStart_s = 90.0;

// Swing: the amplitude grows during kGrowthPeriods periods, and at least for kShortestGrowth_s. After kWaitPeriods
// periods, and at least kShortestWait_s, the last vehicles oscillate evenly. Then the motion is recorded.
constexpr double kGrowthPeriods = 1.0;
constexpr double kShortestGrowth_s = 10.0;
constexpr double kWaitPeriods = 1.0;
constexpr double kShortestWait_s = 25.0;
constexpr double kRecordedPeriods = 3.0;
constexpr double kShortestRecord_s = 20.0;

double queue_time_s(int vehicles) { return 60.0 + kQueueTime_s * vehicles; }
double settle_time_s(int vehicles) { return kLongestStart_s + kSettleTime_s * vehicles; }

// Returns the number of steps of one period. Periods are whole numbers of steps, so that whole periods are recorded.
double period_steps(const Manoeuvre& manoeuvre, double step_s) {
    return std::max(2.0, std::round(2.0 * std::numbers::pi / (manoeuvre.frequency_radps * step_s)));
}

double whole_periods_s(double least_s, double least_periods, double period_s) {
    return period_s * std::ceil(std::max(least_periods, least_s / period_s) - 1e-9);
}

struct SwingTimes {
    double period_s;
    double growth_s;
    double wait_s;
    double record_s;
};

SwingTimes swing_times(const Manoeuvre& manoeuvre, int vehicles, double step_s) {
    SwingTimes times{};
    times.period_s = period_steps(manoeuvre, step_s) * step_s;
    times.growth_s = whole_periods_s(kShortestGrowth_s, kGrowthPeriods, times.period_s);
    times.wait_s = whole_periods_s(kShortestWait_s + vehicles, kWaitPeriods, times.period_s);
    times.record_s = whole_periods_s(kShortestRecord_s, kRecordedPeriods, times.period_s);
    return times;
}

// Returns the longest duration of the manoeuvre, s.
double longest_s(const Manoeuvre& manoeuvre, int vehicles, double step_s) {
    if (manoeuvre.kind == Kind::start) return settle_time_s(vehicles);
    if (manoeuvre.kind == Kind::brake) return 30.0 + kSettleTime_s * vehicles;
    const SwingTimes times = swing_times(manoeuvre, vehicles, step_s);
    return times.growth_s + times.wait_s + times.record_s;
}

// Returns the scenario of the run: one lane, a queue of `vehicles` vehicles, and a road that is long enough.
Scenario road_of(const Scenario& scenario, std::size_t population, int vehicles, const Manoeuvre& manoeuvre) {
    Scenario road = scenario;
    road.populations = {scenario.populations[population]};
    road.demand.kind = "queue";
    road.demand.vehicles = vehicles;
    double longest_gap_m = 0.0;
    for (const GapPolicySettings& policy : road.policies) {
        longest_gap_m = std::max(longest_gap_m, policy.standstill_gap_m);
    }
    ApproachSettings& approach = road.network.approach;
    approach.lanes = 1;
    approach.length_m = 200.0 + vehicles * (longest_vehicle_m(scenario) + longest_gap_m + 1.0);
    const double driven_s = 2.0 * settle_time_s(vehicles) + longest_s(manoeuvre, vehicles, scenario.step_s);
    approach.exit_length_m = 500.0 + 1.1 * approach.speed_limit_mps * driven_s;
    road.signal.first_green_s = queue_time_s(vehicles);
    road.signal.green_s = 2.0 * driven_s;
    road.signal.cycle_s = 0.0;
    return road;
}

// A run of one platoon.
class PlatoonRun {
public:
    PlatoonRun(const Scenario& scenario, int vehicles, const Manoeuvre& manoeuvre,
               const std::function<bool(double)>& report)
        : model_(build_model(scenario, 0)),
          simulation_(model_),
          manoeuvre_(manoeuvre),
          vehicles_(vehicles),
          report_(report) {
        motion_.step_s = model_.step_s;
        motion_.vehicles = at(vehicles);
        const double run_s = queue_time_s(vehicles) + (manoeuvre.kind == Kind::start ? 0.0 : settle_time_s(vehicles)) +
                             longest_s(manoeuvre, vehicles, model_.step_s);
        expected_steps_ = run_s / model_.step_s;
    }

    PlatoonMotion run(double green_s) {
        form_queue(green_s);
        if (manoeuvre_.kind == Kind::start) {
            record_start();
        } else {
            settle();
            manoeuvre_.kind == Kind::swing ? record_swing() : record_braking();
        }
        motion_.follower_lag_s = lag_samples_ > 0 ? lag_sum_s_ / static_cast<double>(lag_samples_) : 0.0;
        motion_.violations = simulation_.state().records.violations;
        motion_.updates = simulation_.state().records.updates;
        motion_.state_hash = simulation_.state_hash();
        return std::move(motion_);
    }

private:
    // Calls visit(position, slot) for each vehicle, from the platoon leader to the last vehicle.
    template <class Visit>
    void for_each_vehicle(Visit visit) const {
        const State& state = simulation_.state();
        std::size_t position = 0;
        for (std::size_t lane = state.blocks.size(); lane-- > 0;) {  // the exit lane follows the approach lane
            const LaneBlock& block = state.blocks[lane];
            for (int slot = block.first; slot < block.past_last(); ++slot) visit(position++, at(slot));
        }
    }

    // Advances by one step. Returns false if the run shall end.
    bool advance() {
        constexpr std::int64_t kReportSteps = 1000;
        if (!stopped_ && report_ && simulation_.state().tick % kReportSteps == 0) {
            stopped_ = !report_(std::min(1.0, static_cast<double>(simulation_.state().tick) / expected_steps_));
        }
        if (stopped_) return false;
        simulation_.step();
        return true;
    }

    void prescribe(double acceleration_mps2) { simulation_.prescribe({kLeaderId, acceleration_mps2}); }

    double leader_speed_mps() const {
        double speed_mps = 0.0;
        for_each_vehicle([&](std::size_t position, std::size_t slot) {
            if (position == 0) speed_mps = simulation_.state().vehicles.speed_mps[slot];
        });
        return speed_mps;
    }

    // Returns the net gap of each vehicle; 0 for the platoon leader. Lanes succeed each other without a break.
    std::vector<double> gaps_m() const {
        const VehicleArrays& v = simulation_.state().vehicles;
        const double approach_m = model_.graph.lanes[0].length_m;
        std::vector<double> gaps;
        double rear_m = 0.0;
        const State& state = simulation_.state();
        for_each_vehicle([&](std::size_t position, std::size_t slot) {
            const bool is_on_exit = state.blocks[1].has(static_cast<int>(slot));
            const double front_m = v.position_m[slot] + (is_on_exit ? approach_m : 0.0);
            gaps.push_back(position == 0 ? 0.0 : rear_m - front_m);
            rear_m = front_m - static_cast<double>(v.length_m[slot]);
        });
        return gaps;
    }

    // Waits for the green. All vehicles must have stopped by then.
    void form_queue(double green_s) {
        while (simulation_.time_s() < green_s && advance()) {
        }
        if (stopped_) return;
        const VehicleArrays& v = simulation_.state().vehicles;
        std::size_t stopped = 0;
        for_each_vehicle([&](std::size_t /*position*/, std::size_t slot) {
            if (v.speed_mps[slot] < kStoppedSpeed_mps) ++stopped;
        });
        if (stopped != motion_.vehicles) {
            throw InputError(fmt::format("only {} of {} vehicles have stopped in the queue after {} s", stopped,
                                         motion_.vehicles, green_s));
        }
        for_each_vehicle([&](std::size_t /*position*/, std::size_t slot) {
            motion_.standstill_gap_m.push_back(static_cast<double>(v.standstill_gap_m[slot]));
        });
    }

    // Accelerates to the speed before the manoeuvre, and waits until all vehicles are in equilibrium.
    void settle() {
        constexpr double kSpeedGain_1ps = 0.5;
        const double until_s = simulation_.time_s() + settle_time_s(vehicles_);
        const auto steps_of_check = static_cast<std::int64_t>(1.0 / model_.step_s);
        while (simulation_.time_s() < until_s) {
            prescribe(kSpeedGain_1ps * (manoeuvre_.speed_mps - leader_speed_mps()));
            if (!advance()) return;
            if (simulation_.state().tick % steps_of_check == 0 && is_settled()) return;
        }
        motion_.was_settled = false;
    }

    bool is_settled() const {
        constexpr double kSpeedTolerance_mps = 0.02;
        constexpr double kGapTolerance_m = 0.05;
        constexpr double kAccelerationTolerance_mps2 = 0.02;
        const VehicleArrays& v = simulation_.state().vehicles;
        const std::vector<double> gaps = gaps_m();
        bool settled = true;
        for_each_vehicle([&](std::size_t position, std::size_t slot) {
            const double speed_mps = v.speed_mps[slot];
            settled = settled && std::abs(speed_mps - manoeuvre_.speed_mps) < kSpeedTolerance_mps &&
                      std::abs(v.acceleration_mps2[slot]) < static_cast<float>(kAccelerationTolerance_mps2) &&
                      (position == 0 || std::abs(gap_error_m(gaps[position], slot)) < kGapTolerance_m);
        });
        return settled;
    }

    double gap_error_m(double gap_m, std::size_t slot) const {
        const VehicleArrays& v = simulation_.state().vehicles;
        return gap_m - equilibrium_gap_m(model_.policies[at(v.policy[slot])], v.speed_mps[slot]);
    }

    void record() {
        const VehicleArrays& v = simulation_.state().vehicles;
        const std::vector<double> gaps = gaps_m();
        for_each_vehicle([&](std::size_t position, std::size_t slot) {
            motion_.acceleration_mps2.push_back(v.acceleration_mps2[slot]);
            motion_.speed_mps.push_back(static_cast<float>(v.speed_mps[slot]));
            motion_.gap_m.push_back(static_cast<float>(gaps[position]));
            motion_.gap_error_m.push_back(position == 0 ? 0.0F : static_cast<float>(gap_error_m(gaps[position], slot)));
            if (position == 0) return;
            lag_sum_s_ += static_cast<double>(v.lag_s[slot]);
            ++lag_samples_;
        });
        if (gaps.size() != motion_.vehicles) throw std::logic_error("a vehicle has left the road of the platoon");
        ++motion_.samples;
    }

    // The prescribed acceleration is a(t) = A r(t) cos(w t), with a factor r that grows from 0 to 1. The leader also
    // returns slowly to the speed that the integral of a(t) gives, so that it does not drift.
    void record_swing() {
        constexpr double kDriftGain_1ps = 0.1;
        const double dt = model_.step_s;
        const SwingTimes times = swing_times(manoeuvre_, vehicles_, dt);
        const double frequency_radps = 2.0 * std::numbers::pi / times.period_s;
        const auto steps =
            static_cast<std::int64_t>(std::lround((times.growth_s + times.wait_s + times.record_s) / dt));
        const auto first = static_cast<std::int64_t>(std::lround((times.growth_s + times.wait_s) / dt));
        double reference_mps = manoeuvre_.speed_mps;
        for (std::int64_t k = 0; k < steps; ++k) {
            const double t = static_cast<double>(k) * dt;
            const double growth = std::min(1.0, t / times.growth_s);
            const double swing_mps2 = manoeuvre_.amplitude_mps2 * growth * std::cos(frequency_radps * t);
            prescribe(swing_mps2 + kDriftGain_1ps * (reference_mps - leader_speed_mps()));
            if (!advance()) return;
            reference_mps += swing_mps2 * dt;
            if (k >= first) record();
        }
    }

    // A leader with gearbox brakes harder than prescribed just before it stops, up to the friction limit. The brake
    // force for a closed clutch also slows down the engine. When the clutch opens at low speed, this part of the force
    // acts on the car alone, until the brake has followed its new request with its lag (powertrain_step.h). An electric
    // car has almost no such rotating mass, and keeps the prescribed deceleration.
    void record_braking() {
        prescribe(-manoeuvre_.deceleration_mps2);
        const double until_s = simulation_.time_s() + longest_s(manoeuvre_, vehicles_, model_.step_s);
        while (simulation_.time_s() < until_s && advance()) {
            record();
            if (all_speeds_within(0.0, 0.0)) return;
        }
    }

    void record_start() {
        constexpr double kTolerance_mps = 0.5 / 3.6;
        const double limit_mps = model_.graph.lanes[0].limit_mps;
        const double until_s = simulation_.time_s() + longest_s(manoeuvre_, vehicles_, model_.step_s);
        while (simulation_.time_s() < until_s && advance()) {
            record();
            if (all_speeds_within(limit_mps - kTolerance_mps, limit_mps + kTolerance_mps)) return;
        }
    }

    bool all_speeds_within(double low_mps, double high_mps) const {
        const VehicleArrays& v = simulation_.state().vehicles;
        bool within = true;
        for_each_vehicle([&](std::size_t /*position*/, std::size_t slot) {
            within = within && v.speed_mps[slot] >= low_mps && v.speed_mps[slot] <= high_mps;
        });
        return within;
    }

    Model model_;
    Simulation simulation_;
    Manoeuvre manoeuvre_;
    int vehicles_;
    const std::function<bool(double)>& report_;
    double expected_steps_ = 1.0;
    bool stopped_ = false;
    double lag_sum_s_ = 0.0;
    std::size_t lag_samples_ = 0;
    PlatoonMotion motion_;
};

}  // namespace

void check_platoon_scenario(const Scenario& scenario) {
    if (network_kind(scenario.network).run != kRunAsSingleLight) {
        throw InputError(
            fmt::format("field 'network.kind': value '{}' is not a straight road; give a scenario with "
                        "network.kind: approach",
                        scenario.network.kind));
    }
    if (scenario.is_meso()) {
        throw InputError("field 'fidelity': value 'meso' has no controllers and sensors; set fidelity=full");
    }
}

PlatoonMotion drive_platoon(const Scenario& scenario, std::size_t population, int vehicles, const Manoeuvre& manoeuvre,
                            const std::function<bool(double)>& report) {
    check_platoon_scenario(scenario);
    const Scenario road = road_of(scenario, population, vehicles, manoeuvre);
    return PlatoonRun(road, vehicles, manoeuvre, report).run(road.signal.first_green_s);
}

}  // namespace stopline
