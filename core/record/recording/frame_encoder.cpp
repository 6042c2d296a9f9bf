#include "record/recording/frame_encoder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/containers/index.h"
#include "record/recording/bytes.h"
#include "record/recording/recording_format.h"

namespace stopline {

namespace {

std::uint64_t plus_one(int number) { return static_cast<std::uint64_t>(number + 1); }

std::uint16_t zigzag_difference(unsigned value, unsigned expected) {
    return zigzag(static_cast<std::uint16_t>(value - expected));
}

}  // namespace

void FrameEncoder::Events::clear() {
    bytes.clear();
    count = 0;
}

void FrameEncoder::Events::append_to(std::string& frame) const {
    put_varint(frame, count);
    frame += bytes;
}

FrameEncoder::FrameEncoder(const Model& model, const FrameGrid& grid)
    : watch_ticks_(model.rules.watch_ticks),
      has_links_(!link_kinds_of(model).empty()),
      grid_(grid),
      lanes_(model.graph.lanes.size()) {
    lights_.assign(at(model.graph.signal_groups), Light::red);
}

void FrameEncoder::start_section() {
    for (const Seat& seat : seats_) {
        if (seat.vehicle >= 0) seat_of_[at(seat.vehicle)] = -1;
    }
    seats_.clear();
    free_seats_.clear();
    waiting_seats_.clear();
    waits_.clear();
    changed_bits_.clear();
    reader_motion_.clear();
    motion_.clear();
    std::fill(seat_in_slot_.begin(), seat_in_slot_.end(), -1);
    std::fill(lanes_.begin(), lanes_.end(), Snapshot::Slots{});
    std::fill(lights_.begin(), lights_.end(), Light::red);
    cause_tick_ = -1;
}

void FrameEncoder::append(const Snapshot& snapshot, std::string& bytes) {
    for (Events& events : events_) events.clear();
    vacated_.clear();
    resize_slots(snapshot.lanes);
    encode_lights(snapshot.lights);
    vacate_slots(snapshot);
    for (const Snapshot::Placement& placement : snapshot.placements) encode_placement(placement);
    compare_motion(snapshot);
    encode_exits();
    encode_causes(snapshot);
    for (const Events& events : events_) events.append_to(bytes);
    if (has_links_) append_links(snapshot.links, bytes);
    put_varint(bytes, static_cast<std::uint64_t>(snapshot.entered - entered_));
    put_varint(bytes, static_cast<std::uint64_t>(snapshot.exited - exited_));
    entered_ = snapshot.entered;
    exited_ = snapshot.exited;
    append_columns(bytes);
}

void FrameEncoder::resize_slots(const std::vector<Snapshot::Slots>& lanes) {
    std::size_t slots = 0;
    for (const Snapshot::Slots& lane : lanes) slots = std::max(slots, at(lane.past_last()));
    if (slots <= seat_in_slot_.size()) return;
    seat_in_slot_.resize(slots, -1);
    last_motion_.resize(slots, kUnknownMotion);
}

void FrameEncoder::encode_lights(const std::vector<Light>& lights) {
    for (std::size_t group = 0; group < lights_.size(); ++group) {
        if (lights[group] == lights_[group]) continue;
        lights_[group] = lights[group];
        Events& events = events_[light_events];
        put_varint(events.bytes, group);
        put_varint(events.bytes, static_cast<std::uint64_t>(lights[group]));
        ++events.count;
    }
}

// Updates the range of slots of each lane (a slot is the index of a vehicle in the arrays of the simulation). Empties
// the slots that a range no longer contains. Call this function before encode_placement(), which can put vehicles of
// other lanes into these slots.
void FrameEncoder::vacate_slots(const Snapshot& snapshot) {
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        const Snapshot::Slots now = snapshot.lanes[lane];
        const Snapshot::Slots before = lanes_[lane];
        vehicle_states_ += now.count;
        lanes_[lane] = now;
        if (before == now) continue;
        for (int slot = before.first; slot < before.past_last(); ++slot) {
            if (slot < now.first || slot >= now.past_last()) vacate(slot);
        }
    }
}

// Empties a slot. Its vehicle has moved to another slot or left the network; encode_exits() tells these cases apart.
void FrameEncoder::vacate(int slot) {
    if (seat_in_slot_[at(slot)] >= 0) vacated_.push_back(seat_in_slot_[at(slot)]);
    seat_in_slot_[at(slot)] = -1;
}

