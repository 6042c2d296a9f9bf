#include "record/recording/frame_decoder.h"

#include <algorithm>

#include "record/recording/recording_format.h"

namespace stopline {

namespace {

constexpr std::size_t kMaxSeats = 1U << 24U;
constexpr std::uint64_t kMaxNumber = 1ULL << 31U;
constexpr int kLights = 3;

}  // namespace

FrameDecoder::FrameDecoder(const RecordedRun& run, std::string_view section)
    : run_(run), reader_(section), lights_(static_cast<std::size_t>(run.signal_groups), std::uint8_t{0}) {}

void FrameDecoder::next() {
    read_events();
    if (!run_.links.empty()) read_links();
    entered_ = static_cast<std::int64_t>(reader_.varint(kMaxNumber));
    exited_ = static_cast<std::int64_t>(reader_.varint(kMaxNumber));
    read_columns();
}

void FrameDecoder::check_end() const {
    if (reader_.remaining() != 0) throw InputError("bytes remain after the last frame");
}

RecordedVehicle& FrameDecoder::read_seat() { return seats_[static_cast<std::size_t>(reader_.index(seats_.size()))]; }

void FrameDecoder::read_events() {
    const std::size_t lanes = run_.lanes.size();
    for (std::uint64_t n = reader_.varint(kMaxNumber); n > 0; --n) {
        const int group = reader_.index(lights_.size());
        lights_[static_cast<std::size_t>(group)] = static_cast<std::uint8_t>(reader_.index(kLights));
    }
    for (std::uint64_t n = reader_.varint(kMaxNumber); n > 0; --n) read_seat() = {};
    for (std::uint64_t n = reader_.varint(kMaxNumber); n > 0; --n) {
        const auto number = static_cast<std::size_t>(reader_.index(kMaxSeats));
        if (number > seats_.size()) throw InputError("a new seat does not have the next number");
        if (number == seats_.size()) seats_.emplace_back();
        RecordedVehicle& entered = seats_[number];
        if (entered.vehicle >= 0) throw InputError("two vehicles have the same seat");
        entered.vehicle = static_cast<int>(reader_.varint(kMaxNumber - 1));
        entered.policy = reader_.index(run_.policies.size());
        entered.length_m = 0.001 * static_cast<double>(reader_.varint(kMaxNumber));
        entered.lane = reader_.index(lanes);
        entered.next = reader_.index(lanes + 1) - 1;
    }
    for (std::uint64_t n = reader_.varint(kMaxNumber); n > 0; --n) {
        RecordedVehicle& moved = read_seat();
        moved.lane = reader_.index(lanes);
        moved.next = reader_.index(lanes + 1) - 1;
        moved.position = 0;
    }
    for (std::uint64_t n = reader_.varint(kMaxNumber); n > 0; --n) {
        RecordedVehicle& waiting = read_seat();
        waiting.cause = reader_.index(run_.causes.size());
        waiting.waited_for = static_cast<int>(reader_.varint(kMaxNumber)) - 1;
    }
}

void FrameDecoder::read_links() {
    links_.clear();
    for (std::uint64_t n = reader_.varint(kMaxNumber); n > 0; --n) {
        VehicleLink link;
        link.kind = reader_.index(run_.links.size());
        link.vehicle = static_cast<int>(reader_.varint(kMaxNumber - 1));
        link.other = static_cast<int>(reader_.varint(kMaxNumber)) - 1;
        link.lane = reader_.index(run_.lanes.size() + 1) - 1;
        links_.push_back(link);
    }
}

void FrameDecoder::read_columns() {
    const std::size_t seats = seats_.size();
    if (reader_.varint(kMaxSeats) != seats) throw InputError("the columns do not have one element for each seat");
    const std::string_view bits = reader_.take((seats + 7) / 8);
    const auto is_changed = [&](std::size_t k) {
        return ((static_cast<unsigned>(static_cast<unsigned char>(bits[k / 8])) >> (k % 8)) & 1U) != 0;
    };
    std::size_t count = 0;
    for (std::size_t k = 0; k < seats; ++k) count += is_changed(k) ? 1U : 0U;
    const std::string_view speeds = reader_.take(count);
    const std::string_view positions = reader_.take(count);
    const auto wide_bytes = [](std::string_view column) {
        return 2U * static_cast<std::size_t>(std::count(column.begin(), column.end(), static_cast<char>(kWideCode)));
    };
    ByteReader wide_speeds(reader_.take(wide_bytes(speeds)));
    ByteReader wide_positions(reader_.take(wide_bytes(positions)));
    const auto read_difference = [](char narrow, ByteReader& wide_codes) {
        const std::uint16_t byte = static_cast<unsigned char>(narrow);
        return unzigzag(byte == kWideCode ? wide_codes.number<std::uint16_t>() : byte);
    };
    std::size_t next = 0;
    for (std::size_t k = 0; k < seats; ++k) {
        RecordedVehicle& vehicle = seats_[k];
        const std::uint16_t before = vehicle.speed;
        const bool changed = is_changed(k);
        if (changed) vehicle.speed = static_cast<std::uint16_t>(before + read_difference(speeds[next], wide_speeds));
        vehicle.position = static_cast<std::uint16_t>(
            vehicle.position + expected_advance(std::uint32_t{before} + vehicle.speed, run_.grid.advance_q12));
        if (changed)
            vehicle.position =
                static_cast<std::uint16_t>(vehicle.position + read_difference(positions[next++], wide_positions));
    }
}

}  // namespace stopline
