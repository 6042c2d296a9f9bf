// The ladder of driving modes of a vehicle that misses messages. The age of the newest message from the leader selects
// the mode:
//     messages      up to 0.3 s  the spacing policy, with the message as feedforward
//     old_messages  up to 0.5 s  CACC with a time gap: the message is too old for a constant distance
//     radar         up to 1.0 s  dCACC: radar gives an estimate of the leader's acceleration (Ploeg et al. 2015)
//     acc           older, or the leader has no V2V  ACC: the leader's acceleration counts as unknown
// A vehicle that uses the messages of its platoon leader (topology predecessor_and_leader) is in the mode
// `platoon_leader` instead of `messages`. It uses them up to an age of 0.15 s, without hysteresis.
//
// A vehicle changes to a worse mode at once. It returns to a better mode when no age has demanded the present mode for
// kHysteresis_s. The limits and the hysteresis are our choice, after the states of PlatoonSAFE.
//
// The functions are templates over the number type D: double or Single for one vehicle, Batch for several ones.
#pragma once

#include <array>
#include <cstdint>

#include "base/simd/arithmetic.h"

namespace stopline {

// The order of the first four is that of the ladder.
enum class V2vMode : std::uint8_t { messages, old_messages, radar, acc, platoon_leader };
inline constexpr std::array<const char*, 5> kV2vModeNames{"messages", "old_messages", "radar", "acc", "platoon_leader"};

// Returns the mode as a number, as the functions below need it.
constexpr double number_of(V2vMode mode) { return static_cast<double>(mode); }

inline constexpr std::array<double, 3> kLongestAge_s{0.3, 0.5, 1.0};  // [mode] longest age of the newest message
inline constexpr double kHysteresis_s = 0.5;
inline constexpr double kLongestPlatoonLeaderAge_s = 0.15;  // of a message of the platoon leader

// Returns the smallest string-stable time gap of a CACC whose messages have an age, s. Computed for the default gains
// (0.2 1/s2 and 0.7 1/s), a lag of 0.1 s of the powertrain, and a radar without delay; linear between the ages. A test
// compares the values with the linear analysis (string_stability/string_limits.h), which would take too long at the
// start of each run.
double stable_time_gap_s(double age_s);

// The mode of a vehicle, and its memory for the hysteresis. All members hold whole numbers.
template <class D>
struct FallbackModeOf {
    D mode;   // V2vMode
    D worst;  // worst mode that the ages in these `ticks` demanded
    D ticks;  // steps since the age last demanded `mode`; without meaning in the mode V2vMode::messages
};

// Updates the mode. `demanded`: the mode that the present age demands. Returns the flag that the mode changes.
template <class D>
STOPLINE_INLINE D update_mode(FallbackModeOf<D>& fallback, const D& demanded, double hysteresis_ticks) {
    const D before = fallback.mode;
    const D falls = STOPLINE_FLAG(D, demanded >= before);
    const D worst = max_of(demanded, fallback.worst);
    const D returns = STOPLINE_FLAG(D, fallback.ticks >= hysteresis_ticks);
    const D sets = max_of(falls, returns);
    fallback.mode = choose(falls, demanded, choose(returns, worst, before));
    fallback.worst = choose(sets, splat<D>(0.0), worst);
    fallback.ticks = choose(sets, splat<D>(0.0), fallback.ticks);
    return STOPLINE_FLAG(D, fallback.mode < before) + STOPLINE_FLAG(D, fallback.mode > before);
}

// A vehicle keeps at least its standstill gap plus the time gap times its speed.
template <class D>
struct TimeGapOf {
    D time_gap_s;
    D rate;  // change of the time gap in s per s
};

// Moves the time gap towards a target. At the speed `speed_mps` the gap thus opens by at most kOpening_mps and closes
// by at most kClosing_mps. The rate itself changes by at most kRamp_mps2, so the controller sees no step. Below
// kSlow_mps the time gap changes as at kSlow_mps.
template <class D>
STOPLINE_INLINE void update_time_gap(TimeGapOf<D>& gap, const D& target_s, const D& speed_mps, double dt) {
    constexpr double kOpening_mps = 1.5;
    constexpr double kClosing_mps = 1.0;
    constexpr double kRamp_mps2 = 1.0;
    constexpr double kSlow_mps = 5.0;
    constexpr double kGain_1ps = 1.0;
    constexpr double kRounding_s = 1e-4;
    const D zero = splat<D>(0.0);
    const D per_speed = 1.0 / max_of(speed_mps, splat<D>(kSlow_mps));
    const D towards = kGain_1ps * (target_s - gap.time_gap_s);
    const D wanted = clamped(towards, D(-kClosing_mps * per_speed), D(kOpening_mps * per_speed));
    const D most = kRamp_mps2 * per_speed * dt;
    const D rate = gap.rate + clamped(D(wanted - gap.rate), D(-most), most);
    const D time_gap_s = gap.time_gap_s + rate * dt;
    // A target of 0 closes the gap completely.
    const D is_closed = STOPLINE_FLAG(D, target_s == zero) * STOPLINE_FLAG(D, time_gap_s < kRounding_s);
    gap.time_gap_s = choose(is_closed, zero, time_gap_s);
    gap.rate = choose(is_closed, zero, rate);
}

}  // namespace stopline
