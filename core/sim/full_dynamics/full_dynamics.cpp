#include "sim/full_dynamics/full_dynamics.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "base/simd/narrowed.h"
#include "sim/full_dynamics/full_kernels.h"
#include "sim/full_dynamics/human_perception.h"
#include "sim/full_dynamics/receive_messages.h"
#include "sim/state/queries/overlap.h"

namespace stopline {

namespace {

FullStreams streams_of(const Model& model, State& state) {
    VehicleArrays& v = state.vehicles;
    const DelayRows& radar = state.radar;
    const DelayRows& v2v = state.v2v;
    FullStreams s{};
    s.position = v.position_m.data();
    s.speed = v.speed_mps.data();
    s.length = v.length_m.data();
    s.standstill_gap = v.standstill_gap_m.data();
    s.end_speed = v.end_speed_mps.data();
    s.policy = model.policies.size() > 1 ? v.policy.data() : nullptr;
    s.type = model.vehicles.size() > 1 ? v.type.data() : nullptr;
    s.acceleration = v.acceleration_mps2.data();
    s.lag = v.lag_s.data();
    s.request = v.request_mps2.data();
    s.is_platoon_leader = v.is_platoon_leader.data();
    s.torque = v.torque_Nm.data();
    s.brake = v.brake_N.data();
    s.gear_time = v.gear_time_s.data();
    s.gear = v.gear.data();
    s.gap_now = v.radar_gap_m.data() + radar.now;
    s.gap_delayed = v.radar_gap_m.data() + radar.delayed;
    s.gap_older = v.radar_gap_m.data() + radar.older;
    s.closing_now = v.radar_closing_mps.data() + radar.now;
    s.closing_delayed = v.radar_closing_mps.data() + radar.delayed;
    s.closing_older = v.radar_closing_mps.data() + radar.older;
    if (v.has_v2v_channel) return s;
    s.sent_acceleration = v.v2v_acceleration_mps2.data() + v2v.now;
    s.sent_request = v.v2v_request_mps2.data() + v2v.now;
    s.sent_rate = v.v2v_rate_1ps.data() + v2v.now;
    s.heard_acceleration = v.v2v_acceleration_mps2.data() + v2v.delayed;
    s.heard_request = v.v2v_request_mps2.data() + v2v.delayed;
    s.heard_rate = v.v2v_rate_1ps.data() + v2v.delayed;
    s.heard_acceleration_older = v.v2v_acceleration_mps2.data() + v2v.older;
    s.heard_request_older = v.v2v_request_mps2.data() + v2v.older;
    s.heard_rate_older = v.v2v_rate_1ps.data() + v2v.older;
    return s;
}

// Computes the desired gap of each vehicle, and the slope of this gap over speed. Both belong to the speed that the
// vehicle will have at the end of the step, because the requested acceleration takes effect then. With the speed at the
// start of the step, results would depend on the step length.
// The gap law of each policy in the group is evaluated for all vehicles of the group, and each vehicle takes the result
// of its own policy.
void evaluate_gap_laws(const Model& model, int vehicles, const FullGroup& g) {
    const std::size_t n = at(vehicles);
    const std::span<const double> speed_mps(g.coming_speed, n);
    const int* const policy_of = g.policy;
    const auto evaluate = [&](int policy, double* gap, double* slope) {
        model.policies[at(policy)].evaluate(speed_mps, {gap, n}, {slope, n});
    };
    const int first = model.policies.size() > 1 ? policy_of[0] : 0;
    evaluate(first, g.desired_gap, g.slope);
    for (int k = 0; k < static_cast<int>(model.policies.size()); ++k) {
        if (k == first || std::find(policy_of, policy_of + n, k) == policy_of + n) continue;
        evaluate(k, g.law_gap, g.law_slope);
        for (std::size_t i = 0; i < n; ++i) {
            g.desired_gap[i] = policy_of[i] == k ? g.law_gap[i] : g.desired_gap[i];
            g.slope[i] = policy_of[i] == k ? g.law_slope[i] : g.slope[i];
        }
    }
}

// Sets the driver of each vehicle of the group. Applies speed limiters: the maximum speed of the vehicle lowers the
// speed limit of its driver, and bounds the acceleration even if the driver exceeds this limit to close a gap.
void apply_classes(const Model& model, int vehicles, const FullGroup& g) {
    if (model.drivers.size() > 1) {
        for (int i = 0; i < vehicles; ++i) g.driver[i] = model.classes[at(g.policy[i])].driver;
    }
    if (!model.has_speed_limiters) return;
    for (int i = 0; i < vehicles; ++i) {
        const int type = model.vehicles.size() > 1 ? g.type[i] : 0;
        const auto maximum_mps = static_cast<float>(model.vehicles[at(type)].maximum_speed_mps);
        const int driver = model.drivers.size() > 1 ? g.driver[i] : 0;
        const auto gain_1ps = static_cast<float>(model.drivers[at(driver)].tables.speed_gain_1ps);
        g.limit[i] = std::min(g.limit[i], maximum_mps);
        g.demand[i] = std::min(g.demand[i], gain_1ps * (maximum_mps - g.speed[i]));
    }
}

// Replaces the gap laws by the accelerations of the program (ExternalRequests). They limit the vehicles like external
// demands. A constant gap of kSmallestGap_m replaces the gap of the policy, so that no vehicle runs into its leader.
void apply_external_requests(const State& state, const LaneGroup& lanes, const FullGroup& g) {
    constexpr double kSmallestGap_m = 1.0;
    if (state.external_requests.empty()) return;
    int place = 0;
    for (const LaneStep& lane : lanes.lanes) {
        for (int slot = lane.begin; slot < lane.stop; ++slot, ++place) {
            const float request_mps2 = state.external_requests.of(state.vehicles.id[at(slot)]);
            if (std::isnan(request_mps2)) continue;
            g.desired_gap[place] = kSmallestGap_m;
            g.slope[place] = 0.0;
            g.is_platoon_leader[place] = 0.0F;
            g.demand[place] = std::min(g.demand[place], request_mps2);
        }
    }
}

}  // namespace

FullTables full_tables(const Model& model) {
    FullTables tables;
    for (const DriverPlan& driver : model.drivers) tables.drivers.push_back(narrowed(driver.tables));
    for (const PowertrainTables& type : model.vehicles) tables.vehicles.push_back(narrowed(type));
    if (model.v2v_plan.is_active) tables.receive_policies = receive_policies(model);
    return tables;
}

void step_full(const Model& model, const FullTables& tables, const LaneGroup& lanes, std::span<const int> next,
               State& state, Partition& part) {
    const FullKernels& kernels = full_kernels(model.scalar_kernels);
    const FullStreams streams = streams_of(model, state);
    const FullGroup group = part.full_group.streams();
    kernels.gather(streams, state.radar, state.v2v, lanes, model.step_s, group);
    evaluate_gap_laws(model, lanes.vehicles, group);
    apply_classes(model, lanes.vehicles, group);
    react_as_humans(model, state, lanes.lanes, group);
    if (state.vehicles.has_v2v_channel) {
        receive_messages(model, kernels, tables.receive_policies, lanes, next, group, state, part);
    }
    apply_external_requests(state, lanes, group);
    for (std::size_t k = 0; k < tables.drivers.size(); ++k) {
        const int only = tables.drivers.size() == 1 ? -1 : static_cast<int>(k);
        const auto plan = model.drivers[k].is_human ? kernels.plan_human : kernels.plan;
        plan(tables.drivers[k], group, lanes.vehicles, model.step_s, only, streams,
             k == 0 ? next : std::span<const int>());
    }
    for (std::size_t k = 0; k < tables.vehicles.size(); ++k) {
        const int only = tables.vehicles.size() == 1 ? -1 : static_cast<int>(k);
        kernels.drive(tables.vehicles[k], group, lanes.vehicles, model.step_s, only, streams,
                      k == 0 ? next : std::span<const int>());
    }
    kernels.scatter(streams, lanes.lanes, group, model.step_s);
    if (state.vehicles.has_v2v_channel) send_messages(model, lanes.lanes, group, state, part);
    const std::int64_t count = count_overlaps(state.vehicles, lanes.lanes);
    if (count > 0) record_first_overlap(model, state, part);
    part.violations.overlaps += count;
}

}  // namespace stopline
