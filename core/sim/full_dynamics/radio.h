// How a vehicle receives the messages of one sender over an active V2V channel (V2vPlan).
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/containers/index.h"
#include "sim/state/model.h"
#include "sim/state/state.h"
#include "v2v/plan.h"
#include "v2v/receiver.h"

namespace stopline {

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
    V2vArrivals& arrivals() const { return v_.v2v.arrivals[slot_]; }

    void forget(int sender) const {
        v_.v2v.sender[slot_] = sender;
        v_.v2v.sent_tick[slot_] = kNeverSent;
    }
    // Stores message `number` of the sender as the newest message.
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
    V2vArrivals& arrivals() const { return own_.platoon_arrivals; }

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
        messages_.arrivals() = {};
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

    // Takes the messages that arrive up to this step, and sets due_tick() to the next arrival. Call in each step with
    // due_tick() <= the tick.
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
        if (plan.longest_jitter_ticks > 0) receive_late_messages();
    }

private:
    // Takes the messages that have been on their way until this step.
    void receive_late_messages() const {
        const V2vLink& link = messages_.link();
        V2vArrivals& arrivals = messages_.arrivals();
        for (std::size_t k = 0; k < arrivals.tick.size(); ++k) {
            const int arrival = arrivals.tick[k];
            if (arrival > step_.tick) messages_.due_tick() = std::min(messages_.due_tick(), arrival);
            if (arrival != step_.tick) continue;
            arrivals.tick[k] = -1;
            const int number = arrivals.number[k];
            const int sent_tick = link.next_sent_tick - (link.next_number - number) * step_.plan.interval_ticks;
            if (sent_tick > messages_.sent_tick()) messages_.hold(number, sent_tick);
        }
    }

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

    // Stores a message that is on its way in a free entry. Without one, it overwrites an older message that would
    // arrive later.
    void await(int number, int arrival) const {
        V2vArrivals& arrivals = messages_.arrivals();
        for (std::size_t k = 0; k < arrivals.tick.size(); ++k) {
            if (arrivals.tick[k] >= 0 && arrivals.tick[k] < arrival) continue;
            arrivals.tick[k] = arrival;
            arrivals.number[k] = number;
            return;
        }
    }

    const RadioStep& step_;
    int intersection_;
    int slot_;
    Messages messages_;
};

}  // namespace stopline
