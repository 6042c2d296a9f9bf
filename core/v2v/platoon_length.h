// The length of a platoon with a constant distance up to which errors stay small.
#pragma once

#include "driver/driver_settings.h"
#include "v2v/plan.h"

namespace stopline {

// Returns the largest number of vehicles behind which the error of the worst frequency has not doubled:
// n = ln 2 / ln max|Gamma|, with the transfer function Gamma from a vehicle's acceleration to that of its follower.
// `delay_s`: mean age of the messages. Holds for a constant distance, one leader, and the default gains.
//
// For now, the values come from a table of a linear analysis with a lag of 0.3 s, interpolated over the delay. An
// analysis of the settings of the run can replace the table here.
int stable_platoon_vehicles(double delay_s);

// Returns true if vehicles need a V2vReceiver: a channel is active, or platoons have a leader or a limited length.
bool needs_receivers(const DriverSettings& driver);

// Returns the mean age of the newest message of a lossless channel. `step_s`: a receiver looks for messages once in
// this time.
double mean_message_age_s(const DriverSettings& driver, double step_s);

inline constexpr const char* kAnyLength = "none";
inline constexpr const char* kStableLength = "by_stability";
// Returns the largest number of vehicles of a platoon; 0: no limit. -1: the setting is not valid.
int max_platoon_vehicles(const PlatoonSettings& settings, double message_age_s);

}  // namespace stopline
