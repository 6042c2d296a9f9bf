#include "signals/actuation.h"

#include <algorithm>
#include <cmath>

namespace stopline {

namespace {

// Returns how well a phase serves the lane of a detector, from 0 (not at all) to 4 (all movements are protected).
int service(const SignalPlan& plan, const SignalDetector& detector, int phase) {
    if (!plan.lane_detectors.empty()) return extends_phase(plan, detector, phase) ? 4 : 0;
    const std::uint64_t green = plan.phases.phases[static_cast<std::size_t>(phase)].green_groups;
    const std::uint64_t protected_groups = plan.phases.rings.phases[static_cast<std::size_t>(phase)].protected_groups;
    if ((detector.groups & ~protected_groups) == 0) return 4;
    if ((detector.groups & ~green) == 0) return 3;
    if ((detector.groups & protected_groups) != 0) return 2;
    return (detector.groups & green) != 0 ? 1 : 0;
}

}  // namespace

bool is_at(const SignalPlan& plan, const SignalDetector& detector, std::size_t parameter) {
    constexpr double kTolerance_m = 0.01;
    if (!plan.lane_detectors.empty()) return parameter == kStopDetector && detector.phases != 0;
    const double to_line_m = plan.values[parameter];
    if (parameter == kAdvanceDetector && to_line_m <= 0.0) return false;
    return std::abs(detector.to_line_m - to_line_m) < kTolerance_m;
}

bool extends_phase(const SignalPlan& plan, const SignalDetector& detector, int phase) {
    if (!plan.lane_detectors.empty()) return (detector.phases >> phase & 1U) != 0;
    return (detector.groups & plan.phases.phases[static_cast<std::size_t>(phase)].green_groups) != 0;
}

bool belongs_to_phase(const SignalPlan& plan, const SignalDetector& detector, int phase) {
    const int own = service(plan, detector, phase);
    if (own == 0) return false;
    for (int other = 0; other < static_cast<int>(plan.phases.phases.size()); ++other) {
        if (service(plan, detector, other) > own) return false;
    }
    return true;
}

std::int64_t decision_ticks(const SignalPlan& plan) {
    return plan.lane_detectors.empty() ? 1 : std::max<std::int64_t>(to_ticks(1.0, plan.step_s), 1);
}

std::vector<double> actuation_detectors_m(const SignalSettings& settings) {
    std::vector<double> to_line_m;
    for (const SignalParameter& parameter : kActuationParameters) {
        if (const double value_m = signal_parameter(settings, parameter.name); value_m > 0.0)
            to_line_m.push_back(value_m);
    }
    return to_line_m;
}

}  // namespace stopline
