#include "driver/krauss.h"

#include <algorithm>

namespace stopline {

Krauss Krauss::make(const FollowingSettings& settings, const MesoGap& gap) {
    const MesoSettings& meso = settings.meso;
    const bool time_gap = gap.family != kConstantDistanceFamily;
    const KraussSettings& s = time_gap ? meso.constant_time : meso.constant_distance;
    Krauss k;
    k.acceleration_mps2 = s.acceleration_mps2;
    k.constant_power_speed_mps = s.constant_power_speed_mps;
    k.transient_gap_s2 = s.transient_gap_s2;
    k.catch_up_factor = s.catch_up_factor;
    k.gap_tracking = s.gap_tracking;
    k.anticipation_s = s.anticipation_s;
    k.deceleration_mps2 = s.deceleration_mps2;
    k.reaction_s = s.reaction_s;
    k.standstill_gap_m = s.standstill_gap_m + gap.standstill_gap_m - meso.calibrated_standstill_gap_m;
    k.dawdling = s.dawdling;
    if (time_gap) {
        k.reaction_s = std::max(k.reaction_s + gap.time_gap_s - meso.calibrated_time_gap_s, 0.0);
    } else {
        k.constant_distance = true;
        k.band_m = meso.band_m;
        k.below_band_speed_share = meso.below_band_speed_share;
    }
    return k;
}

}  // namespace stopline
