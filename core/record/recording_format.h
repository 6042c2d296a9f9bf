// A recording: what every vehicle and every light did in one run, in a file a hundred times smaller than a table. It is read by
// RecordingReader, and by the page that stopline-replay makes (apps/replay/page/decode.js); both know nothing else of the simulator.
//
//     file      = magic (8 bytes), version (u16), byte order mark (u16), section HEAD, sections FRMS, section ENDS; nothing behind it
//     section   = tag (4 bytes), bytes stored (u32), bytes when unpacked (u32), a Zstandard frame with checksum
//     HEAD      = JSON: where the run comes from, units, policies, causes, and the network (recording_header.h)
//     FRMS      = number of its first frame (u32), number of frames (u16), frames; about a minute, readable without any other
//     ENDS      = frames (u64), vehicle states (u64): a file without it is not whole
//
// All numbers are little-endian; `varint` is 7 bits a byte, the lowest first, the highest bit set in all bytes but the last.
// Every vehicle has a seat as long as it is in the network; what changes is told by seat, what moves comes in columns over seats:
//
//     frame     = lights that changed: n, then n times group, light (0 red, 1 green, 2 yellow)
//                 vehicles that left: n, then n times seat; the seat is free from the next frame on
//                 vehicles that came: n, then n times seat, number, policy, length (mm), lane, next lane + 1
//                 vehicles on another lane: n, then n times seat, lane, next lane + 1
//                 what vehicles wait for: n, then n times seat, cause, number of the vehicle waited for + 1; it holds as long
//                 as they stand (below 0.1 m/s), until told otherwise
//                 vehicles that entered the network since the frame before; that left it          (all of these as varint)
//                 seats (varint), a bit for each: something of it differs from what the reader expects; then for each such seat
//                 a byte of its speed, then for each a byte of its position, then 16 bits for each byte that is 255: speeds, positions
//
// Speeds and positions are whole multiples of the header's units, 16 bits, as difference to what the reader expects: speeds to
// the frame before, positions to where the mean of both speeds leads. Differences go as 0, -1, 1, -2 ... -> 0, 1, 2, 3 ... modulo
// 2^16. Who came, or came to another lane, was at 0 before; an empty seat rests at 0.
// Before the first frame of a FRMS all seats are empty and all lights red.
//
// Rejected: floating point columns (three times the size for digits that nobody sees); a row a vehicle (compresses half as well);
// a full column for all seats (half of the vehicles stand: three times as long to write); Zstandard's slower levels.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace stopline {

inline constexpr std::string_view kRecordingMagic{"\x89SLR\r\n\x1a\n", 8};  // as PNG's: a transfer as text damages it
inline constexpr std::uint16_t kRecordingVersion = 1;
inline constexpr std::uint16_t kByteOrderMark = 0x0102;
inline constexpr std::string_view kHeadTag = "HEAD";
inline constexpr std::string_view kFramesTag = "FRMS";
inline constexpr std::string_view kEndTag = "ENDS";
inline constexpr int kFramesInSection = 128;
inline constexpr std::uint32_t kMostSectionBytes = 1U << 28U;
inline constexpr std::uint16_t kWide = 255;  // codes from this on take 16 bits more

inline constexpr double kSpeedUnit_mps = 0.01;
inline constexpr double kFinestPosition_m = 0.01;

// Where the mean of two speeds leads within a frame, from their sum in units, in 1 / 4096 position units. 32 bits are enough.
inline constexpr std::uint32_t kMostAdvance = 0x7FFF;
inline std::uint32_t expected_advance(std::uint32_t speed_sum, std::uint32_t advance_q12) {
    return (speed_sum * advance_q12) >> 12U;
}

inline std::uint16_t zigzag(std::uint16_t difference) {
    const std::uint32_t wide = difference;
    return static_cast<std::uint16_t>((wide << 1U) ^ ((wide & 0x8000U) != 0 ? 0xFFFFU : 0U));
}

inline std::uint16_t unzigzag(std::uint16_t code) {
    const std::uint32_t wide = code;
    return static_cast<std::uint16_t>((wide >> 1U) ^ ((wide & 1U) != 0 ? 0xFFFFU : 0U));
}

}  // namespace stopline
