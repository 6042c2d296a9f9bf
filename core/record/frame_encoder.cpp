#include "record/frame_encoder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "record/bytes.h"
#include "record/recording_format.h"

namespace stopline {

namespace {

constexpr double kNowhere_m = std::numeric_limits<double>::quiet_NaN();
constexpr double kMostCode = 65535.0;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

std::uint16_t code_of(double value, double per_unit) {
    return static_cast<std::uint16_t>(static_cast<int>(std::clamp(value * per_unit + 0.5, 0.0, kMostCode)));
}

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
    : signals_(model.signals),
      watch_ticks_(model.rules.watch_ticks),
      grid_(grid),
      positions_per_m_(1.0 / grid.position_unit_m),
      lanes_(model.graph.lanes.size()) {
    lights_.assign(model.signals.size(), Light::red);
    for (const Lane& lane : model.graph.lanes) {
        const double line_m = lane.signal_group >= 0 ? lane.stop_line_m : lane.length_m;
        stop_line_.push_back(code_of(line_m, positions_per_m_));
    }
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
    std::fill(guest_.begin(), guest_.end(), -1);
    std::fill(guest_seat_.begin(), guest_seat_.end(), -1);
    std::fill(rest_m_.begin(), rest_m_.end(), kNowhere_m);
    std::fill(lane_of_.begin(), lane_of_.end(), -1);
    std::fill(lanes_.begin(), lanes_.end(), Snapshot::Slots{});
    std::fill(lights_.begin(), lights_.end(), Light::red);
    look_tick_ = -1;
}

void FrameEncoder::append(const Snapshot& shot, std::string& bytes) {
    for (Events& events : events_) events.clear();
    vacated_.clear();
    const std::size_t slots = shot.vehicle.size();
    if (guest_.size() < slots) {
        for (std::vector<int>* const each : {&guest_, &guest_seat_, &lane_of_}) each->resize(slots, -1);
        rest_m_.resize(slots, kNowhere_m);
    }
    note_lights(shot.tick);
    vacate_slots(shot);
    note_vehicles(shot);
    note_left();
    note_causes(shot);
    for (const Events& events : events_) events.append_to(bytes);
    put_varint(bytes, static_cast<std::uint64_t>(shot.entered - entered_));
    put_varint(bytes, static_cast<std::uint64_t>(shot.left - left_));
    entered_ = shot.entered;
    left_ = shot.left;
    append_columns(bytes);
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
    changed_.clear();
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        const Snapshot::Slots& block = shot.lanes[lane];
        const Snapshot::Slots& before = lanes_[lane];
        vehicle_states_ += block.count;
        if (before == block) continue;
        changed_.push_back(static_cast<int>(lane));
        for (int slot = before.first; slot < before.stop(); ++slot) {
            if (slot < block.first || slot >= block.stop()) vacate(slot);
            lane_of_[at(slot)] = -1;
        }
    }
    for (const int lane : changed_) {
        const Snapshot::Slots& block = shot.lanes[at(lane)];
        lanes_[at(lane)] = block;
        std::fill_n(lane_of_.begin() + block.first, block.count, lane);
    }
}

// Half of all vehicles rest in queues: they are left out many at a time.
void FrameEncoder::note_vehicles(const Snapshot& shot) {
    const std::size_t slots = shot.vehicle.size();
    moves_.resize((slots + 7) / 8 * 8, 0);
    const int* const vehicle = shot.vehicle.data();
    const double* const position_m = shot.position_m.data();
    const double* const speed_mps = shot.speed_mps.data();
    const int* const guest = guest_.data();
    const double* const rest_m = rest_m_.data();
    char* const moves = moves_.data();
    for (std::size_t i = 0; i < slots; ++i) {
        const bool rests = (vehicle[i] == guest[i]) & (position_m[i] == rest_m[i]) & (speed_mps[i] == 0.0);
        moves[i] = static_cast<char>(!rests);
    }
    for (std::size_t i = 0; i < slots; ++i) {
        if (moves[i] != 0 && lane_of_[i] >= 0) note_vehicle(shot, static_cast<int>(i), lane_of_[i]);
    }
}

void FrameEncoder::note_vehicle(const Snapshot& shot, int slot, int lane) {
    constexpr double kSpeedsPer_mps = 1.0 / kSpeedUnit_mps;
    const int seat = guest_[at(slot)] == shot.vehicle[at(slot)] ? guest_seat_[at(slot)] : seat_at(shot, slot, lane);
    const Motion motion{code_of(shot.position_m[at(slot)], positions_per_m_),
                        code_of(shot.speed_mps[at(slot)], kSpeedsPer_mps)};
    now_[at(seat)] = motion;
    differing_[at(seat) / 64] |= std::uint64_t{1} << (at(seat) % 64);
    rest_m_[at(slot)] = shot.speed_mps[at(slot)] == 0.0 ? shot.position_m[at(slot)] : kNowhere_m;
    if (motion.position <= stop_line_[at(lane)]) return;
    const int next = shot.next_lane[at(slot)];
    if (seats_[at(seat)].next != next) move(seat, lane, next);
}

// Whoever was seen in that slot is elsewhere now, or nowhere.
void FrameEncoder::vacate(int slot) {
    if (guest_seat_[at(slot)] >= 0) vacated_.push_back(guest_seat_[at(slot)]);
    guest_[at(slot)] = guest_seat_[at(slot)] = -1;
    rest_m_[at(slot)] = kNowhere_m;
}

// The seat of a vehicle that was not in this slot.
int FrameEncoder::seat_at(const Snapshot& shot, int slot, int lane) {
    vacate(slot);
    const int vehicle = shot.vehicle[at(slot)];
    if (at(vehicle) >= seat_of_.size()) seat_of_.resize(2 * at(vehicle) + 1000, -1);
    int seat = seat_of_[at(vehicle)];
    if (seat < 0) {
        seat = new_seat(shot, slot, lane);
    } else if (seats_[at(seat)].lane != lane || seats_[at(seat)].next != shot.next_lane[at(slot)]) {
        move(seat, lane, shot.next_lane[at(slot)]);
    }
    seats_[at(seat)].slot = slot;
    guest_[at(slot)] = vehicle;
    guest_seat_[at(slot)] = seat;
    return seat;
}

// -1: it has none, and perhaps never had.
int FrameEncoder::seat_of(int vehicle) const { return at(vehicle) < seat_of_.size() ? seat_of_[at(vehicle)] : -1; }

int FrameEncoder::new_seat(const Snapshot& shot, int slot, int lane) {
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
    const int vehicle = shot.vehicle[at(slot)];
    const int next = shot.next_lane[at(slot)];
    seat_of_[at(vehicle)] = seat;
    seats_[at(seat)] = Seat{vehicle, slot, lane, next};
    Events& events = events_[came];
    for (const int number : {seat, vehicle, shot.policy[at(slot)]}) {
        put_varint(events.bytes, static_cast<std::uint64_t>(number));
    }
    put_varint(events.bytes,
               static_cast<std::uint64_t>(std::lround(1000.0 * static_cast<double>(shot.length_m[at(slot)]))));
    put_varint(events.bytes, static_cast<std::uint64_t>(lane));
    put_varint(events.bytes, one_more(next));
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
        // Mostly it has not moved since; where it has, it is found by its number.
        const bool there = guest_[at(one.slot)] == one.vehicle;
        const int seat = there ? guest_seat_[at(one.slot)] : seat_of(one.vehicle);
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
