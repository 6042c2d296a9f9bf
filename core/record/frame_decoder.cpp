#include "record/frame_decoder.h"

#include <algorithm>

#include "record/recording_format.h"

namespace stopline {

namespace {

constexpr std::size_t kMostSeats = 1U << 24U;
constexpr std::uint64_t kMostNumber = 1ULL << 31U;
constexpr int kLights = 3;

}  // namespace

FrameDecoder::FrameDecoder(const RecordedRun& run, std::string_view section)
    : run_(run), reader_(section), lights_(static_cast<std::size_t>(run.signal_groups), std::uint8_t{0}) {}

void FrameDecoder::next() {
    read_events();
    entered_ = static_cast<std::int64_t>(reader_.varint(kMostNumber));
    left_ = static_cast<std::int64_t>(reader_.varint(kMostNumber));
    read_columns();
}

void FrameDecoder::check_end() const {
    if (reader_.left() != 0) throw InputError("bytes are left after its frames");
}

RecordedVehicle& FrameDecoder::seat() { return seats_[static_cast<std::size_t>(reader_.whole(seats_.size()))]; }

void FrameDecoder::read_events() {
    const std::size_t lanes = run_.lanes.size();
    for (std::uint64_t n = reader_.varint(kMostNumber); n > 0; --n) {
        const int group = reader_.whole(lights_.size());
        lights_[static_cast<std::size_t>(group)] = static_cast<std::uint8_t>(reader_.whole(kLights));
    }
    for (std::uint64_t n = reader_.varint(kMostNumber); n > 0; --n) seat() = {};
    for (std::uint64_t n = reader_.varint(kMostNumber); n > 0; --n) {
        const auto number = static_cast<std::size_t>(reader_.whole(kMostSeats));
        if (number > seats_.size()) throw InputError("a seat in it is not the next one");
        if (number == seats_.size()) seats_.emplace_back();
        RecordedVehicle& new_one = seats_[number];
        if (new_one.vehicle >= 0) throw InputError("a seat in it is taken twice");
        new_one.vehicle = static_cast<int>(reader_.varint(kMostNumber - 1));
        new_one.policy = reader_.whole(run_.policies.size());
        new_one.length_m = 0.001 * static_cast<double>(reader_.varint(kMostNumber));
        new_one.lane = reader_.whole(lanes);
        new_one.next = reader_.whole(lanes + 1) - 1;
    }
    for (std::uint64_t n = reader_.varint(kMostNumber); n > 0; --n) {
        RecordedVehicle& moved = seat();
        moved.lane = reader_.whole(lanes);
        moved.next = reader_.whole(lanes + 1) - 1;
        moved.position = 0;
    }
    for (std::uint64_t n = reader_.varint(kMostNumber); n > 0; --n) {
        RecordedVehicle& waiting = seat();
        waiting.cause = reader_.whole(run_.causes.size());
        waiting.waited_for = static_cast<int>(reader_.varint(kMostNumber)) - 1;
    }
}

void FrameDecoder::read_columns() {
    const std::size_t seats = seats_.size();
    if (reader_.varint(kMostSeats) != seats) throw InputError("its columns do not fit its seats");
    const std::string_view marks = reader_.take((seats + 7) / 8);
    const auto marked = [&](std::size_t k) {
        return ((static_cast<unsigned>(static_cast<unsigned char>(marks[k / 8])) >> (k % 8)) & 1U) != 0;
    };
    std::size_t count = 0;
    for (std::size_t k = 0; k < seats; ++k) count += marked(k) ? 1U : 0U;
    const std::string_view speeds = reader_.take(count);
    const std::string_view positions = reader_.take(count);
    const auto wide = [](std::string_view column) {
        return 2U * static_cast<std::size_t>(std::count(column.begin(), column.end(), static_cast<char>(kWide)));
    };
    ByteReader wide_speeds(reader_.take(wide(speeds)));
    ByteReader wide_positions(reader_.take(wide(positions)));
    const auto code = [](char narrow, ByteReader& more) {
        const std::uint16_t byte = static_cast<unsigned char>(narrow);
        return unzigzag(byte == kWide ? more.number<std::uint16_t>() : byte);
    };
    std::size_t next = 0;
    for (std::size_t k = 0; k < seats; ++k) {
        RecordedVehicle& one = seats_[k];
        const std::uint16_t before = one.speed;
        const bool differs = marked(k);
        if (differs) one.speed = static_cast<std::uint16_t>(before + code(speeds[next], wide_speeds));
        one.position = static_cast<std::uint16_t>(
            one.position + expected_advance(std::uint32_t{before} + one.speed, run_.grid.advance_q12));
        if (differs) one.position = static_cast<std::uint16_t>(one.position + code(positions[next++], wide_positions));
    }
}

}  // namespace stopline
