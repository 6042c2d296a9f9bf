#include "sim/full_dynamics/receive_messages.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "driver/acceleration_laws.h"
#include "sim/full_dynamics/platoons.h"
#include "sim/state/queries/response_time.h"
#include "v2v/platoon_place.h"

namespace stopline {

namespace {

// The values of a step that all vehicles share.
struct RadioStep {
    const Model& model;
    const V2vPlan& plan;
    State& state;
    int tick;
};

// The newest message of the leader, and the messages that are on their way.
class LeaderMessages {
public:
    LeaderMessages(const RadioStep& step, int slot, int sender_slot)
        : v_(step.state.vehicles), slot_(at(slot)), sender_slot_(sender_slot) {}

    int sender() const { return v_.v2v.sender[slot_]; }
    int& due_tick() const { return v_.v2v.due_tick[slot_]; }
    int sent_tick() const { return v_.v2v.sent_tick[slot_]; }
    V2vLink& link() const { return v_.v2v.link[slot_]; }

    void forget(int sender) const {
        v_.v2v.sender[slot_] = sender;
        v_.v2v.sent_tick[slot_] = kNeverSent;
    }
    // Replaces the newest message by the one with a number.
    void hold(int number, int sent_tick) const {
        const SentMessage& message = v_.v2v.sent[v_.v2v.index_of(sender_slot_, number)];
        v_.v2v.sent_tick[slot_] = sent_tick;
        v_.v2v.acceleration_mps2[slot_] = message.acceleration_mps2;
        v_.v2v.request_mps2[slot_] = message.request_mps2;
        v_.v2v.rate_1ps[slot_] = message.rate_1ps;
    }

private:
    VehicleArrays& v_;
    std::size_t slot_;
    int sender_slot_;
};

// The same for the messages of the platoon leader.
class PlatoonLeaderMessages {
public:
    PlatoonLeaderMessages(const RadioStep& step, int slot, int sender_slot)
        : v_(step.state.vehicles), own_(v_.v2v.rest[at(slot)]), sender_slot_(sender_slot) {}

    int sender() const { return own_.platoon_message.sender; }
    int& due_tick() const { return own_.platoon_message.due_tick; }
    int sent_tick() const { return own_.platoon_message.sent_tick; }
    V2vLink& link() const { return own_.platoon_link; }

    void forget(int sender) const {
        own_.platoon_message.sender = sender;
        own_.platoon_message.sent_tick = kNeverSent;
    }
    void hold(int number, int sent_tick) const {
        const SentMessage& message = v_.v2v.sent[v_.v2v.index_of(sender_slot_, number)];
        own_.platoon_message.sent_tick = sent_tick;
        own_.platoon_message.request_mps2 = message.request_mps2;
        own_.platoon_message.speed_mps = message.speed_mps;
    }

private:
    VehicleArrays& v_;
    V2vReceiver& own_;
    int sender_slot_;
};

// The radio of a vehicle for the messages of one sender. `Messages`: LeaderMessages or PlatoonLeaderMessages.
template <class Messages>
class Radio {
public:
    Radio(const RadioStep& step, int intersection, int slot, int sender_slot)
        : step_(step), intersection_(intersection), slot_(slot), messages_(step, slot, sender_slot) {}

    int sender() const { return messages_.sender(); }
    int age_ticks() const { return step_.tick - messages_.sent_tick(); }

    // Starts to listen to another sender. Messages of this sender that have already arrived count, because a vehicle
    // hears all vehicles within the range. `has_v2v`: the sender sends messages.
    void set_sender(int sender, bool has_v2v) const {
        messages_.forget(sender);
        messages_.due_tick() = kNeverDue;
        V2vLink& link = messages_.link();
        link = {};
        if (!has_v2v) return;
        const V2vPlan& plan = step_.plan;
        // The oldest message that the sender still stores. It may be from before the start of the run.
        const int first = first_send_tick(plan, sender);
        link.next_sent_tick = next_send_tick(plan, first, step_.tick - plan.stored_ticks());
        link.next_number = (link.next_sent_tick - first) / plan.interval_ticks;
        messages_.due_tick() = link.next_sent_tick + plan.delay_ticks;
    }

