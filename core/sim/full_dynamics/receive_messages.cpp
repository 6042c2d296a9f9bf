#include "sim/full_dynamics/receive_messages.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "driver/acceleration_laws.h"
#include "sim/full_dynamics/driving_mode.h"
#include "sim/full_dynamics/platoons.h"
#include "sim/full_dynamics/radio.h"
#include "sim/state/queries/response_time.h"
#include "v2v/platoon_place.h"

namespace stopline {

namespace {

// Returns true if the vehicle at `place` is no platoon leader and close enough to its leader for a platoon.
// `was_following`: it was close enough before.
bool follows(const FullGroup& g, int place, bool was_following) {
    const double excess_m = static_cast<double>(g.gap[place]) - g.desired_gap[place];
    return g.is_platoon_leader[place] == 0.0F && is_close_enough(excess_m, was_following);
}

ReceiveStreams streams_of(State& state) {
    VehicleArrays& v = state.vehicles;
    V2vReceivers& r = v.v2v;
    ReceiveStreams s{};
    s.id = v.id.data();
    s.sender = r.sender.data();
    s.due_tick = r.due_tick.data();
    s.send_tick = r.send_tick.data();
    s.sent_tick = r.sent_tick.data();
    s.acceleration = r.acceleration_mps2.data();
    s.request = r.request_mps2.data();
    s.rate = r.rate_1ps.data();
    s.leader_speed = r.leader_mps.data();
    s.leader_acceleration = r.leader_mps2.data();
    s.mode = r.mode.data();
    s.time_gap = r.time_gap_s.data();
    s.time_gap_rate = r.time_gap_rate.data();
    s.own_speed_now = v.own_speed_mps.data() + state.radar.now;
    s.own_speed_delayed = v.own_speed_mps.data() + state.radar.delayed;
    return s;
}

// Prefetches the data of the next lane group. `next`: LaneGroup::prefetch_slots.
void prefetch(const ReceiveStreams& s, std::span<const int> next) {
    for (const int slot : next) {
        for (const int* array : {s.sender, s.due_tick, s.sent_tick, s.send_tick}) __builtin_prefetch(array + slot);
        for (const int* array : {s.id, s.mode}) __builtin_prefetch(array + slot);
        for (const float* array : {s.acceleration, s.request, s.rate, s.own_speed_delayed}) {
            __builtin_prefetch(array + slot);
        }
        for (const float* array :
             {s.leader_speed, s.leader_acceleration, s.time_gap, s.time_gap_rate, s.own_speed_now}) {
            __builtin_prefetch(array + slot, 1);
        }
    }
}

ReceiveStep receive_step(const RadioStep& step, std::span<const ReceivePolicy> policies) {
    const V2vPlan& plan = step.plan;
    ReceiveStep s;
    s.tick = step.tick;
    s.step_s = step.model.step_s;
    s.delay_ticks = plan.delay_ticks;
    s.stable_time_gap_s = plan.time_gap_of_age_s;
    s.radar_time_gap_s = plan.settings.fallback.radar_time_gap_s;
    s.acc_time_gap_s = plan.settings.fallback.acc_time_gap_s;
    s.platoon_time_gap_s = plan.platoon_time_gap_s;
    s.filter = plan.filter;
    s.policies = policies;
    return s;
}

// The receive phase for the vehicles of a lane group.
class ReceivePhase {
public:
    ReceivePhase(const RadioStep& step, std::span<const LaneStep> lanes, const FullGroup& group, Partition& part)
        : step_(step), v_(step.state.vehicles), lanes_(lanes), g_(group), part_(part), work_(part.receive_work) {}

    // Receives the messages for the vehicles in ReceiveWork::due and updates their driving modes.
    void listen() const {
        constexpr int kAhead = 6;
        const int all = lanes_.empty() ? 0 : work_.due_end[lanes_.size() - 1];
        for (int k = 0; k < std::min(kAhead, all); ++k) prefetch(work_.due[at(k)]);
        int k = 0;
        int place = 0;
        for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
            const int slot_to_place = place - lanes_[lane].begin;
            for (; k < work_.due_end[lane]; ++k) {
                if (k + kAhead < all) prefetch(work_.due[at(k + kAhead)]);
                const int slot = work_.due[at(k)];
                listen(lanes_[lane], slot, slot + slot_to_place);
            }
            place += lanes_[lane].count();
        }
    }