void FrameEncoder::encode_placement(const Snapshot::Placement& placement) {
    vacate(placement.slot);
    if (at(placement.vehicle) >= seat_of_.size()) seat_of_.resize(2 * at(placement.vehicle) + 1000, -1);
    int seat = seat_of_[at(placement.vehicle)];
    std::uint32_t last_motion = kUnknownMotion;
    if (seat < 0) {
        seat = assign_seat(placement);
    } else if (seats_[at(seat)].lane != placement.lane || seats_[at(seat)].next != placement.next_lane) {
        encode_lane(seat, placement.lane, placement.next_lane);
    } else {
        last_motion = motion_[at(seat)].position | std::uint32_t{motion_[at(seat)].speed} << 16U;
    }
    seats_[at(seat)].slot = placement.slot;
    seat_in_slot_[at(placement.slot)] = seat;
    last_motion_[at(placement.slot)] = last_motion;
}

// Finds the vehicles whose position and speed this frame must contain, and sets the bits of their seats (a seat is the
// number of a vehicle in the recording). A vehicle is left out if it is at rest and its position and speed are those of
// the previous frame. This saves much space.
void FrameEncoder::compare_motion(const Snapshot& snapshot) {
    const std::uint32_t* motion = snapshot.motion.data();
    for (const Snapshot::Slots& slots : lanes_) {
        for (std::size_t i = at(slots.first); i < at(slots.past_last()); ++i) {
            const std::uint32_t now = *motion++;
            const std::uint32_t before = last_motion_[i];
            last_motion_[i] = now;
            if (now == before && speed_of(now) == 0) continue;
            const std::size_t seat = at(seat_in_slot_[i]);
            motion_[seat] = {static_cast<std::uint16_t>(position_of(now)), static_cast<std::uint16_t>(speed_of(now))};
            changed_bits_[seat / 64] |= std::uint64_t{1} << (seat % 64);
        }
    }
}

// Returns the seat of a vehicle, or -1 if it has none.
int FrameEncoder::seat_of(int vehicle) const { return at(vehicle) < seat_of_.size() ? seat_of_[at(vehicle)] : -1; }

int FrameEncoder::assign_seat(const Snapshot::Placement& placement) {
    if (free_seats_.empty()) {
        free_seats_.push_back(static_cast<int>(seats_.size()));
        seats_.emplace_back();
        reader_motion_.emplace_back();
        motion_.emplace_back();
        waits_.emplace_back();
        changed_bits_.resize(motion_.size() / 64 + 1, 0);
    }
    const int seat = free_seats_.back();
    free_seats_.pop_back();
    seat_of_[at(placement.vehicle)] = seat;
    seats_[at(seat)] = Seat{placement.vehicle, placement.slot, placement.lane, placement.next_lane};
    Events& events = events_[entry_events];
    for (const int number : {seat, placement.vehicle, placement.policy}) {
        put_varint(events.bytes, static_cast<std::uint64_t>(number));
    }
    put_varint(events.bytes, static_cast<std::uint64_t>(std::lround(1000.0 * static_cast<double>(placement.length_m))));
    put_varint(events.bytes, static_cast<std::uint64_t>(placement.lane));
    put_varint(events.bytes, plus_one(placement.next_lane));
    ++events.count;
    return seat;
}

void FrameEncoder::encode_lane(int seat, int lane, int next) {
    Events& events = events_[lane_events];
    put_varint(events.bytes, static_cast<std::uint64_t>(seat));
    put_varint(events.bytes, static_cast<std::uint64_t>(lane));
    put_varint(events.bytes, plus_one(next));
    ++events.count;
    seats_[at(seat)].lane = lane;
    seats_[at(seat)].next = next;
    reader_motion_[at(seat)].position = 0;
}

void FrameEncoder::encode_exits() {
    Events& events = events_[exit_events];
    std::sort(vacated_.begin(), vacated_.end());
    for (const int seat : vacated_) {
        Seat& known_seat = seats_[at(seat)];
        const bool has_left = known_seat.vehicle >= 0 && seat_in_slot_[at(known_seat.slot)] != seat;
        if (!has_left) continue;
        put_varint(events.bytes, static_cast<std::uint64_t>(seat));
        ++events.count;
        seat_of_[at(known_seat.vehicle)] = -1;
        known_seat = {};
        waits_[at(seat)].written = {};
        waits_[at(seat)].is_current = false;
        free_seats_.push_back(seat);
        reader_motion_[at(seat)] = motion_[at(seat)] = {};
    }
}

