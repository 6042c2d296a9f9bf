#include "record/frame_encoder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "record/bytes.h"
#include "record/recording_format.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

std::uint64_t one_more(int number) { return static_cast<std::uint64_t>(number + 1); }

std::uint16_t difference(unsigned value, unsigned expected) {
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
    : signals_(model.signals), watch_ticks_(model.rules.watch_ticks), grid_(grid), lanes_(model.graph.lanes.size()) {
    lights_.assign(model.signals.size(), Light::red);
}

void FrameEncoder::start_section() {
    for (const Seat& seat : seats_) {
        if (seat.vehicle >= 0) seat_of_[at(seat.vehicle)] = -1;
    }
    seats_.clear();
    free_.clear();
    waiting_.clear();
    waits_.clear();
    differing_.clear();
    known_.clear();
    now_.clear();
    std::fill(guest_seat_.begin(), guest_seat_.end(), -1);
    std::fill(lanes_.begin(), lanes_.end(), Snapshot::Slots{});
    std::fill(lights_.begin(), lights_.end(), Light::red);
    look_tick_ = -1;
}

void FrameEncoder::append(const Snapshot& shot, std::string& bytes) {
    for (Events& events : events_) events.clear();
    vacated_.clear();
    make_room(shot.lanes);
    note_lights(shot.tick);
    vacate_slots(shot);
    for (const Snapshot::Guest& guest : shot.guests) note_guest(guest);
    for (const Snapshot::PastLine& one : shot.past_line) note_past_line(one);
    note_motion(shot);
    note_left();
    note_causes(shot);
    for (const Events& events : events_) events.append_to(bytes);
    put_varint(bytes, static_cast<std::uint64_t>(shot.entered - entered_));
    put_varint(bytes, static_cast<std::uint64_t>(shot.left - left_));
    entered_ = shot.entered;
    left_ = shot.left;
    append_columns(bytes);
}

void FrameEncoder::make_room(const std::vector<Snapshot::Slots>& lanes) {
    std::size_t slots = 0;
    for (const Snapshot::Slots& lane : lanes) slots = std::max(slots, at(lane.stop()));
    if (slots <= guest_seat_.size()) return;
    guest_seat_.resize(slots, -1);
    motion_before_.resize(slots, kToLookAt);
}

void FrameEncoder::note_lights(std::int64_t tick) {
    for (std::size_t group = 0; group < lights_.size(); ++group) {
        const Light light = signals_[group].light(tick);
        if (light == lights_[group]) continue;
        lights_[group] = light;
        Events& events = events_[lights];
        put_varint(events.bytes, group);
        put_varint(events.bytes, static_cast<std::uint64_t>(light));
        ++events.count;
    }
}

// Slots that a lane had and has no more; another may have them now, so that this comes before anybody is seen there.
void FrameEncoder::vacate_slots(const Snapshot& shot) {
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        const Snapshot::Slots now = shot.lanes[lane];
        const Snapshot::Slots before = lanes_[lane];
        vehicle_states_ += now.count;
        lanes_[lane] = now;
        if (before == now) continue;
        for (int slot = before.first; slot < before.stop(); ++slot) {
            if (slot < now.first || slot >= now.stop()) vacate(slot);
        }
    }
}

// Whoever was seen in that slot is elsewhere now, or nowhere.
void FrameEncoder::vacate(int slot) {
    if (guest_seat_[at(slot)] >= 0) vacated_.push_back(guest_seat_[at(slot)]);
    guest_seat_[at(slot)] = -1;
}

void FrameEncoder::note_guest(const Snapshot::Guest& guest) {
    vacate(guest.slot);
    if (at(guest.vehicle) >= seat_of_.size()) seat_of_.resize(2 * at(guest.vehicle) + 1000, -1);
    int seat = seat_of_[at(guest.vehicle)];
    if (seat < 0) {
        seat = new_seat(guest);
    } else if (seats_[at(seat)].lane != guest.lane || seats_[at(seat)].next != guest.next_lane) {
        move(seat, guest.lane, guest.next_lane);
    }
    seats_[at(seat)].slot = guest.slot;
    guest_seat_[at(guest.slot)] = seat;
    motion_before_[at(guest.slot)] = kToLookAt;
}

// It may have learnt only now where it goes on.
void FrameEncoder::note_past_line(const Snapshot::PastLine& one) {
    const int seat = guest_seat_[at(one.slot)];
    if (seats_[at(seat)].next == one.next_lane) return;
    move(seat, one.lane, one.next_lane);
    motion_before_[at(one.slot)] = kToLookAt;
}

// Half of all vehicles rest in queues, and are left out.
void FrameEncoder::note_motion(const Snapshot& shot) {
    const std::uint32_t* motion = shot.motion.data();
    for (const Snapshot::Slots& slots : lanes_) {
        for (std::size_t i = at(slots.first); i < at(slots.stop()); ++i) {
            const std::uint32_t now = *motion++;
            const std::uint32_t before = motion_before_[i];
            motion_before_[i] = now;
            if (now == before && speed_of(now) == 0) continue;
            const std::size_t seat = at(guest_seat_[i]);
            now_[seat] = {static_cast<std::uint16_t>(position_of(now)), static_cast<std::uint16_t>(speed_of(now))};
            differing_[seat / 64] |= std::uint64_t{1} << (seat % 64);
        }
    }
}

// -1: it has none, and perhaps never had.
int FrameEncoder::seat_of(int vehicle) const { return at(vehicle) < seat_of_.size() ? seat_of_[at(vehicle)] : -1; }

