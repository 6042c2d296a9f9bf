// The V2V data that a vehicle has received.
#pragma once

#include <array>

#include "v2v/fallback.h"
#include "v2v/leader_filter.h"
#include "v2v/plan.h"

namespace stopline {

inline constexpr int kNeverSent = -1'000'000'000;

// The messages of one sender.
struct Reception {
    int sender = -1;  // id; -1: none
    // The newest message that has arrived: the tick at which it was sent, and its content.
    int sent_tick = kNeverSent;
    float acceleration_mps2 = 0.0F;
    float request_mps2 = 0.0F;
    float rate_1ps = 1.0F;
    float speed_mps = 0.0F;  // only from the platoon leader
    int due_tick = 0;        // first tick at which the next message of the sender can arrive
    // Messages that are on their way.
    std::array<int, kJitterIntervals> arrival_tick{-1, -1};  // -1: none
    std::array<int, kJitterIntervals> arriving_sent_tick{};
};

struct V2vReceiver {
    Reception leader;
    Reception platoon_leader;  // only if V2vPlan::uses_platoon_leader
    // Set only for the slot before the first vehicle of a lane: slot of the leader; -1: none.
    int sender_slot = -1;
    bool leader_has_v2v = false;
    Fallback fallback;
    LeaderEstimate estimate;
    // The platoon: id and slot of its first vehicle, and number of vehicles ahead in it. A vehicle alone is a platoon,
    // too. The slot before the first vehicle of a lane has a copy from the leader beyond the lane, as of the previous
    // step.
    int platoon = -1;
    int platoon_leader_slot = -1;
    int place_in_platoon = 0;
    // The vehicle leads a mini-platoon: the platoon ahead is full (PlatoonSettings::max_vehicles).
    bool leads_mini_platoon = false;
};

}  // namespace stopline
