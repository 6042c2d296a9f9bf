// Signal, stop lines and demand of the reference engine. These functions choose the vehicle that stops at a line, and
// the time, state and policy of the next vehicle that enters.
#pragma once

#include <optional>

#include "base/random.h"
#include "reference/world.h"

namespace stopline::reference_engine {

inline std::int64_t ticks_in(double seconds, double step_s) { return std::llround(seconds / step_s); }

// A fixed-time signal: red, then green, yellow and red, once or in each cycle.
struct Signal {
    std::int64_t first_green = 0;
    std::int64_t green = 0;
    std::int64_t yellow = 0;
    std::int64_t red = 0;
    bool repeats = false;

    // Returns the number of ticks since the start of the cycle, or -1 outside of all cycles.
    std::int64_t phase(std::int64_t tick) const {
        const std::int64_t cycle = green + yellow + red;
        if (tick < first_green || (!repeats && tick >= first_green + cycle)) return -1;
        return (tick - first_green) % cycle;
    }
    Light light(std::int64_t tick) const {
        const std::int64_t now = phase(tick);
        if (now < 0 || now >= green + yellow) return Light::red;
        return now < green ? Light::green : Light::yellow;
    }
};

// Returns two signals: first that of the lanes from west and east, then that of the lanes from south and north. The two
// signals have green one after the other.
inline std::vector<Signal> make_crossing_signals(const SignalSettings& s, double step_s) {
    const double stage_s = s.green_s + s.yellow_s + s.all_red_s;
    const auto signal_from = [&](double first_green_s) {
        const double red_s = 2.0 * stage_s - s.green_s - s.yellow_s;
        return Signal{ticks_in(first_green_s, step_s), ticks_in(s.green_s, step_s), ticks_in(s.yellow_s, step_s),
                      ticks_in(red_s, step_s), true};
    };
    return {signal_from(s.first_green_s), signal_from(s.first_green_s + stage_s)};
}

inline Signal make_signal(const SignalSettings& s, double step_s) {
    const bool repeats = s.cycle_s > 0.0;
    const double red_s = repeats ? s.cycle_s - s.green_s - s.yellow_s : s.all_red_s;
    return {ticks_in(s.first_green_s, step_s), ticks_in(s.green_s, step_s), ticks_in(s.yellow_s, step_s),
            ticks_in(red_s, step_s), repeats};
}

// Returns true if the vehicle can stop before the line with the given deceleration. Until the brake responds, the
// vehicle keeps its present acceleration if this is positive.
inline bool can_stop_before(const Vehicle& v, const Lane& lane, const Scenario& scenario, double deceleration_mps2) {
    const double present_mps2 = std::max(v.acceleration_mps2, 0.0);
    const double request_mps2 = scenario.is_meso() ? present_mps2 : std::max(present_mps2, v.request_mps2);
    const double jerk_mps3 = scenario.driver.cacc.jerk_down_mps3;
    const double delay_s = scenario.vehicle.brake_lag_s + 0.5 * (request_mps2 + deceleration_mps2) / jerk_mps3;
    const double speed_mps = v.speed_mps + present_mps2 * delay_s;
    const double delay_m = (v.speed_mps + 0.5 * present_mps2 * delay_s) * delay_s;
    const double room_m = lane.length_m - v.position_m - delay_m;
    return speed_mps * speed_mps <= 2.0 * deceleration_mps2 * room_m;
}

// Sets Lane::stop_index to the vehicle that must stop at the line in this step. The choice holds until the signal is
// green and the reaction time of the first driver has passed. Marks the chosen vehicle as a platoon leader. Returns
// true if the signal lets all vehicles pass.
inline bool decide_stop_line(const Scenario& scenario, const Signal& signal, std::int64_t hesitation_ticks,
                             std::int64_t tick, Lane& lane) {
    lane.stop_index = -1;
    const Light light = signal.light(tick);
    if (light == Light::green && (lane.stopping_id < 0 || signal.phase(tick) >= hesitation_ticks)) {
        lane.stopping_id = -1;
        return true;
    }
    const double deceleration_mps2 = light == Light::yellow ? scenario.driver.stop.decision_deceleration_mps2
                                                            : scenario.driver.cacc.deceleration_emergency_mps2;
    const auto is_chosen = [&](const Vehicle& v) { return v.id == lane.stopping_id; };
    auto stopper = std::find_if(lane.vehicles.begin(), lane.vehicles.end(), is_chosen);
    if (stopper == lane.vehicles.end()) {
        stopper = std::find_if(lane.vehicles.begin(), lane.vehicles.end(),
                               [&](const Vehicle& v) { return can_stop_before(v, lane, scenario, deceleration_mps2); });
    }
    lane.stopping_id = -1;
    if (stopper == lane.vehicles.end()) return false;
    stopper->is_platoon_leader = true;
    lane.stopping_id = stopper->id;
    lane.stop_index = stopper - lane.vehicles.begin();
    return false;
}

// Draws the policies of the vehicles.
class PolicyDraw {
public:
    PolicyDraw(const PopulationSettings& population, std::uint64_t seed) : population_(population), seed_(seed) {}

