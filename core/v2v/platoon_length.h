// The length of a platoon with a constant distance up to which errors stay small.
#pragma once

#include "driver/driver_settings.h"
#include "v2v/plan.h"

namespace stopline {

// Returns the largest number of vehicles behind which an oscillation with the worst frequency has not doubled:
// n = ln 2 / ln max|Gamma|, with the transfer function Gamma from a vehicle's acceleration to that of its follower
// (string_stability/string_limits.h). The result is at least 1, or 0 (no limit) if oscillations do not grow. Holds
// for a constant distance and messages of the leader only. `message_age_s`: mean age of the messages. `lag_s`: lag of
// the powertrains.
int stable_platoon_vehicles(const CaccSettings& cacc, double message_age_s, double lag_s);

// Returns true if vehicles need a V2vReceiver: a channel is active, or platoons have a leader or a limited length.
bool needs_receivers(const DriverSettings& driver);

// Returns the mean age of the newest message of a lossless channel. `step_s`: a receiver looks for messages once in
// this time.
double mean_message_age_s(const DriverSettings& driver, double step_s);

inline constexpr const char* kAnyLength = "none";
inline constexpr const char* kStableLength = "by_stability";
// Returns the largest number of vehicles of a platoon; 0: no limit. -1: the setting is not valid. The other parameters
// are those of stable_platoon_vehicles().
int max_platoon_vehicles(const PlatoonSettings& settings, const CaccSettings& cacc, double message_age_s, double lag_s);

}  // namespace stopline
