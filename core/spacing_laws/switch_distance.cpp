// SWITCH-2: up to the switch speed, the desired gap is the standstill gap. Above this speed, the gap grows linearly and
// reaches the reference gap at the reference speed. In the paper, the reference gap is the gap of the policy CTG-Ref
// at the reference speed (Section III.C.3).
#include "spacing_laws/gap_policy.h"

namespace stopline {

namespace {

void evaluate(const GapPolicySettings& s, std::span<const double> speed_mps, std::span<double> gap_m,
              std::span<double> slope_s) {
    const double slope = (s.reference_gap_m - s.standstill_gap_m) / (s.reference_speed_mps - s.switch_speed_mps);
    for (std::size_t i = 0; i < speed_mps.size(); ++i) {
        const double excess_mps = speed_mps[i] > s.switch_speed_mps ? speed_mps[i] - s.switch_speed_mps : 0.0;
        gap_m[i] = s.standstill_gap_m + slope * excess_mps;
        slope_s[i] = excess_mps > 0.0 ? slope : 0.0;
    }
}

}  // namespace

extern const GapLaw kSwitchDistanceLaw{
    "switch_distance", "standstill gap, above the switch speed growing to a reference gap (SWITCH-2)", evaluate};

}  // namespace stopline