    // Takes the messages that arrive up to this step. Call in each step with due_tick() <= the tick.
    void receive(double distance_m) const {
        const V2vPlan& plan = step_.plan;
        V2vLink& link = messages_.link();
        while (link.next_sent_tick + plan.delay_ticks <= step_.tick) {
            const int sent_tick = link.next_sent_tick;
            const int number = link.next_number;
            const int arrival = arrival_tick(distance_m);
            link.next_sent_tick += plan.interval_ticks;
            ++link.next_number;
            if (arrival < 0) continue;
            if (arrival <= step_.tick) {
                messages_.hold(number, sent_tick);
            } else {
                await(number, arrival);
            }
        }
        messages_.due_tick() = link.next_sent_tick + plan.delay_ticks;
        if (plan.longest_jitter_ticks == 0) return;
        for (std::size_t k = 0; k < link.arrival_tick.size(); ++k) {
            const int arrival = link.arrival_tick[k];
            if (arrival > step_.tick) messages_.due_tick() = std::min(messages_.due_tick(), arrival);
            if (arrival != step_.tick) continue;
            link.arrival_tick[k] = -1;
            const int number = link.arriving_number[k];
            const int sent_tick = link.next_sent_tick - (link.next_number - number) * plan.interval_ticks;
            if (sent_tick > messages_.sent_tick()) messages_.hold(number, sent_tick);
        }
    }

private:
    // Returns the tick at which the receiver gets the next message; -1: the message is lost.
    int arrival_tick(double distance_m) const {
        const V2vPlan& plan = step_.plan;
        V2vLink& link = messages_.link();
        if (distance_m > plan.settings.range_m) {
            link.previous = V2vMessage::Result::unknown;
            return -1;
        }
        V2vMessage message;
        message.link_key = link_key(plan.key, sender(), step_.state.vehicles.id[at(slot_)]);
        message.number = link.next_number;
        message.distance_m = distance_m;
        message.previous = link.previous;
        if (plan.channel->reads_density) message.density_vpkm = step_.state.vehicles_per_km[at(intersection_)];
        const bool arrives =
            plan.channel->is_delivered == nullptr || plan.channel->is_delivered(plan.settings, message);
        link.previous = arrives ? V2vMessage::Result::delivered : V2vMessage::Result::lost;
        if (!arrives) return -1;
        return link.next_sent_tick + plan.delay_ticks + jitter_ticks(plan, message.link_key, message.number);
    }

    // Stores a message that is on its way. It takes the place of a message that has arrived, or of one that will arrive
    // later although it was sent earlier.
    void await(int number, int arrival) const {
        V2vLink& link = messages_.link();
        for (std::size_t k = 0; k < link.arrival_tick.size(); ++k) {
            if (link.arrival_tick[k] >= 0 && link.arrival_tick[k] < arrival) continue;
            link.arrival_tick[k] = arrival;
            link.arriving_number[k] = number;
            return;
        }
    }