    // Returns true if the vehicle could hear the leader of the platoon that it joins behind `leader`. The distance is
    // estimated as the own spacing times the number of vehicles ahead.
    bool is_leader_in_range(const V2vReceiver* leader, int slot, int place) const {
        if (!step_.plan.uses_platoon_leader || leader == nullptr) return true;
        const double spacing_m = static_cast<double>(g_.gap[place]) + static_cast<double>(v_.length_m[at(slot)]);
        return (leader->place_in_platoon + 1) * spacing_m <= step_.plan.settings.range_m;
    }

    // Updates the platoons, from front to rear of each lane.
    void find_platoons() const {
        for_each_radio([&](const LaneStep& /*lane*/, int slot, int place) {
            V2vReceiver& own = v_.v2v.rest[at(slot)];
            PlatoonLink link;
            link.leader = v_.v2v.sender[at(slot)] < 0 ? nullptr : &v_.v2v.rest[at(slot - 1)];
            link.leader_has_v2v = own.leader_has_v2v;
            link.is_following = follows(g_, place, own.place_in_platoon > 0 || own.leads_mini_platoon) &&
                                is_leader_in_range(link.leader, slot, place);
            link.is_stopped = static_cast<double>(g_.speed[place]) <= kBrakeHoldSpeed_mps;
            update_platoon(link, step_.plan.max_platoon, v_.id[at(slot)], slot, own);
            work_.mini_leader[at(place)] = own.leads_mini_platoon ? 1.0F : 0.0F;
            work_.keeps_distance[at(place)] = g_.slope[place] <= 0.0 ? 1 : 0;
        });
    }

    void follow_platoon_leaders() const {
        for_each_radio([&](const LaneStep& lane, int slot, int place) {
            if (v_.v2v.sender[at(slot)] < 0) return;
            const bool follows = work_.keeps_distance[at(place)] != 0 && follow_platoon_leader(lane, slot, place);
            const V2vMode mode = follows ? V2vMode::platoon_leader : v_.v2v.mode_of(slot);
            if (follows) {
                ++part_.v2v_mode_steps[number(V2vMode::platoon_leader)];
                --part_.v2v_mode_steps[number(V2vMode::messages)];
            }
            V2vMode& before = v_.v2v.rest[at(slot)].driving_mode;
            if (mode != before) record_mode_change(slot, place, before, mode);
            before = mode;
        });
    }

private:
    // Prefetches what listen() reads.
    void prefetch(int slot) const {
        __builtin_prefetch(&v_.v2v.link[at(slot)], 1);
        __builtin_prefetch(&v_.v2v.sent[v_.v2v.index_of(slot - 1, 0)]);
    }

    // Receives the messages of the leader that are due. Listens to another leader if the leader has changed. Updates
    // the driving mode.
    void listen(const LaneStep& lane, int slot, int place) const {
        const std::size_t i = at(slot);
        const int sender = v_.id[i - 1];
        if (is_human(slot)) {
            v_.v2v.sender[i] = sender;
            return;
        }
        const AgeOfMessages before{v_.v2v.sender[i] >= 0, v_.v2v.sent_tick[i]};
        const int sender_slot = slot == lane.begin ? v_.v2v.rest[i - 1].sender_slot : slot - 1;
        const Radio<LeaderMessages> radio(step_, lane.intersection, slot, sender_slot);
        if (sender != radio.sender()) {
            V2vReceiver& own = v_.v2v.rest[i];
            own.leader_has_v2v = sender >= 0 && !is_human(sender_slot);
            own.leads_mini_platoon = false;
            radio.set_sender(sender, own.leader_has_v2v);
            const float speed_mps = v_.own_speed_mps[step_.state.radar.delayed + i];
            v_.v2v.leader_mps[i] =
                static_cast<float>(static_cast<double>(speed_mps) - static_cast<double>(g_.closing[place]));
            v_.v2v.leader_mps2[i] = 0.0F;
        }
        radio.receive(g_.gap[place]);
        update_mode(slot, place, before);
    }

