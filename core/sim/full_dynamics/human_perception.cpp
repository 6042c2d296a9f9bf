#include "sim/full_dynamics/human_perception.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/containers/index.h"
#include "base/random.h"
#include "driver/acceleration_laws.h"
#include "driver/human.h"

namespace stopline {

namespace {

struct DriverRandom {
    std::uint64_t key;
    int vehicle;
    double now_s;
    double driver(std::uint64_t index) const { return keyed_uniform(key, vehicle, index); }
    double time_s() const { return now_s; }
};

// Returns the row of the stored measurements that are `age` steps old, as an offset in the arrays [row][slot].
std::size_t row_of_age(const Model& model, const State& state, std::int64_t age) {
    const std::int64_t present = state.tick % model.radar.rows;
    const std::int64_t wrapped = present >= age ? present - age : present - age + model.radar.rows;
    return at(wrapped) * at(state.vehicles.slots);
}

// Returns the braking that avoids a collision, or kUnconstrained_mps2. It acts on the measurements of this step.
// If the brakes respond later than kBrakeLag_s, the vehicle drives on for the difference, so this distance is
// subtracted from the gap.
double evasive_mps2(const Model& model, const VehicleArrays& v, int slot, double gap_m, double closing_mps) {
    constexpr double kBrakeLag_s = 0.2;  // the lag for which keep_response_room_acceleration() has its reserve
    const int policy = v.policy[at(slot)];
    const double speed_mps = v.speed_mps[at(slot)];
    const double late_m = std::max(model.vehicle_of(policy).brake_lag_s - kBrakeLag_s, 0.0) * speed_mps;
    const double leader_mps2 = v.acceleration_mps2[at(slot - 1)];
    const LeaderView<double> leader{gap_m - late_m, closing_mps, leader_mps2, leader_mps2, 1.0};
    const CaccSettings& limits = model.driver_of(policy).tables.cacc;
    return std::min(emergency_acceleration(limits, speed_mps, leader),
                    keep_response_room_acceleration(limits, speed_mps, leader));
}

// A human driver of a group.
class HumanDriver {
public:
    HumanDriver(const Model& model, State& state, const DriverPlan& driver, int slot)
        : model_(model),
          state_(state),
          v_(state.vehicles),
          driver_(driver),
          slot_(slot),
          speed_mps_(v_.speed_mps[at(slot)]),
          random_{driver_key(model.seed), v_.id[at(slot)], model.time_s(state.tick)},
          reaction_s_(reaction_time_s(driver.human, random_.driver(0))),
          wait_s_(start_reaction_s(driver.human, reaction_s_)) {}

    // Stores the own speed. Returns true if the driver is at rest and waits to start behind its leader. `gap_m` is the
    // measured net gap.
    bool waits(double gap_m) {
        int& ticks = v_.start_ticks[at(slot_)];
        extra_gap_m_ = gap_m - static_cast<double>(v_.standstill_gap_m[at(slot_)]);
        ticks = next_start_ticks(ticks, speed_mps_, v_.speed_mps[at(slot_ - 1)], extra_gap_m_);
        v_.own_speed_mps[row_of_age(model_, state_, 0) + at(slot_)] = static_cast<float>(speed_mps_);
        since_leader_start_s_ = ticks * model_.step_s;
        return waits_to_start(ticks, speed_mps_, wait_s_, model_.step_s);
    }

    // Returns the sum of the terms (s* / s)^2 of the vehicles ahead. `leaders` is the number of vehicles whose
    // measurements can be used: those from this vehicle to the first one of its lane. `growth_m` is the desired gap
    // minus the standstill gap. Call waits() before.
    double interaction(int leaders, double growth_m, double closing_mps) const {
        if (is_driving_off(since_leader_start_s_, wait_s_, reaction_s_, closing_mps, extra_gap_m_) > 0.0) return 0.0;
        const double age_s = view_age_s(since_leader_start_s_ - wait_s_, reaction_s_);
        // The request takes effect a step later, so the driver uses a measurement that is one step younger than age_s.
        const std::int64_t age = std::max<std::int64_t>(std::llround(age_s / model_.step_s) - 1, 0);
        const std::size_t first = row_of_age(model_, state_, age) + at(slot_);
        // The driver knows how it has moved since the measurement. Its distance is the age times the mean of its speeds
        // then and now.
        const double gained_mps = speed_mps_ - v_.own_speed_mps[first];
        const double range_m = driver_.tables.cacc.radar_range_m;
        // While the leader is stopped, the driver reacts to the leader alone. Otherwise it would start as soon as
        // vehicles further ahead start.
        const int most = since_leader_start_s_ == 0.0 ? 1 : std::min(driver_.human.anticipated_vehicles, leaders);
        std::array<HumanView<double>, kMaxAnticipatedVehicles> views{};
        HumanView<double> exact{-0.5 * age_s * gained_mps, gained_mps};
        int seen = 0;
        for (; seen < most; ++seen) {
            const std::size_t i = first - at(seen);
            exact.gap_m += v_.radar_gap_m[i] - age_s * v_.radar_closing_mps[i];
            exact.closing_mps += v_.radar_closing_mps[i];
            if (exact.gap_m > range_m) break;
            const double leader_gap_m = seen == 0 ? exact.gap_m : views[0].gap_m;
            views[at(seen)] = {std::max(exact.gap_m, (seen + 1) * leader_gap_m), exact.closing_mps};
        }
        const double factor = several_leaders_factor(seen);
        const double standstill_m = factor * static_cast<double>(v_.standstill_gap_m[at(slot_)]);
        double sum = 0.0;
        for (int n = 0; n < seen; ++n) {
            const HumanView<double> view = with_errors(driver_.human, views[at(n)], speed_mps_, random_);
            sum += idm_interaction(speed_mps_, view.closing_mps, view.gap_m, standstill_m, factor * growth_m,
                                   driver_.tables.human.closing_s2pm);
        }
        return sum;
    }

private:
    const Model& model_;
    const State& state_;
    VehicleArrays& v_;
    const DriverPlan& driver_;
    int slot_;
    double speed_mps_;
    DriverRandom random_;
    double reaction_s_;
    double wait_s_;
    double since_leader_start_s_ = 0.0;
    double extra_gap_m_ = 0.0;
};

}  // namespace

void react_as_humans(const Model& model, State& state, std::span<const LaneStep> lanes, const FullGroup& group) {
    VehicleArrays& v = state.vehicles;
    if (!v.has_human_drivers) return;
    std::size_t place = 0;
    for (const LaneStep& lane : lanes) {
        for (int slot = lane.begin; slot < lane.stop; ++slot, ++place) {
            const DriverPlan& plan = model.driver_of(v.policy[at(slot)]);
            if (!plan.is_human) continue;
            const double growth_m =
                std::max(group.desired_gap[place] - static_cast<double>(group.standstill_gap[place]), 0.0);
            const double evasive = evasive_mps2(model, v, slot, group.gap[place], group.closing[place]);
            group.demand[place] = std::min(group.demand[place], static_cast<float>(evasive));
            HumanDriver driver(model, state, plan, slot);
            if (driver.waits(group.gap[place])) group.demand[place] = std::min(group.demand[place], 0.0F);
            group.interaction[place] =
                static_cast<float>(driver.interaction(slot - lane.begin + 1, growth_m, group.closing[place]));
        }
    }
}

}  // namespace stopline
