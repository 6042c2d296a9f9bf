// SWITCH-1: up to the switch speed, the desired gap is the standstill gap. Above this speed, the gap grows by the time
// gap times the excess speed (Section III.C.3 of the paper).
#include "spacing_laws/gap_policy.h"

namespace stopline {

namespace {

constexpr std::array kSwitchTimeGapParameters{kTimeGapParameter, kSwitchSpeedParameter};

void switch_time_gap(const GapPolicy& policy, std::span<const double> speed_mps, std::span<double> gap_m,
                     std::span<double> slope_s) {
    const double time_gap_s = policy.values[0];
    const double switch_speed_mps = policy.values[1];
    for (std::size_t i = 0; i < speed_mps.size(); ++i) {
        const double excess_mps = speed_mps[i] > switch_speed_mps ? speed_mps[i] - switch_speed_mps : 0.0;
        gap_m[i] = policy.settings.standstill_gap_m + time_gap_s * excess_mps;
        slope_s[i] = excess_mps > 0.0 ? time_gap_s : 0.0;
    }
}

MesoGap switch_time_gap_meso(const GapPolicy& policy) {
    return {kConstantDistanceFamily, policy.settings.standstill_gap_m, 0.0, true};
}

}  // namespace

extern const GapLaw kSwitchTimeGapLaw{"switch_time_gap",
                                      "standstill gap plus time gap x (speed - switch speed) (SWITCH-1)",
                                      kSwitchTimeGapParameters, switch_time_gap, switch_time_gap_meso};

}  // namespace stopline
