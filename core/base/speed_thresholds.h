// Speed thresholds, m/s. Each purpose has its own threshold, below which a vehicle is treated as stopped or queued.
#pragma once

namespace stopline {

// Statistics and causes of delay: a vehicle slower than this counts as stopped. SUMO uses the same threshold to count a
// vehicle as waiting.
inline constexpr double kStoppedSpeed_mps = 0.1;

// Length of a queue at a stop line: a vehicle slower than 5 km/h (walking speed) counts as queued, as in the Highway
// Capacity Manual.
inline constexpr double kQueuedSpeed_mps = 5.0 / 3.6;

// Right of way and keep-clear rule: drivers treat a vehicle slower than this as part of a standing queue.
inline constexpr double kCrawlingSpeed_mps = 1.0;

// Full dynamics: the brake holds a vehicle slower than this until the driver accelerates, like a hill-start assistant.
inline constexpr double kBrakeHoldSpeed_mps = 1e-3;

// Full dynamics: the speed of a vehicle slower than this is set to 0, because so low a speed is only a rounding error.
inline constexpr double kSpeedRounding_mps = 1e-6;

// Mesoscale mode: the speed of a vehicle slower than this is set to 0. Otherwise a follower would approach its
// standstill gap forever without reaching it.
inline constexpr double kMesoStopSpeed_mps = 0.01;

}  // namespace stopline
