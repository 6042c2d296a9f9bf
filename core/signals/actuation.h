// Detectors of controllers that react to traffic. Each approach lane has two of them: one so near to the stop line that
// the first vehicle of a queue covers it, and one upstream.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "signals/signal_controller.h"

namespace stopline {

// Indices in SignalPlan::values.
inline constexpr std::size_t kStopDetector = 0;
inline constexpr std::size_t kAdvanceDetector = 1;
inline constexpr SignalParameter kStopDetectorParameter{
    "stop_detector", "m", 0, 50, "3 m", "distance from the stop line to the detector for queued vehicles"};
inline constexpr SignalParameter kAdvanceDetectorParameter{
    "advance_detector",
    "m",
    0,
    500,
    "40 m",
    "distance from the stop line to the upstream detector, which extends green; 0 m: none"};
inline constexpr std::array kActuationParameters{kStopDetectorParameter, kAdvanceDetectorParameter};

// Returns true if the detector is the one of this parameter, kStopDetector or kAdvanceDetector. The detectors of an
// imported programme count as detectors at the stop line.
bool is_at(const SignalPlan& plan, const SignalDetector& detector, std::size_t parameter);

// Returns true if the lane of the detector has green in the phase, or if an imported programme says that the detector
// extends the phase.
bool extends_phase(const SignalPlan& plan, const SignalDetector& detector, int phase);

// Returns true if the lane of the detector calls and extends a phase in a ring: no other phase serves the lane better.
// A phase that protects all movements of the lane serves it best. Next come green for all movements, a protected green
// for one of them, and green for one of them.
bool belongs_to_phase(const SignalPlan& plan, const SignalDetector& detector, int phase);

// Returns the ticks between two decisions about the end of a green. Imported controllers decide once a second, as those
// of SUMO do.
std::int64_t decision_ticks(const SignalPlan& plan);

// Returns the distances of both detectors from the stop line, m. A distance of 0 m adds no detector.
std::vector<double> actuation_detectors_m(const SignalSettings& settings);

}  // namespace stopline
