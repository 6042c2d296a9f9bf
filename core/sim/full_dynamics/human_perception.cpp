#include "sim/full_dynamics/human_perception.h"

#include <algorithm>
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
double evasive_mps2(const DriverPlan& driver, const VehicleArrays& v, int slot, double gap_m, double closing_mps) {
    const double leader_mps2 = v.acceleration_mps2[at(slot - 1)];
    const LeaderView<double> leader{gap_m, closing_mps, leader_mps2, leader_mps2, 1.0};
    const CaccSettings& limits = driver.tables.cacc;
    const double speed_mps = v.speed_mps[at(slot)];
    return std::min(emergency_acceleration(limits, speed_mps, leader),
                    keep_room_acceleration(limits, speed_mps, 0.0, leader));
}

}  // namespace

void see_as_humans(const Model& model, const State& state, std::span<const LaneStep> lanes, const FullGroup& group) {
    const auto is_human = [](const DriverPlan& driver) { return driver.is_human; };
    if (std::none_of(model.drivers.begin(), model.drivers.end(), is_human)) return;
    const VehicleArrays& v = state.vehicles;
    const std::uint64_t key = driver_key(model.seed);
    std::size_t place = 0;
    for (const LaneStep& lane : lanes) {
        for (int slot = lane.begin; slot < lane.stop; ++slot, ++place) {
            const DriverPlan& driver = model.driver_of(v.policy[at(slot)]);
            if (!driver.is_human) continue;
            const double evasive = evasive_mps2(driver, v, slot, group.gap[place], group.closing[place]);
            group.demand[place] = std::min(group.demand[place], static_cast<float>(evasive));
            const DriverRandom random{key, v.id[at(slot)], model.time_s(state.tick)};
            const double reaction_s = reaction_time_s(driver.human, random.driver(0));
            // The request takes effect a step later, so the measurement may be a step younger than the reaction time.
            const std::int64_t age = std::max<std::int64_t>(std::llround(reaction_s / model.step_s) - 1, 0);
            const std::size_t i = row_of_age(model, state, age) + at(slot);
            const double closing_mps = v.radar_closing_mps[i];
            const double gap_m = v.radar_gap_m[i] - reaction_s * closing_mps;
            const HumanView<double> seen =
                with_errors(driver.human, {gap_m, closing_mps}, v.speed_mps[at(slot)], random);
            group.gap[place] = static_cast<float>(seen.gap_m);
            group.closing[place] = static_cast<float>(seen.closing_mps);
        }
    }
}

}  // namespace stopline