// Writes the delay causes that have changed. The simulation updates them only every `watch_ticks_` ticks, so most calls
// return at once.
void FrameEncoder::encode_causes(const Snapshot& snapshot) {
    const std::int64_t cause_tick = last_cause_tick(watch_ticks_, snapshot.tick);
    if (cause_tick == cause_tick_) return;
    cause_tick_ = cause_tick;
    update_waits(snapshot);
    std::sort(waiting_seats_.begin(), waiting_seats_.end());
    std::erase_if(waiting_seats_, [&](int seat) {
        Wait& wait = waits_[at(seat)];
        if (seats_[at(seat)].vehicle >= 0) encode_reason(seat, wait.is_current ? wait.reason : Reason{});
        wait.is_listed = wait.is_current;
        return !wait.is_current;
    });
}

void FrameEncoder::update_waits(const Snapshot& snapshot) {
    for (const int seat : waiting_seats_) waits_[at(seat)].is_current = false;
    for (const Snapshot::StoppedVehicle& stopped : snapshot.stopped) {
        const int seat = seat_of(stopped.vehicle);
        if (seat < 0) continue;
        Wait& wait = waits_[at(seat)];
        wait.reason = {stopped.cause, stopped.waited_for};
        wait.is_current = true;
        if (!wait.is_listed) waiting_seats_.push_back(seat);
        wait.is_listed = true;
    }
}

void FrameEncoder::encode_reason(int seat, const Reason& reason) {
    Wait& wait = waits_[at(seat)];
    if (reason == wait.written) return;
    wait.written = reason;
    Events& events = events_[wait_events];
    put_varint(events.bytes, static_cast<std::uint64_t>(seat));
    put_varint(events.bytes, static_cast<std::uint64_t>(reason.cause));
    put_varint(events.bytes, plus_one(reason.waited_for));
    ++events.count;
}

void FrameEncoder::append_links(const std::vector<VehicleLink>& links, std::string& bytes) {
    put_varint(bytes, links.size());
    for (const VehicleLink& link : links) {
        put_varint(bytes, static_cast<std::uint64_t>(link.kind));
        put_varint(bytes, static_cast<std::uint64_t>(link.vehicle));
        put_varint(bytes, plus_one(link.other));
        put_varint(bytes, plus_one(link.lane));
    }
}

void FrameEncoder::append_columns(std::string& bytes) {
    const std::size_t seats = motion_.size();
    put_varint(bytes, seats);
    for (std::size_t k = 0; k < (seats + 7) / 8; ++k) {
        bytes += static_cast<char>((changed_bits_[k / 8] >> (8 * (k % 8))) & 0xFFU);
    }
    for (std::string* const column : {&speeds_, &positions_}) column->resize(seats);
    for (std::string* const column : {&wide_speeds_, &wide_positions_}) column->clear();
    append_codes(bytes);
    std::fill(changed_bits_.begin(), changed_bits_.end(), 0);
}

void FrameEncoder::append_codes(std::string& bytes) {
    std::size_t count = 0;
    for (std::size_t word = 0; word < changed_bits_.size(); ++word) {
        for (std::uint64_t bits = changed_bits_[word]; bits != 0; bits &= bits - 1) {
            const std::size_t k = 64 * word + static_cast<std::size_t>(std::countr_zero(bits));
            const Motion known = reader_motion_[k];
            const Motion now = motion_[k];
            reader_motion_[k] = now;
            const std::uint32_t sum = std::uint32_t{known.speed} + now.speed;
            const std::uint16_t speed = zigzag_difference(now.speed, known.speed);
            const std::uint16_t position =
                zigzag_difference(now.position, known.position + expected_advance(sum, grid_.advance_q12));
            speeds_[count] = static_cast<char>(std::min(speed, kWideCode));
            positions_[count] = static_cast<char>(std::min(position, kWideCode));
            ++count;
            if (speed >= kWideCode) put_number(wide_speeds_, speed);
            if (position >= kWideCode) put_number(wide_positions_, position);
        }
    }
    bytes.append(speeds_, 0, count);
    bytes.append(positions_, 0, count);
    bytes += wide_speeds_;
    bytes += wide_positions_;
}

}  // namespace stopline
