#include "sim/clearing/received_messages.h"

#include <algorithm>

#include "base/containers/index.h"
#include "sim/clearing/exit_booking.h"
#include "sim/clearing/keep_clear.h"
#include "sim/state/queries/received_message.h"
#include "sim/state/queries/vehicle_place.h"

namespace stopline {

namespace {

constexpr double kFresh_s = 1.0;  // longest age of a message that a vehicle relies on

// Returns the tick at which the sender sent the newest message that the listener has received; kNoMessage: no message
// of the last kFresh_s has arrived.
std::int64_t newest_fresh_tick(const Model& model, const State& state, const Listener& listener, int sender_slot,
                               double distance_m) {
    return newest_message_tick(model, state, {sender_slot, listener.slot, listener.lane, distance_m},
                               to_ticks(kFresh_s, model.step_s));
}

// Returns the slot of the vehicle with V2V that is furthest upstream on a lane; -1: none.
int last_with_v2v(const State& state, int lane) {
    const LaneBlock& block = state.blocks[at(lane)];
    for (int slot = block.past_last() - 1; slot >= block.first; --slot) {
        if (has_v2v(state, slot)) return slot;
    }
    return -1;
}

// Returns announcement `number` of the lane; nullptr: the lane has not made it.
const LaneAnnouncement* announcement_of(const State& state, int lane, std::int64_t number) {
    const auto& all = state.clearing.announcements[at(lane)];
    const LaneAnnouncement& found = all[static_cast<std::size_t>(number) % all.size()];
    return found.tick == number * state.clearing.announcement_ticks ? &found : nullptr;
}

}  // namespace

const LaneAnnouncement* latest_announcement(const State& state, int lane) {
    const std::int64_t interval = state.clearing.announcement_ticks;
    return state.tick < 1 ? nullptr : announcement_of(state, lane, (state.tick - 1) / interval);
}

ReceivedAnnouncement received_announcement(const Model& model, const State& state, const Listener& listener) {
    const auto heard_tick = [&](int sender_slot) {
        const double distance_m = listener.to_exit_m + state.vehicles.position_m[at(sender_slot)];
        return newest_fresh_tick(model, state, listener, sender_slot, distance_m);
    };
    const int last = last_with_v2v(state, listener.exit);
    if (last < 0) return {true, latest_announcement(state, listener.exit)};
    const std::int64_t last_heard_tick = heard_tick(last);
    const std::int64_t interval = state.clearing.announcement_ticks;
    const std::int64_t newest = (state.tick - 1) / interval;
    const std::int64_t oldest = std::max<std::int64_t>(newest - 2, 0);  // older ones are not fresh
    for (std::int64_t number = newest; number >= oldest; --number) {
        const LaneAnnouncement* const found = announcement_of(state, listener.exit, number);
        if (found == nullptr) continue;
        // The last leaving vehicle sends the announcement. Without one with V2V, the vehicle furthest upstream sends
        // it.
        const int leaver = slot_on_lane(state, listener.exit, found->last_leaver);
        const std::int64_t sent_tick = leaver >= 0 && has_v2v(state, leaver) ? heard_tick(leaver) : last_heard_tick;
        if (sent_tick >= number * interval) return {true, found};
    }
    return {last_heard_tick != kNoMessage, nullptr};
}

ReceivedBookings received_bookings(const Model& model, const State& state, const Listener& listener) {
    ReceivedBookings result;
    const VehicleArrays& v = state.vehicles;
    const double to_line_m = state.plan.lane(listener.lane).stop_line_m - v.position_m[at(listener.slot)];
    for (const int connection : model.connections_to.of(listener.exit)) {
        const LanePlan& path = state.plan.lane(connection);
        if (path.origin == listener.lane) continue;  // bookings of vehicles on the own lane are always known
        const LatestAdmission& latest = state.clearing.latest_admissions[at(path.origin)];
        const double line_m = state.plan.lane(path.origin).stop_line_m;
        bool is_latest = false;
        const int end = admitted_end(state, path.origin);
        for (int slot = state.blocks[at(path.origin)].first; slot < end; ++slot) {
            is_latest = is_latest || v.id[at(slot)] == latest.first_vehicle;
            const double distance_m = line_m - v.position_m[at(slot)];
            // Vehicles past the line are in sight.
            if (distance_m < 0.0 || v.next_lane[at(slot)] != connection || !has_v2v(state, slot)) continue;
            const std::int64_t heard_tick =
                newest_fresh_tick(model, state, listener, slot, to_line_m + path.length_m + distance_m);
            if (heard_tick == kNoMessage) result.is_fresh = false;
            if (is_latest && heard_tick < latest.tick) result.unknown_m += space_needed_m(v, slot);
        }
    }
    return result;
}

}  // namespace stopline
