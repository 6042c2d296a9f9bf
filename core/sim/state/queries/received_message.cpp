#include "sim/state/queries/received_message.h"

#include <algorithm>

#include "base/containers/index.h"

namespace stopline {

std::int64_t newest_message_tick(const Model& model, const State& state, const MessageLink& link,
                                 std::int64_t longest_age_ticks) {
    const V2vPlan& plan = model.v2v_plan;
    if (link.distance_m > plan.settings.range_m) return kNoMessage;
    const int sender = state.vehicles.id[at(link.sender)];
    V2vMessage message;
    message.link_key = link_key(plan.key, sender, state.vehicles.id[at(link.receiver)]);
    message.distance_m = link.distance_m;
    if (plan.channel->reads_density)
        message.density_vpkm = state.vehicles_per_km[at(state.plan.intersection_of(link.receiver_lane))];
    const std::int64_t first_tick = first_send_tick(plan, sender);
    const std::int64_t oldest_tick = std::max(state.tick - longest_age_ticks, first_tick);
    const std::int64_t last_tick = state.tick - plan.delay_ticks;
    if (last_tick < oldest_tick) return kNoMessage;
    for (std::int64_t number = (last_tick - first_tick) / plan.interval_ticks;; --number) {
        const std::int64_t sent_tick = first_tick + number * plan.interval_ticks;
        if (sent_tick < oldest_tick) return kNoMessage;
        message.number = number;
        if (sent_tick + plan.delay_ticks + jitter_ticks(plan, message.link_key, number) > state.tick) continue;
        if (plan.channel->is_delivered == nullptr || plan.channel->is_delivered(plan.settings, message))
            return sent_tick;
    }
}

}  // namespace stopline
