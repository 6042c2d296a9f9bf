// Full dynamics: adds braking for hidden leaders. A vehicle follows the nearest vehicle ahead, its leader. Where
// connections diverge, or where the trip of the leader ends, the leader can leave the follower's route. Until then, the
// leader can hide a slow vehicle further along this route. The follower also brakes for this slow vehicle, the hidden
// leader. Without this rule the follower would see the hidden leader too late.
#include "sim/perception/hidden_leaders.h"

#include <algorithm>
#include <array>

#include "base/containers/index.h"
#include "driver/acceleration_laws.h"
#include "sim/perception/look_ahead.h"
#include "sim/state/queries/desired_gap.h"
#include "sim/state/queries/gap.h"
#include "sim/state/state.h"

namespace stopline {

namespace {

// Adds a braking demand on the vehicle in `slot`, whose leader hides the vehicle `hidden`, if `hidden` is near enough
// to require it. `hidden` is the nearest vehicle beyond the end of `lane` on the route of the vehicle in `slot`.
void add_demand(const Model& model, const State& state, int lane, int slot, const LeaderAhead& hidden,
                Partition& part) {
    const VehicleArrays& v = state.vehicles;
    const double speed_mps = v.speed_mps[at(slot)];
    double hidden_rear_m = hidden.lane_start_m;
    if (!rear_is_on_merging_path(state, lane, slot, hidden.slot)) hidden_rear_m += rear_m(v, hidden.slot);
    LeaderView<double> p{};
    p.gap_m = hidden_rear_m - v.position_m[at(slot)];
    const double standstill_m = v.standstill_gap_m[at(slot)];
    const DriverTables& driver = model.driver_of(v.policy[at(slot)]).tables;
    if (p.gap_m > stopping_distance_m(driver, speed_mps) + standstill_m) return;
    p.closing_mps = speed_mps - v.speed_mps[at(hidden.slot)];
    p.acceleration_mps2 = v.acceleration_mps2[at(hidden.slot)];
    p.request_mps2 = v.request_mps2[at(hidden.slot)];
    const double gap_growth_m = desired_gap_m(model, v.policy[at(slot)], speed_mps) - standstill_m;
    const double demand_mps2 =
        hidden_leader_acceleration(driver, speed_mps, standstill_m, std::max(gap_growth_m, 0.0), p);
    if (demand_mps2 < kUnconstrained_mps2) part.extra_demands.push_back({slot, demand_mps2});
}

// Adds braking demands on vehicles behind the first vehicle of the lane. A vehicle can get a demand only if it takes
// another connection than the first vehicle, and if no vehicle between the two takes this connection.
void react_to_leaders_hidden_from_followers(const Model& model, const State& state, int lane, Partition& part) {
    // Vehicles within this distance of the lane's end are checked; if the stopping distance at the speed limit is
    // longer, vehicles within the stopping distance. A distance of 60 m suffices to stop from 50 km/h.
    constexpr double kMinLookBack_m = 60.0;
    constexpr std::size_t kMaxConnections = 8;
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    const LanePlan& plan = state.plan.lane(lane);
    double look_back_m = kMinLookBack_m;
    for (const DriverPlan& driver : model.drivers) {
        look_back_m = std::max(look_back_m, stopping_distance_m(driver.tables, plan.limit_mps));
    }
    const double from_m = plan.length_m - look_back_m;
    const std::size_t connection_count = std::min(state.plan.next(lane).size(), kMaxConnections);
    int previous = v.next_lane[at(block.first)];
    std::array<int, kMaxConnections> handled{previous};
    std::size_t count = previous >= 0 ? 1 : 0;
    for (int slot = block.first + 1; slot < block.past_last() && v.position_m[at(slot)] > from_m; ++slot) {
        const int connection = v.next_lane[at(slot)];
        if (connection == previous) continue;
        previous = connection;
        if (connection < 0 ||
            std::find(handled.begin(), handled.begin() + count, connection) != handled.begin() + count)
            continue;
        const DriverTables& driver = model.driver_of(v.policy[at(slot)]).tables;
        const double range_m = stopping_distance_m(driver, v.speed_mps[at(slot)]) + v.standstill_gap_m[at(slot)];
        const LeaderAhead hidden = last_vehicle_on_route(state, lane, slot, range_m);
        if (hidden.slot >= 0) add_demand(model, state, lane, slot, hidden, part);
        if (state.plan.diverge_ends_differ(lane)) {
            // The first vehicle of the lane may be clear of a vehicle that is in the way of this one.
            const LeaderAhead diverging = diverging_vehicle(state, lane, connection);
            if (diverging.slot >= 0) add_demand(model, state, lane, slot, diverging, part);
        }
        handled[count++] = connection;
        if (count == connection_count) return;
    }
}

}  // namespace

void react_to_hidden_leaders(const Model& model, const State& state, int lane, const LeaderAhead& hidden,
                             Partition& part) {
    const int first = state.blocks[at(lane)].first;
    if (hidden.slot >= 0) add_demand(model, state, lane, first, hidden, part);
    const bool can_diverge = state.plan.lane(lane).branches || model.is_imported();
    // While the first vehicle is stopped, its followers cannot reach a hidden vehicle.
    if (can_diverge && state.vehicles.speed_mps[at(first)] > 0.0) {
        react_to_leaders_hidden_from_followers(model, state, lane, part);
    }
}

}  // namespace stopline
