// The V2V settings of a run, prepared for the simulation.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "v2v/channel.h"
#include "v2v/fallback.h"
#include "v2v/leader_filter.h"

namespace stopline {

struct V2vPlan {
    // false: every message of the leader arrives after CaccSettings::v2v_delay_s, and no other message is used. The
    // receive phase is then skipped, and vehicles have no V2vReceiver.
    bool is_active = false;
    V2vSettings settings;
    const V2vChannel* channel = nullptr;
    std::uint64_t key = 0;  // v2v_key() of the seed
    int delay_ticks = 1;
    int interval_ticks = 1;
    int longest_jitter_ticks = 0;
    double jitter_ticks = 0.0;  // uniform: largest jitter; exponential: mean jitter
    bool exponential = false;
    std::array<int, kLongestAge_s.size()> longest_age_ticks{};  // [mode] longest age of the newest message
    // [age in ticks] stable_time_gap_s(), up to the mode `old_messages`. Longer ages follow with the last value, so
    // that the number of entries is a multiple of kSimdWidth.
    std::vector<float> time_gap_of_age_s;
    int hysteresis_ticks = 0;
    LeaderFilter filter;
    bool is_lossless = false;  // true: the channel loses no message of the leader
    // Longest time from the leader's braking until a follower knows of it, without the lag of the follower's brake, s.
    double longest_notice_s = 0.0;
    bool uses_platoon_leader = false;  // topology predecessor_and_leader
    double platoon_time_gap_s = 0.0;   // PlatoonSettings::time_gap_s
    int max_platoon = 0;               // largest number of vehicles of a platoon; 0: no limit

    // Time in which a message that has arrived is certain to be used, in steps. Vehicles store their messages so long.
    int stored_ticks() const { return delay_ticks + longest_jitter_ticks + 2 * interval_ticks; }
    // Number of messages that a vehicle stores: a power of two.
    int stored_messages() const {
        return static_cast<int>(std::bit_ceil(static_cast<unsigned>(stored_ticks() / interval_ticks + 2)));
    }
};

// Returns true if messages do not simply arrive after the constant delay. `radar_range_m`: messages from beyond the
// range of the radar are never used.
bool is_active_channel(const V2vSettings& settings, double radar_range_m);

// `active`: see is_active_channel().
V2vPlan make_v2v_plan(const V2vSettings& settings, bool active, double delay_s, double step_s, std::uint64_t seed);

// Largest jitter, as a number of intervals between messages. A receiver stores this number of messages that are on
// their way.
inline constexpr int kJitterIntervals = 2;
// An exponential jitter is cut off at this multiple of its mean; 0.7 % of the draws are longer.
inline constexpr double kLongestJitter = 5.0;
// Returns the time between two messages of a vehicle, s. It need not be a whole number of steps.
double message_interval_s(const V2vSettings& settings, double step_s);

// Returns the random part of the delay of a message.
int jitter_ticks(const V2vPlan& plan, std::uint64_t link, std::int64_t number);
// Returns the first tick at which a vehicle sends, less than one interval after tick 0. The vehicle then sends once in
// each interval.
int first_send_tick(const V2vPlan& plan, int vehicle);
// Returns the first tick from `tick` on at which a vehicle sends. `first`: its first_send_tick().
int next_send_tick(const V2vPlan& plan, int first, int tick);

}  // namespace stopline
