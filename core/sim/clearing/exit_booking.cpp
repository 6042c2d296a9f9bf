#include "sim/clearing/exit_booking.h"

#include <algorithm>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/clearing/keep_clear.h"
#include "sim/state/queries/gap.h"
#include "sim/state/queries/received_message.h"
#include "sim/state/queries/vehicle_place.h"

namespace stopline {

namespace {

constexpr double kNeverStarts_s = 1e9;
constexpr double kClearReserve_m = 1.0;  // distance from the conflict area to the rear of a vehicle at rest

// Determines the room on an exit lane.
class RoomSearch {
public:
    // `announcement`: that of the vehicles on the exit lane; nullptr: none.
    RoomSearch(const Model& model, const State& state, int exit, const LaneAnnouncement* announcement)
        : model_(model),
          state_(state),
          v_(state.vehicles),
          exit_(exit),
          block_(state.blocks[at(exit)]),
          announcement_(announcement) {}

    // Returns the room without bookings.
    ExitBooking find_room() {
        find_place_of_rest();
        if (block_.count > 0) find_present_room();
        return result_;
    }

    ExitBooking run() {
        find_room();
        for (const int connection : model_.connections_to.of(exit_)) subtract_vehicles_to(connection);
        return result_;
    }

private:
    bool is_slow(int slot) const { return v_.speed_mps[at(slot)] < kCrawlingSpeed_mps; }

    // Adds up the vehicles that remain, from the stop line upstream. A vehicle that is stopped behind stopped vehicles
    // only, or at a signal that is not green, has already reached its place of rest.
    void find_place_of_rest() {
        const LanePlan& lane = state_.plan.lane(exit_);
        const double line_rest_m = lane.stop_line_m - state_.clearing.line_margin_m;
        double rest_m = line_rest_m;
        int slot = block_.first;
        if (announcement_ != nullptr) {
            const int leaver = slot_on_lane(state_, exit_, announcement_->last_leaver);
            has_leaver_ = leaver >= 0;
            if (has_leaver_) slot = leaver + 1;
            rest_m = announcement_->rest_m;
        }
        bool is_final = !has_leaver_;
        for (; slot < block_.past_last(); ++slot) {
            const double front_m = v_.position_m[at(slot)];
            rest_m = front_m > lane.stop_line_m ? std::max(rest_m, front_m) : std::min(rest_m, line_rest_m);
            is_final = is_final && v_.speed_mps[at(slot)] < kStoppedSpeed_mps;
            if (is_final) rest_m = std::min(rest_m, front_m);
            rest_m -= space_needed_m(v_, slot);
        }
        result_.tick = state_.tick;
        result_.room_m = rest_m - kClearReserve_m;
        result_.present_room_m = kAmpleRoom_m;
        result_.last_slot = block_.count > 0 ? block_.last() : -1;
    }

    // Finds the last stopped vehicle and the time until it starts. In a queue that starts, each vehicle starts one time
    // gap after its leader.
    void find_present_room() {
        int slot = block_.last();
        double moving_m = 0.0;
        while (slot >= block_.first && !is_slow(slot)) moving_m += space_needed_m(v_, slot--);
        if (slot < block_.first) return;
        result_.present_room_m = rear_m(v_, slot) - moving_m - kClearReserve_m;
        for (; slot >= block_.first && is_slow(slot); --slot) {
            result_.start_s += state_.clearing.policies[at(v_.policy[at(slot)])].time_gap_s;
        }
        if (slot < block_.first && !has_leaver_) result_.start_s = kNeverStarts_s;
    }

    // Subtracts the space of the vehicles on a connection, and of the admitted vehicles that will take it.
    void subtract_vehicles_to(int connection) {
        const LaneBlock& inner = state_.blocks[at(connection)];
        for (int slot = inner.first; slot < inner.past_last(); ++slot) subtract(slot);
        const int origin = state_.plan.lane(connection).origin;
        const int end = admitted_end(state_, origin);
        for (int slot = state_.blocks[at(origin)].first; slot < end; ++slot) {
            if (v_.next_lane[at(slot)] == connection) subtract(slot);
        }
    }

    void subtract(int slot) {
        result_.room_m -= space_needed_m(v_, slot);
        result_.present_room_m -= space_needed_m(v_, slot);
        result_.booked_m += space_needed_m(v_, slot);
    }

    const Model& model_;
    const State& state_;
    const VehicleArrays& v_;
    int exit_;
    const LaneBlock& block_;
    const LaneAnnouncement* announcement_;
    bool has_leaver_ = false;
    ExitBooking result_;
};

}  // namespace

bool has_v2v(const State& state, int slot) {
    return state.clearing.policies[at(state.vehicles.policy[at(slot)])].has_v2v;
}

int admitted_end(const State& state, int lane) {
    const LaneBlock& block = state.blocks[at(lane)];
    if (block.count == 0) return block.first;
    const double line_m = state.plan.lane(lane).stop_line_m;
    const int last_admitted = state.clearing.last_admitted[at(lane)];
    int end = block.first;
    while (end < block.past_last() && state.vehicles.position_m[at(end)] > line_m) ++end;
    if (last_admitted < 0) return end;
    for (int slot = end; slot < block.past_last(); ++slot) {
        if (state.vehicles.id[at(slot)] == last_admitted) return slot + 1;
    }
    return end;
}

bool takes_bookings(const State& state, int exit, double length_m) {
    const LanePlan& lane = state.plan.lane(exit);
    return lane.signal_group >= 0 && lane.stop_line_m - state.clearing.line_margin_m - kClearReserve_m >= length_m;
}

ExitBooking& exit_booking(const Model& model, State& state, int exit) {
    ExitBooking& booking = state.clearing.bookings[at(exit)];
    if (booking.tick != state.tick) booking = RoomSearch(model, state, exit, latest_announcement(state, exit)).run();
    return booking;
}

KnownRoom known_room(const Model& model, State& state, const Listener& listener) {
    const ExitBooking& booking = exit_booking(model, state, listener.exit);
    if (!uses_channel(model)) return {true, booking.room_m, booking.present_room_m, booking.start_s};
    const ReceivedAnnouncement received = received_announcement(model, state, listener);
    const ReceivedBookings bookings = received_bookings(model, state, listener);
    KnownRoom known{received.is_fresh && bookings.is_fresh, booking.room_m, booking.present_room_m, booking.start_s};
    if (received.announcement != latest_announcement(state, listener.exit)) {
        const ExitBooking found = RoomSearch(model, state, listener.exit, received.announcement).find_room();
        known.room_m = found.room_m - booking.booked_m;
        known.present_room_m = found.present_room_m - booking.booked_m;
        known.start_s = found.start_s;
    }
    known.room_m += bookings.unknown_m;
    known.present_room_m += bookings.unknown_m;
    return known;
}

}  // namespace stopline