    // Returns the policy of the k-th vehicle of a lane, as an index of the components of the population.
    int policy_of(int lane, std::int64_t k) const {
        using Pattern = PopulationSettings::Pattern;
        if (population_.components.size() == 1) return 0;
        if (population_.pattern == Pattern::alternating) return alternating(k);
        const std::uint64_t vehicle = key(lane, k);
        if (population_.pattern == Pattern::random) return picked(random_uniform(seed_, vehicle, 0, Purpose::policy));
        return picked(balanced_number(lane, k));
    }

private:
    static std::uint64_t key(int lane, std::int64_t k) {
        return (static_cast<std::uint64_t>(lane) << 40) + static_cast<std::uint64_t>(k);
    }
    double share(std::size_t component) const { return population_.components[component].share; }

    // Each vehicle gets the component whose number of vehicles is furthest below its share.
    int alternating(std::int64_t k) const {
        std::vector<double> drawn(population_.components.size(), 0.0);
        std::size_t chosen = 0;
        for (std::int64_t n = 1; n <= k + 1; ++n) {
            const auto behind = [&](std::size_t c) { return share(c) * static_cast<double>(n) - drawn[c]; };
            chosen = 0;
            for (std::size_t c = 1; c < drawn.size(); ++c) {
                if (behind(c) > behind(chosen) + 1e-9) chosen = c;
            }
            drawn[chosen] += 1.0;
        }
        return static_cast<int>(chosen);
    }
    int picked(double number) const {
        double upper = share(0);
        std::size_t c = 0;
        while (number >= upper && c + 1 < population_.components.size()) upper += share(++c);
        return static_cast<int>(c);
    }
    // Returns a number in [0, 1) for the k-th vehicle. The 20 vehicles of a block get numbers from 20 different
    // twentieths of [0, 1), in random order.
    double balanced_number(int lane, std::int64_t k) const {
        const std::int64_t first = k / 20 * 20;
        const auto bits = [&](std::int64_t other) { return random_bits(seed_, key(lane, other), 1, Purpose::policy); };
        int rank = 0;
        for (std::int64_t other = first; other < first + 20; ++other) rank += bits(other) < bits(k) ? 1 : 0;
        return (rank + random_uniform(seed_, key(lane, first), 2, Purpose::policy)) / 20.0;
    }

    PopulationSettings population_;
    std::uint64_t seed_;
};

// Returns the earliest time at which the next vehicle of a lane may enter.
inline double next_entry_s(const Scenario& scenario, const Lane& lane, int number) {
    constexpr double kQueueHeadway_s = 2.0;
    if (scenario.demand.kind == "saturated") return -1e9;
    if (scenario.demand.kind == "queue") return lane.last_entry_s + kQueueHeadway_s;
    const bool is_crossing = scenario.network.kind == "intersection";
    const int lanes_of_leg = is_crossing ? 1 : scenario.network.approach.lanes;
    const double headway_s = lanes_of_leg / scenario.demand.inflow_1ps;
    const double offset = random_uniform(scenario.seed, static_cast<std::uint64_t>(number), 0, Purpose::insertion);
    return (static_cast<double>(lane.entered) + offset) * headway_s;
}

struct EntryState {
    double position_m = 0.0;
    double speed_mps = 0.0;
};

// Returns the state in which the next vehicle enters; empty if it finds no room. `length_m` is the length of each
// vehicle. `gap_m(speed)` returns the desired gap of the next vehicle.
template <class Gap>
std::optional<EntryState> entry_state(const Scenario& scenario, const Lane& lane, double length_m, Gap gap_m) {
    constexpr double kHeadway_s = 2.0;
    const double highest_mps = std::min(scenario.demand.entry_speed_mps, lane.limit_mps);
    if (lane.vehicles.empty()) return EntryState{0.0, highest_mps};
    const Vehicle& last = lane.vehicles.back();
    const double rear_m = last.position_m - length_m;
    const double speed_mps = std::min(highest_mps, last.speed_mps);
    // Vehicles of a saturated inflow enter as a platoon, with the desired gap.
    if (scenario.demand.kind == "saturated") {
        const double position_m = rear_m - gap_m(speed_mps);
        if (position_m < 0.0) return std::nullopt;
        return EntryState{position_m, speed_mps};
    }
    if (rear_m < gap_m(speed_mps) + 0.5 * kHeadway_s * speed_mps) return std::nullopt;
    return EntryState{0.0, speed_mps};
}

}  // namespace stopline::reference_engine
