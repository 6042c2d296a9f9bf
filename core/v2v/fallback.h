// The ladder of driving modes of a vehicle that misses messages. The age of the newest message from the leader selects
// the mode:
//     messages      up to 0.3 s  the spacing policy, with the message as feedforward
//     old_messages  up to 0.5 s  CACC with a time gap: the message is too old for a constant distance
//     radar         up to 1.0 s  dCACC: radar gives an estimate of the leader's acceleration (Ploeg et al. 2015)
//     acc           older, or the leader has no V2V  ACC: the leader's acceleration counts as unknown
// A vehicle changes to a worse mode at once. It returns to a better mode when no age has demanded the present mode for
// kHysteresis_s. The limits and the hysteresis are our choice, after the states of PlatoonSAFE.
#pragma once

#include <array>
#include <cstdint>

namespace stopline {

// The order is that of the ladder.
enum class V2vMode : std::uint8_t { messages, old_messages, radar, acc };
inline constexpr std::array<const char*, 4> kV2vModeNames{"messages", "old_messages", "radar", "acc"};

inline constexpr std::array<double, 3> kLongestAge_s{0.3, 0.5, 1.0};  // [mode] longest age of the newest message
inline constexpr double kHysteresis_s = 0.5;

// Returns the smallest string-stable time gap of a CACC whose messages have an age, s. Computed for the default gains
// (0.2 1/s2 and 0.7 1/s) and a lag of 0.1 s of the powertrain; linear between the ages.
double stable_time_gap_s(double age_s);

// The fallback of a vehicle.
struct Fallback {
    V2vMode mode = V2vMode::messages;
    V2vMode worst = V2vMode::messages;  // worst mode that the ages since `since_tick` demand
    int since_tick = 0;                 // last tick at which the age demanded `mode`
    // The vehicle keeps at least its standstill gap plus this time gap times its speed.
    float time_gap_s = 0.0F;
    float time_gap_rate = 0.0F;
};

// Updates the mode at a tick. `demanded`: the mode that the present age demands. Returns true if the mode changes.
inline bool update_mode(Fallback& fallback, V2vMode demanded, int tick, int hysteresis_ticks) {
    if (demanded >= fallback.mode) {
        const bool changes = demanded > fallback.mode;
        fallback.mode = demanded;
        fallback.worst = V2vMode::messages;
        fallback.since_tick = tick;
        return changes;
    }
    if (demanded > fallback.worst) fallback.worst = demanded;
    if (tick - fallback.since_tick < hysteresis_ticks) return false;
    fallback.mode = fallback.worst;
    fallback.worst = V2vMode::messages;
    fallback.since_tick = tick;
    return true;
}

// Moves the time gap towards a target. At the speed `speed_mps` the gap thus opens by at most kOpening_mps and closes
// by at most kClosing_mps. The rate itself changes by at most kRamp_mps2, so the controller sees no step. Below
// kSlow_mps the time gap changes as at kSlow_mps.
inline void update_time_gap(Fallback& fallback, double target_s, double speed_mps, double dt) {
    constexpr double kOpening_mps = 1.5;
    constexpr double kClosing_mps = 1.0;
    constexpr double kRamp_mps2 = 1.0;
    constexpr double kSlow_mps = 5.0;
    constexpr double kGain_1ps = 1.0;
    if (target_s == 0.0 && fallback.time_gap_s == 0.0F) return;
    const double per_speed = 1.0 / (speed_mps > kSlow_mps ? speed_mps : kSlow_mps);
    const double towards = kGain_1ps * (target_s - static_cast<double>(fallback.time_gap_s));
    const double wanted = towards > kOpening_mps * per_speed    ? kOpening_mps * per_speed
                          : towards < -kClosing_mps * per_speed ? -kClosing_mps * per_speed
                                                                : towards;
    const double change = wanted - static_cast<double>(fallback.time_gap_rate);
    const double most = kRamp_mps2 * per_speed * dt;
    const double rate = static_cast<double>(fallback.time_gap_rate) + (change > most    ? most
                                                                       : change < -most ? -most
                                                                                        : change);
    const double time_gap_s = static_cast<double>(fallback.time_gap_s) + rate * dt;
    constexpr double kRounding_s = 1e-4;
    const bool is_closed = target_s == 0.0 && time_gap_s < kRounding_s;
    fallback.time_gap_s = is_closed ? 0.0F : static_cast<float>(time_gap_s);
    fallback.time_gap_rate = is_closed ? 0.0F : static_cast<float>(rate);
}

}  // namespace stopline
