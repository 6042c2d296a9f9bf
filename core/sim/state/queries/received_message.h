// The newest V2V message that one vehicle has received from another vehicle. Cooperative clearing
// and cooperative gap opening use this query, because they do not need every message.
#pragma once

#include <cstdint>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns true if the vehicles send over a channel with delays or losses. Without such a channel,
// messages have no delay and are never lost.
inline bool uses_channel(const Model& model) { return model.v2v_plan.channel != nullptr; }

struct MessageLink {
    int sender = -1;    // slot
    int receiver = -1;  // slot
    int receiver_lane = -1;
    double distance_m = 0.0;  // between the two vehicles
};

inline constexpr std::int64_t kNoMessage = -1;

// Returns the tick at which the sender sent the newest message that has arrived. Returns kNoMessage if no message of
// the last `longest_age_ticks` has arrived. Precondition: uses_channel().
std::int64_t newest_message_tick(const Model& model, const State& state, const MessageLink& link,
                                 std::int64_t longest_age_ticks);

}  // namespace stopline
