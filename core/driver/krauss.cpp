#include "driver/krauss.h"

#include <algorithm>

namespace stopline {

LeaderProfile leader_profile(const MesoSettings& settings) {
    LeaderProfile profile;
    const std::vector<double>& speeds = settings.leader_profile_mps;
    if (speeds.empty()) return profile;
    profile.bins_per_mps = (LeaderProfile::kBins - 0.5) / std::max(speeds.back(), 1.0);
    for (int bin = 0; bin < LeaderProfile::kBins; ++bin) {
        const double middle_mps = (bin + 0.5) / profile.bins_per_mps;
        std::size_t nearest = 0;
        for (std::size_t k = 1; k < speeds.size(); ++k) {
            if (std::abs(speeds[k] - middle_mps) < std::abs(speeds[nearest] - middle_mps)) nearest = k;
        }
        profile.acceleration_mps2[static_cast<std::size_t>(bin)] = settings.leader_profile_mps2[nearest];
    }
    return profile;
}

LeaderProfile power_profile(const DriverTables& driver) {
    LeaderProfile profile;
    const double top_mps = (DriverTables::kProfileNodes - 1) / driver.power_nodes_per_mps;
    profile.bins_per_mps = LeaderProfile::kBins / top_mps;
    for (std::size_t bin = 0; bin < profile.acceleration_mps2.size(); ++bin) {
        const double middle_mps = (static_cast<double>(bin) + 0.5) / profile.bins_per_mps;
        profile.acceleration_mps2[bin] =
            interpolate_on_grid(driver.power_mps2, middle_mps * driver.power_nodes_per_mps);
    }
    return profile;
}

Krauss make_krauss_model(const MesoSettings& settings, const MesoGap& gap) {
    const bool time_gap = gap.model == MesoGap::Model::time_gap;
    const KraussSettings& s = time_gap ? settings.constant_time : settings.constant_distance;
    Krauss k;
    k.acceleration_mps2 = s.acceleration_mps2;
    k.constant_power_speed_mps = s.constant_power_speed_mps;
    k.transient_gap_s2 = s.transient_gap_s2;
    k.catch_up_factor = s.catch_up_factor;
    k.gap_tracking = s.gap_tracking;
    k.anticipation_s = s.anticipation_s;
    k.deceleration_mps2 = s.deceleration_mps2;
    k.reaction_s = s.reaction_s;
    k.standstill_gap_m = s.standstill_gap_m + gap.standstill_gap_m - settings.calibrated_standstill_gap_m;
    k.dawdling = s.dawdling;
    if (time_gap) {
        k.reaction_s = std::max(k.reaction_s + gap.time_gap_s - settings.calibrated_time_gap_s, 0.0);
    } else {
        k.constant_distance = true;
        k.band_m = settings.band_m;
        k.below_band_speed_share = settings.below_band_speed_share;
    }
    return k;
}

}  // namespace stopline
