// The file format of a recording: the motion of every vehicle and the state of every light in one run. A recording is
// much smaller than a table. RecordingReader and the replay page (apps/replay/page/decode.js) read it without other
// data.
//
//     file      = magic (8 bytes), version (u16), byte order mark (u16), section HEAD, sections FRMS, section ENDS
//     section   = tag (4 bytes), stored bytes (u32), unpacked bytes (u32), a Zstandard frame with checksum
//     HEAD      = JSON: origin of the run, units, policies, delay causes and network (recording_header.h)
//     FRMS      = number of the first frame (u32), number of frames (u16), frames; readable without the other sections
//     ENDS      = number of frames (u64), number of vehicle states (u64); a file without this section is incomplete
//
// All numbers are little-endian. A varint has 7 bits per byte, the lowest bits first; the highest bit is set in all
// bytes but the last. A seat is a number that a vehicle gets when it enters and keeps until it exits the network. In
// a frame, the lists of changes refer to vehicles by seat. Speeds and positions are columns in the order of the seats.
//
//     frame     = changed lights: n, then n times group, light (0 red, 1 green, 2 yellow)
//                 exited vehicles: n, then n times seat; the seat is free from the next frame on
//                 entered vehicles: n, then n times seat, vehicle, policy, length (mm), lane, next lane + 1
//                 vehicles with a new lane or next lane: n, then n times seat, lane, next lane + 1
//                 vehicles with a new delay cause: n, then n times seat, cause, vehicle waited for + 1; the cause
//                   applies while the vehicle is stopped (below 0.1 m/s), until another cause follows
//                 links between vehicles: n, then n times kind, vehicle, other vehicle + 1, lane + 1; only if the
//                   header has `links`; they are those of this frame alone
//                 number of vehicles that entered the network since the previous frame, then number that exited it
//                 number of seats; all numbers up to here are varints
//                 one bit per seat; a seat without a set bit is empty, or its vehicle stays at rest
//                 one byte per set bit for the speed, then one byte per set bit for the position
//                 16 bits for each speed byte that is 255, then 16 bits for each position byte that is 255
//
// Speeds and positions are 16-bit multiples of the units in the header. The columns contain differences from predicted
// values. The predicted speed is the speed in the previous frame. The predicted position is the position in the
// previous frame plus the distance driven at the mean of the previous and the new speed. Differences 0, -1, 1, -2 ...
// are written as 0, 1, 2, 3 ... modulo 2^16. For a vehicle that has entered or has a new lane or next lane, position 0
// replaces the position in the previous frame. Seats without a vehicle have position and speed 0. At the start of a
// FRMS section all seats are empty and all lights are red.
//
// The bytes do not depend on the number of threads of the run.
//
// Why not another format? Floating-point columns would be larger. One row per vehicle would compress less well. Columns
// with an element for every seat would take longer to write, because many vehicles are stopped.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace stopline {

// The first bytes of the file. A transfer in text mode changes these bytes, so a reader notices the damage. PNG files
// begin in the same way.
inline constexpr std::string_view kRecordingMagic{"\x89SLR\r\n\x1a\n", 8};
inline constexpr std::uint16_t kRecordingVersion = 1;
inline constexpr std::uint16_t kByteOrderMark = 0x0102;
inline constexpr std::string_view kHeadTag = "HEAD";
inline constexpr std::string_view kFramesTag = "FRMS";
inline constexpr std::string_view kEndTag = "ENDS";
inline constexpr int kFramesInSection = 128;
inline constexpr std::uint32_t kMaxSectionBytes = 1U << 28U;  // stored or unpacked
// Limits of the unpacked bytes of a section, so that a small file cannot need much memory. Each section lists all
// vehicles anew, so real sections unpack to less than 20 times their size.
inline constexpr std::size_t kAlwaysUnpackedBytes = std::size_t{4} << 20U;
inline constexpr std::size_t kMaxSectionRatio = 100;
inline constexpr std::uint16_t kWideCode = 255;  // byte that marks a difference stored with 16 bits

inline constexpr double kSpeedUnit_mps = 0.01;
inline constexpr double kFinestPosition_m = 0.01;

// Maximum of `advance_q12`. With this limit, the product in expected_advance() stays below 2^32.
inline constexpr std::uint32_t kMaxAdvance = 0x7FFF;

// Returns the predicted advance from one frame to the next, in position units. `speed_sum` is the sum of the speeds in
// the two frames, in speed units. `advance_q12` is the advance per unit of `speed_sum`, in 1/4096 position units.
inline std::uint32_t expected_advance(std::uint32_t speed_sum, std::uint32_t advance_q12) {
    return (speed_sum * advance_q12) >> 12U;
}

// Maps the differences 0, -1, 1, -2 ... modulo 2^16 to 0, 1, 2, 3 ..., so that small differences become small numbers.
inline std::uint16_t zigzag(std::uint16_t difference) {
    const std::uint32_t wide = difference;
    return static_cast<std::uint16_t>((wide << 1U) ^ ((wide & 0x8000U) != 0 ? 0xFFFFU : 0U));
}

inline std::uint16_t unzigzag(std::uint16_t code) {
    const std::uint32_t wide = code;
    return static_cast<std::uint16_t>((wide >> 1U) ^ ((wide & 1U) != 0 ? 0xFFFFU : 0U));
}

}  // namespace stopline