int FrameEncoder::new_seat(const Snapshot::Guest& guest) {
    if (free_.empty()) {
        free_.push_back(static_cast<int>(seats_.size()));
        seats_.emplace_back();
        known_.emplace_back();
        now_.emplace_back();
        waits_.emplace_back();
        differing_.resize(now_.size() / 64 + 1, 0);
    }
    const int seat = free_.back();
    free_.pop_back();
    seat_of_[at(guest.vehicle)] = seat;
    seats_[at(seat)] = Seat{guest.vehicle, guest.slot, guest.lane, guest.next_lane};
    Events& events = events_[came];
    for (const int number : {seat, guest.vehicle, guest.policy}) {
        put_varint(events.bytes, static_cast<std::uint64_t>(number));
    }
    put_varint(events.bytes, static_cast<std::uint64_t>(std::lround(1000.0 * static_cast<double>(guest.length_m))));
    put_varint(events.bytes, static_cast<std::uint64_t>(guest.lane));
    put_varint(events.bytes, one_more(guest.next_lane));
    ++events.count;
    return seat;
}

void FrameEncoder::move(int seat, int lane, int next) {
    Events& events = events_[moved];
    put_varint(events.bytes, static_cast<std::uint64_t>(seat));
    put_varint(events.bytes, static_cast<std::uint64_t>(lane));
    put_varint(events.bytes, one_more(next));
    ++events.count;
    seats_[at(seat)].lane = lane;
    seats_[at(seat)].next = next;
    known_[at(seat)].position = 0;
}

void FrameEncoder::note_left() {
    Events& events = events_[left];
    for (const int seat : vacated_) {
        Seat& known = seats_[at(seat)];
        const bool elsewhere = known.vehicle < 0 || guest_seat_[at(known.slot)] == seat;
        if (elsewhere) continue;
        put_varint(events.bytes, static_cast<std::uint64_t>(seat));
        ++events.count;
        seat_of_[at(known.vehicle)] = -1;
        known = {};
        waits_[at(seat)].told = {};
        waits_[at(seat)].seen = false;
        free_.push_back(seat);
        known_[at(seat)] = now_[at(seat)] = {};
    }
}

// The simulation looks now and then at who stands and why.
void FrameEncoder::note_causes(const Snapshot& shot) {
    const std::int64_t look_tick = look_tick_before(watch_ticks_, shot.tick);
    if (look_tick == look_tick_) return;
    look_tick_ = look_tick;
    look_at_standing(shot);
    std::erase_if(waiting_, [&](int seat) {
        Wait& wait = waits_[at(seat)];
        if (seats_[at(seat)].vehicle >= 0) tell_reason(seat, wait.seen ? wait.reason : Reason{});
        wait.listed = wait.seen;
        return !wait.seen;
    });
}

void FrameEncoder::look_at_standing(const Snapshot& shot) {
    for (const int seat : waiting_) waits_[at(seat)].seen = false;
    for (const Snapshot::Standing& one : shot.standing) {
        const int seat = seat_of(one.vehicle);
        if (seat < 0) continue;
        Wait& wait = waits_[at(seat)];
        wait.reason = {one.cause, one.waited_for};
        wait.seen = true;
        if (!wait.listed) waiting_.push_back(seat);
        wait.listed = true;
    }
}

void FrameEncoder::tell_reason(int seat, const Reason& reason) {
    Wait& wait = waits_[at(seat)];
    if (reason == wait.told) return;
    wait.told = reason;
    Events& events = events_[waits];
    put_varint(events.bytes, static_cast<std::uint64_t>(seat));
    put_varint(events.bytes, static_cast<std::uint64_t>(reason.cause));
    put_varint(events.bytes, one_more(reason.waited_for));
    ++events.count;
}

void FrameEncoder::append_columns(std::string& bytes) {
    const std::size_t seats = now_.size();
    put_varint(bytes, seats);
    for (std::size_t k = 0; k < (seats + 7) / 8; ++k) {
        bytes += static_cast<char>((differing_[k / 8] >> (8 * (k % 8))) & 0xFFU);
    }
    for (std::string* const column : {&speeds_, &positions_}) column->resize(seats);
    for (std::string* const column : {&wide_speeds_, &wide_positions_}) column->clear();
    append_codes(bytes);
    std::fill(differing_.begin(), differing_.end(), 0);
}

void FrameEncoder::append_codes(std::string& bytes) {
    std::size_t count = 0;
    for (std::size_t word = 0; word < differing_.size(); ++word) {
        for (std::uint64_t bits = differing_[word]; bits != 0; bits &= bits - 1) {
            const std::size_t k = 64 * word + static_cast<std::size_t>(std::countr_zero(bits));
            const Motion known = known_[k];
            const Motion now = now_[k];
            known_[k] = now;
            const std::uint32_t sum = std::uint32_t{known.speed} + now.speed;
            const std::uint16_t speed = difference(now.speed, known.speed);
            const std::uint16_t position =
                difference(now.position, known.position + expected_advance(sum, grid_.advance_q12));
            speeds_[count] = static_cast<char>(std::min(speed, kWide));
            positions_[count] = static_cast<char>(std::min(position, kWide));
            ++count;
            if (speed >= kWide) put_number(wide_speeds_, speed);
            if (position >= kWide) put_number(wide_positions_, position);
        }
    }
    bytes.append(speeds_, 0, count);
    bytes.append(positions_, 0, count);
    bytes += wide_speeds_;
    bytes += wide_positions_;
}

}  // namespace stopline
