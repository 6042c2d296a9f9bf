// SWITCH-1: up to the switch speed, the desired gap is the standstill gap. Above this speed, the gap grows by the time
// gap times the excess speed (Section III.C.3 of the paper).
#include "spacing_laws/gap_policy.h"

namespace stopline {

namespace {

void evaluate(const GapPolicySettings& s, std::span<const double> speed_mps, std::span<double> gap_m,
              std::span<double> slope_s) {
    for (std::size_t i = 0; i < speed_mps.size(); ++i) {
        const double excess_mps = speed_mps[i] > s.switch_speed_mps ? speed_mps[i] - s.switch_speed_mps : 0.0;
        gap_m[i] = s.standstill_gap_m + s.time_gap_s * excess_mps;
        slope_s[i] = excess_mps > 0.0 ? s.time_gap_s : 0.0;
    }
}

}  // namespace

extern const GapLaw kSwitchTimeGapLaw{"switch_time_gap",
                                      "standstill gap plus time gap x (speed - switch speed) (SWITCH-1)", evaluate};

}  // namespace stopline
