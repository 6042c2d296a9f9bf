// The speeds below which a vehicle counts as stopped, in m/s. There is one constant for each purpose.
#pragma once

namespace stopline {

// In statistics and delay causes a slower vehicle counts as stopped. SUMO uses the same limit for waiting vehicles.
inline constexpr double kStoppedSpeed_mps = 0.1;

// In the length of a queue at a stop line a slower vehicle counts: walking speed, as in the Highway Capacity Manual.
inline constexpr double kQueuedSpeed_mps = 5.0 / 3.6;

// For right of way and the keep-clear rule, drivers treat a slower vehicle as part of a standing queue.
inline constexpr double kCrawlingSpeed_mps = 1.0;

// Full dynamics: the brake holds a slower vehicle as a hill holder does.
inline constexpr double kBrakeHoldSpeed_mps = 1e-3;

// Full dynamics: a slower vehicle counts as standing, because such a speed is only a rounding error.
inline constexpr double kSpeedRounding_mps = 1e-6;

// Mesoscale mode: a slower vehicle has speed 0. Without this limit the last part of a gap would take forever to close.
inline constexpr double kMesoStopSpeed_mps = 0.01;

}  // namespace stopline