    // Updates the driving mode after the messages of the step. Lowers due_tick to the tick at which the mode can
    // change.
    void update_mode(int slot, int place, const AgeOfMessages& before) const {
        const std::size_t i = at(slot);
        const AgeOfMessages now{v_.v2v.sender[i] >= 0, v_.v2v.sent_tick[i]};
        int& mode = v_.v2v.mode[i];
        const int longest = step_.plan.longest_age_ticks[0];
        int next = now.sent_tick + longest + 1;
        if (mode != 0 || next <= step_.tick) {
            const int mode_before = mode;
            next = update_driving_mode(step_.plan, step_.tick, before, now, mode, v_.v2v.mode_memory[i]);
            // With the topology predecessor_and_leader, follow_platoon_leaders() records the changes.
            if (mode != mode_before && !step_.plan.uses_platoon_leader) {
                record_mode_change(slot, place, static_cast<V2vMode>(mode_before), v_.v2v.mode_of(slot));
            }
        }
        v_.v2v.due_tick[i] = std::min(v_.v2v.due_tick[i], next);
    }

    void record_mode_change(int slot, int place, V2vMode from, V2vMode to) const {
        const std::size_t i = at(slot);
        const int sent_tick = v_.v2v.sent_tick[i];
        const double age_s = (step_.tick - sent_tick) * step_.model.step_s;
        part_.v2v_mode_changes.push_back(
            {step_.model.time_s(step_.tick), v_.id[i], v_.v2v.sender[i], static_cast<int>(from), static_cast<int>(to),
             sent_tick == kNeverSent ? -1.0F : static_cast<float>(age_s), g_.gap[place], g_.speed[place]});
    }

    bool is_human(int slot) const {
        return v_.has_human_drivers && step_.model.driver_of(v_.policy[at(slot)]).is_human;
    }

    // Calls treat(lane, slot, place) for each vehicle without human driver.
    template <class Treat>
    void for_each_radio(Treat treat) const {
        int place = 0;
        for (const LaneStep& lane : lanes_) {
            for (int slot = lane.begin; slot < lane.stop; ++slot, ++place) {
                if (!is_human(slot)) treat(lane, slot, place);
            }
        }
    }

    // Receives the messages of the platoon leader. While they are recent, the law of Rajamani replaces the following
    // law: a tiny desired gap switches the following law off, and the law of Rajamani acts as an external demand. All
    // other laws, such as emergency braking, stay as they are. A vehicle too close to its leader keeps the law of its
    // policy. With the law of Rajamani it would start with the platoon leader, although its leader is stopped.
    // Precondition: the spacing policy keeps a constant distance at this speed.
    // Returns true if the vehicle uses the law of Rajamani.
    bool follow_platoon_leader(const LaneStep& lane, int slot, int place) const {
        constexpr double kUnlimitedGap_m = -1e3;
        constexpr double kTooClose_m = 0.5;
        const V2vReceiver& own = v_.v2v.rest[at(slot)];
        const int sender_slot = own.platoon_leader_slot;
        const Radio<PlatoonLeaderMessages> radio(step_, lane.intersection, slot, sender_slot);
        const int sender = own.place_in_platoon > 0 ? own.platoon : -1;
        if (sender != radio.sender()) radio.set_sender(sender, sender >= 0);
        if (sender < 0) return false;
        // For one step after the platoon leader has changed its lane, its slot is not known.
        // The distance to the platoon leader is estimated as the own spacing times the number of vehicles ahead.
        if (v_.id[at(sender_slot)] == sender && own.platoon_message.due_tick <= step_.tick) {
            const double spacing_m = static_cast<double>(g_.gap[place]) + static_cast<double>(v_.length_m[at(slot)]);
            radio.receive(own.place_in_platoon * spacing_m);
        }
        if (v_.v2v.mode_of(slot) != V2vMode::messages) return false;
        if (radio.age_ticks() * step_.model.step_s > kLongestPlatoonLeaderAge_s) return false;
        if (static_cast<double>(g_.gap[place]) < g_.desired_gap[place] - kTooClose_m) return false;
        const double u = platoon_acceleration(step_.plan.settings.platoon_law,
                                              step_.model.driver_of(v_.policy[at(slot)]).tables.cacc, g_, place,
                                              own.platoon_message.request_mps2, own.platoon_message.speed_mps);
        g_.demand[place] = std::min(g_.demand[place], static_cast<float>(u));
        g_.desired_gap[place] = kUnlimitedGap_m;
        g_.slope[place] = 0.0;
        return true;
    }

    static std::size_t number(V2vMode mode) { return static_cast<std::size_t>(mode); }

    const RadioStep& step_;
    VehicleArrays& v_;
    std::span<const LaneStep> lanes_;
    const FullGroup& g_;
    Partition& part_;
    ReceiveWork& work_;
};

}  // namespace

