// The V2V data that vehicles have received, for runs with an active channel (V2vPlan).
#pragma once

#include <array>
#include <cstddef>

#include "base/simd/huge_page_allocator.h"
#include "v2v/channel.h"
#include "v2v/fallback.h"
#include "v2v/plan.h"

namespace stopline {

inline constexpr int kNeverSent = -1'000'000'000;
inline constexpr int kNeverDue = 2'000'000'000;

// The content of a message.
struct SentMessage {
    float acceleration_mps2 = 0.0F;
    float request_mps2 = 0.0F;
    float rate_1ps = 1.0F;
    float speed_mps = 0.0F;
};

// The next message of one sender: the tick at which it is sent, and its number.
struct V2vLink {
    int next_sent_tick = kNeverDue;  // kNeverDue: the sender has no V2V
    int next_number = 0;
    // Result of the message before, if the channel has decided about it.
    V2vMessage::Result previous = V2vMessage::Result::unknown;
};

// The messages of one sender that are on their way. Only channels with jitter use them.
struct V2vArrivals {
    std::array<int, kJitterIntervals> tick{-1, -1};  // -1: none
    std::array<int, kJitterIntervals> number{};
};

// The memory of the driving mode for the hysteresis (FallbackModeOf). It has no meaning in the mode `messages`.
struct V2vModeMemory {
    int worst = 0;
    int since_tick = 0;
};

// The newest message that has arrived from a platoon leader.
struct PlatoonLeaderMessage {
    int sender = -1;  // id; -1: none
    int due_tick = kNeverDue;
    int sent_tick = kNeverSent;
    float request_mps2 = 0.0F;
    float speed_mps = 0.0F;
};

// The data of a vehicle that not every step reads.
struct V2vReceiver {
    // Set only for the slot before the first vehicle of a lane: slot of the leader; -1: none.
    int sender_slot = -1;
    bool leader_has_v2v = false;
    // The vehicle leads a mini-platoon: the platoon ahead is full (PlatoonSettings::max_vehicles).
    bool leads_mini_platoon = false;
    // The platoon: id and slot of its first vehicle, and number of vehicles ahead in it. A vehicle alone is a platoon,
    // too. The slot before the first vehicle of a lane has a copy from the leader beyond the lane, as of the previous
    // step.
    int platoon = -1;
    int platoon_leader_slot = -1;
    int place_in_platoon = 0;
    // Only if V2vPlan::uses_platoon_leader.
    V2vMode driving_mode = V2vMode::messages;  // V2vReceivers::mode, or V2vMode::platoon_leader
    V2vLink platoon_link;
    V2vArrivals platoon_arrivals;
    PlatoonLeaderMessage platoon_message;
};

// One value for each slot. The slots without an active channel have no values.
struct V2vReceivers {
    LargeArray<int> sender;  // id of the leader; -1: none
    // First tick at which something can happen: the leader's next message can arrive, one that is on its way arrives,
    // or the driving mode can change.
    LargeArray<int> due_tick;
    // The newest message of the leader that has arrived: the tick at which it was sent, and its content.
    LargeArray<int> sent_tick;
    LargeArray<float> acceleration_mps2;
    LargeArray<float> request_mps2;
    LargeArray<float> rate_1ps;
    // The estimate of the leader's motion from radar (leader_filter.h).
    LargeArray<float> leader_mps;
    LargeArray<float> leader_mps2;
    // The fallback (fallback.h).
    LargeArray<int> mode;  // V2vMode, by the age of the leader's messages
    LargeArray<V2vModeMemory> mode_memory;
    LargeArray<float> time_gap_s;
    LargeArray<float> time_gap_rate;
    // The vehicle's own messages: the next tick at which it sends, and its last messages [slot][number].
    LargeArray<int> send_tick;
    LargeArray<SentMessage> sent;
    int stored_messages = 1;   // V2vPlan::stored_messages()
    LargeArray<V2vLink> link;  // messages of the leader
    LargeArray<V2vArrivals> arrivals;
    LargeArray<V2vReceiver> rest;

    // Visits all arrays with one value for each slot.
    template <class Visit>
    void for_each(Visit visit) {
        visit(sender), visit(due_tick), visit(sent_tick), visit(acceleration_mps2), visit(request_mps2);
        visit(rate_1ps), visit(leader_mps), visit(leader_mps2), visit(mode), visit(mode_memory);
        visit(time_gap_s), visit(time_gap_rate), visit(send_tick), visit(link), visit(arrivals), visit(rest);
    }
    // Sets the data of a vehicle that has not received anything yet.
    void reset(int slot) {
        const auto i = static_cast<std::size_t>(slot);
        for_each([i](auto& array) { array[i] = {}; });
        sender[i] = -1;
        due_tick[i] = kNeverDue;
        sent_tick[i] = kNeverSent;
        rate_1ps[i] = 1.0F;
        send_tick[i] = kNeverSent;
    }
    // Returns the place of a message in `sent`.
    std::size_t index_of(int slot, int number) const {
        const auto messages = static_cast<unsigned>(stored_messages);
        return static_cast<std::size_t>(static_cast<unsigned>(slot) * messages) +
               (static_cast<unsigned>(number) & (messages - 1));
    }
    V2vMode mode_of(int slot) const { return static_cast<V2vMode>(mode[static_cast<std::size_t>(slot)]); }
};

}  // namespace stopline
