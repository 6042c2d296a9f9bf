// SWITCH-2: CDG up to the switch speed; above it the gap grows linearly to the reference gap at the reference speed, so that
// the distance of CTG-Ref is reached there (Section III.C.3), and on with the same slope.
#include "driver/gap_policy.h"

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
    "switch_distance", "constant distance, growing to a reference gap above the switch speed", evaluate};

}  // namespace stopline