    const RadioStep& step_;
    int intersection_;
    int slot_;
    Messages messages_;
};

// Returns true if the vehicle at `place` follows its leader at about the desired gap. `was_following`: it did before.
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
    s.sent_tick = r.sent_tick.data();
    s.acceleration = r.acceleration_mps2.data();
    s.request = r.request_mps2.data();
    s.rate = r.rate_1ps.data();
    s.leader_speed = r.leader_mps.data();
    s.leader_acceleration = r.leader_mps2.data();
    s.mode = r.mode.data();
    s.worst_mode = r.worst_mode.data();
    s.mode_since_tick = r.mode_since_tick.data();
    s.time_gap = r.time_gap_s.data();
    s.time_gap_rate = r.time_gap_rate.data();
    s.own_speed_now = v.own_speed_mps.data() + state.radar.now;
    s.own_speed_delayed = v.own_speed_mps.data() + state.radar.delayed;
    return s;
}

// Prefetches the data of the next lane group. `next`: LaneGroup::prefetch_slots.
void prefetch(const ReceiveStreams& s, const int* send_tick, std::span<const int> next) {
    for (const int slot : next) {
        for (const int* array : {s.sender, s.due_tick, s.sent_tick, send_tick}) __builtin_prefetch(array + slot);
        for (const int* array : {s.id, static_cast<const int*>(s.mode)}) __builtin_prefetch(array + slot);
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
    s.hysteresis_ticks = plan.hysteresis_ticks;
    std::copy(plan.longest_age_ticks.begin(), plan.longest_age_ticks.end(), s.longest_age_ticks.begin());
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
    ReceivePhase(const RadioStep& step, std::span<const LaneStep> lanes, const FullGroup& group, ReceiveWork& work)
        : step_(step), v_(step.state.vehicles), lanes_(lanes), g_(group), work_(work) {}

    // Prefetches what listen() reads.
    void prefetch(const DueReceiver& due) const {
        __builtin_prefetch(&v_.v2v.link[at(due.slot)], 1);
        __builtin_prefetch(&v_.v2v.sent[v_.v2v.index_of(due.slot - 1, 0)]);
        __builtin_prefetch(&v_.v2v.rest[at(due.slot)]);
    }

    // Receives the messages of the leader that are due. Listens to another leader if the leader has changed.
    void listen(const DueReceiver& due) const {
        const LaneStep& lane = lanes_[at(due.lane)];
        const int slot = due.slot;
        const int sender = v_.id[at(slot - 1)];
        if (is_human(slot)) {
            v_.v2v.sender[at(slot)] = sender;
            return;
        }
        V2vReceiver& own = v_.v2v.rest[at(slot)];
        const int sender_slot = slot == lane.begin ? v_.v2v.rest[at(slot - 1)].sender_slot : slot - 1;
        const Radio<LeaderMessages> radio(step_, lane.intersection, slot, sender_slot);
        if (sender != radio.sender()) {
            own.leader_has_v2v = sender >= 0 && !is_human(sender_slot);
            own.leads_mini_platoon = false;
            radio.set_sender(sender, own.leader_has_v2v);
            const float speed_mps = v_.own_speed_mps[step_.state.radar.delayed + at(slot)];
            v_.v2v.leader_mps[at(slot)] =
                static_cast<float>(static_cast<double>(speed_mps) - static_cast<double>(g_.closing[due.place]));
            v_.v2v.leader_mps2[at(slot)] = 0.0F;
        }
        if (own.leader_has_v2v) radio.receive(g_.gap[due.place]);
    }

    // Updates the platoons, from front to rear of each lane.
    void find_platoons() const {
        for_each_radio([&](const LaneStep& /*lane*/, int slot, int place) {
            V2vReceiver& own = v_.v2v.rest[at(slot)];
            PlatoonLink link;
            link.leader = v_.v2v.sender[at(slot)] < 0 ? nullptr : &v_.v2v.rest[at(slot - 1)];
            link.leader_has_v2v = own.leader_has_v2v;
            link.is_following = follows(g_, place, own.place_in_platoon > 0 || own.leads_mini_platoon);
            link.is_stopped = static_cast<double>(g_.speed[place]) <= kBrakeHoldSpeed_mps;
            update_platoon(link, step_.plan.max_platoon, v_.id[at(slot)], slot, own);
            work_.mini_leader[at(place)] = own.leads_mini_platoon ? 1.0F : 0.0F;
            work_.keeps_distance[at(place)] = g_.slope[place] <= 0.0 ? 1 : 0;
        });
    }

    void follow_platoon_leaders() const {
        for_each_radio([&](const LaneStep& lane, int slot, int place) {
            if (v_.v2v.sender[at(slot)] >= 0 && work_.keeps_distance[at(place)] != 0)
                follow_platoon_leader(lane, slot, place);
        });
    }

    void record_mode_changes(const ReceiveResults& results, Partition& part) const {
        for (std::size_t mode = 0; mode < kV2vModes; ++mode) part.v2v_mode_steps[mode] += results.mode_steps[mode];
        for (int k = 0; k < results.changes; ++k) {
            const V2vModeStep& change = results.mode_changes[k];
            const std::size_t slot = at(change.slot);
            const int sent_tick = v_.v2v.sent_tick[slot];
            const double age_s = (step_.tick - sent_tick) * step_.model.step_s;
            part.v2v_mode_changes.push_back({step_.model.time_s(step_.tick), v_.id[slot], v_.v2v.sender[slot],
                                             change.from_mode, change.to_mode,
                                             sent_tick == kNeverSent ? -1.0F : static_cast<float>(age_s),
                                             g_.gap[change.place], g_.speed[change.place]});
        }
    }

private:
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

    // Receives the messages of the platoon leader, and replaces the law for following by that of Rajamani while they
    // are recent. To replace the law, the desired gap becomes so small that it does not limit the acceleration, and
    // the law of Rajamani becomes an external demand. All other laws, such as emergency braking, stay as they are. A
    // vehicle that is too close to its leader keeps the law of its policy, because the law of Rajamani would follow the
    // platoon leader's start even if its own leader still stands.
    // Precondition: the spacing policy keeps a constant distance at this speed.
    void follow_platoon_leader(const LaneStep& lane, int slot, int place) const {
        constexpr double kLongestAge_s = 0.15;  // our choice, after the states of PlatoonSAFE
        constexpr double kUnlimitedGap_m = -1e3;
        constexpr double kTooClose_m = 0.5;
        const V2vReceiver& own = v_.v2v.rest[at(slot)];
        const int sender_slot = own.platoon_leader_slot;
        const Radio<PlatoonLeaderMessages> radio(step_, lane.intersection, slot, sender_slot);
        const int sender = own.place_in_platoon > 0 ? own.platoon : -1;
        if (sender != radio.sender()) radio.set_sender(sender, sender >= 0);
        if (sender < 0) return;
        // For one step after the platoon leader has changed its lane, its slot is not known.
        // The distance is that to the leader times the number of vehicles between.
        if (v_.id[at(sender_slot)] == sender && own.platoon_message.due_tick <= step_.tick) {
            const double spacing_m = static_cast<double>(g_.gap[place]) + static_cast<double>(v_.length_m[at(slot)]);
            radio.receive(own.place_in_platoon * spacing_m);
        }
        if (v_.v2v.mode_of(slot) != V2vMode::messages || radio.age_ticks() * step_.model.step_s > kLongestAge_s) return;
        if (static_cast<double>(g_.gap[place]) < g_.desired_gap[place] - kTooClose_m) return;
        const double u = platoon_acceleration(step_.plan.settings.platoon_law,
                                              step_.model.driver_of(v_.policy[at(slot)]).tables.cacc, g_, place,
                                              own.platoon_message.request_mps2, own.platoon_message.speed_mps);
        g_.demand[place] = std::min(g_.demand[place], static_cast<float>(u));
        g_.desired_gap[place] = kUnlimitedGap_m;
        g_.slope[place] = 0.0;
    }

    const RadioStep& step_;
    VehicleArrays& v_;
    std::span<const LaneStep> lanes_;
    const FullGroup& g_;
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
    constexpr int kAhead = 4;
    const V2vPlan& plan = model.v2v_plan;
    const RadioStep step{model, plan, state, static_cast<int>(state.tick)};
    ReceiveWork& work = part.receive_work;
    work.reserve(at(lanes.vehicles) + kSimdWidth);
    const ReceivePhase phase(step, lanes.lanes, group, work);
    const ReceiveStreams streams = streams_of(state);
    const int due = kernels.list_due(streams, lanes.lanes, step.tick, group, work.due.data());
    for (int k = 0; k < due; ++k) {
        if (k + kAhead < due) phase.prefetch(work.due[at(k + kAhead)]);
        phase.listen(work.due[at(k)]);
    }
    if (plan.uses_platoon_leader || plan.max_platoon > 0) phase.find_platoons();
    ReceiveResults results;
    results.mode_changes = work.mode_changes.data();
    if (plan.max_platoon > 0) results.mini_leader = work.mini_leader.data();
    kernels.receive(receive_step(step, policies), streams, lanes.lanes, group, results);
    phase.record_mode_changes(results, part);
    prefetch(streams, state.vehicles.v2v.send_tick.data(), next);
    if (plan.uses_platoon_leader) phase.follow_platoon_leaders();
}

void send_messages(const Model& model, const FullKernels& kernels, const LaneGroup& lanes, State& state,
                   Partition& part) {
    const V2vPlan& plan = model.v2v_plan;
    VehicleArrays& v = state.vehicles;
    const int tick = static_cast<int>(state.tick);
    std::vector<DueReceiver>& due = part.receive_work.due;
    const int senders = kernels.list_senders(v.v2v.send_tick.data(), lanes.lanes, tick, due.data());
    for (int k = 0; k < senders; ++k) {
        const int slot = due[at(k)].slot;
        const std::size_t i = at(slot);
        const int first = first_send_tick(plan, v.id[i]);
        int& send_tick = v.v2v.send_tick[i];
        if (send_tick == kNeverSent) send_tick = next_send_tick(plan, first, tick);
        if (send_tick > tick) continue;
        const int number = (send_tick - first) / plan.interval_ticks;
        const std::size_t now = state.v2v.now + i;
        v.v2v.sent[v.v2v.index_of(slot, number)] = {v.v2v_acceleration_mps2[now], v.v2v_request_mps2[now],
                                                    v.v2v_rate_1ps[now], v.own_speed_mps[state.radar.now + i]};
        send_tick += plan.interval_ticks;
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
    // The vehicles of an intersection are within its longest lane, on both sides of the junction.
    constexpr double kKmPerM = 1e-3;
    for (std::size_t k = 0; k < intersections; ++k) {
        state.vehicles_per_km[k] /= static_cast<float>(2.0 * kKmPerM * state.longest_lane_m[k]);
    }
}

}  // namespace stopline