std::vector<ReceivePolicy> receive_policies(const Model& model) {
    std::vector<ReceivePolicy> policies;
    for (int policy = 0; policy < static_cast<int>(model.policies.size()); ++policy) {
        const DriverPlan& driver = model.driver_of(policy);
        const CaccSettings& cacc = driver.tables.cacc;
        policies.push_back({driver.is_human ? 0.0 : 1.0, response_time_s(model, policy), cacc.emergency_gap_m,
                            cacc.radar_delay_s, cacc.deceleration_emergency_mps2});
    }
    return policies;
}

void receive_messages(const Model& model, const FullKernels& kernels, std::span<const ReceivePolicy> policies,
                      const LaneGroup& lanes, std::span<const int> next, const FullGroup& group, State& state,
                      Partition& part) {
    const V2vPlan& plan = model.v2v_plan;
    const RadioStep step{model, plan, state, static_cast<int>(state.tick)};
    ReceiveWork& work = part.receive_work;
    work.reserve(at(lanes.vehicles) + kSimdWidth);
    const ReceivePhase phase(step, lanes.lanes, group, part);
    const ReceiveStreams streams = streams_of(state);
    const ReceiveLists lists{work.due.data(), work.due_end.data(), work.senders.data(), work.senders_end.data()};
    kernels.list_due(streams, lanes.lanes, step.tick, group, lists);
    phase.listen();
    if (plan.uses_platoon_leader || plan.max_platoon > 0) phase.find_platoons();
    ReceiveResults results;
    if (plan.max_platoon > 0) results.mini_leader = work.mini_leader.data();
    kernels.receive(receive_step(step, policies), streams, lanes.lanes, group, results);
    for (std::size_t mode = 0; mode < kV2vModes; ++mode) part.v2v_mode_steps[mode] += results.mode_steps[mode];
    prefetch(streams, next);
    if (plan.uses_platoon_leader) phase.follow_platoon_leaders();
}

void send_messages(const Model& model, std::span<const LaneStep> lanes, const FullGroup& group, State& state,
                   const Partition& part) {
    const V2vPlan& plan = model.v2v_plan;
    VehicleArrays& v = state.vehicles;
    const int tick = static_cast<int>(state.tick);
    const ReceiveWork& work = part.receive_work;
    int k = 0;
    int place = 0;
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
        const int slot_to_place = place - lanes[lane].begin;
        for (; k < work.senders_end[lane]; ++k) {
            const int slot = work.senders[at(k)];
            int& send_tick = v.v2v.send_tick[at(slot)];
            if (send_tick == kNeverSent) {
                send_tick = next_send_tick(plan, first_send_tick(plan, v.id[at(slot)]), tick);
            }
            if (send_tick > tick) continue;
            const int number = send_tick / plan.interval_ticks;  // message k is sent in interval k
            const std::size_t own = at(slot + slot_to_place);
            v.v2v.sent[v.v2v.index_of(slot, number)] = {group.sent_acceleration[own], group.sent_request[own],
                                                        group.sent_rate[own], group.speed[own]};
            send_tick += plan.interval_ticks;
        }
        place += lanes[lane].count();
    }
}

void measure_density(const Model& model, State& state) {
    if (model.v2v_plan.channel == nullptr || !model.v2v_plan.channel->reads_density) return;
    constexpr double kInterval_s = 1.0;
    if (state.tick % to_ticks(kInterval_s, model.step_s) != 0) return;
    const std::size_t intersections = state.blocks.size();  // the number of an intersection is that of one of its lanes
    state.longest_lane_m.assign(intersections, 1.0);
    state.vehicles_per_km.assign(intersections, 0.0F);
    for (std::size_t lane = 0; lane < state.blocks.size(); ++lane) {
        const std::size_t k = at(state.plan.intersection_of(static_cast<int>(lane)));
        state.longest_lane_m[k] = std::max(state.longest_lane_m[k], state.plan.lane(static_cast<int>(lane)).length_m);
        state.vehicles_per_km[k] += static_cast<float>(state.blocks[lane].count);
    }
    // The roads of an intersection extend by its longest lane to both sides, so the road length is twice this.
    constexpr double kKmPerM = 1e-3;
    for (std::size_t k = 0; k < intersections; ++k) {
        state.vehicles_per_km[k] /= static_cast<float>(2.0 * kKmPerM * state.longest_lane_m[k]);
    }
}

}  // namespace stopline
