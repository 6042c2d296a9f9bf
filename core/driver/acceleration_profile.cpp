#include "driver/acceleration_profile.h"

#include <algorithm>
#include <cmath>

namespace stopline {

AccelerationProfile leader_profile(const MesoSettings& settings) {
    AccelerationProfile profile;
    const std::vector<double>& speeds = settings.leader_profile_mps;
    if (speeds.empty()) return profile;
    profile.bins_per_mps = (AccelerationProfile::kBins - 0.5) / std::max(speeds.back(), 1.0);
    for (int bin = 0; bin < AccelerationProfile::kBins; ++bin) {
        const double middle_mps = (bin + 0.5) / profile.bins_per_mps;
        std::size_t nearest = 0;
        for (std::size_t k = 1; k < speeds.size(); ++k) {
            if (std::abs(speeds[k] - middle_mps) < std::abs(speeds[nearest] - middle_mps)) nearest = k;
        }
        profile.acceleration_mps2[static_cast<std::size_t>(bin)] = settings.leader_profile_mps2[nearest];
    }
    return profile;
}

AccelerationProfile tabulate_acceleration(const std::function<double(double)>& acceleration_mps2, double top_mps) {
    AccelerationProfile profile;
    profile.bins_per_mps = AccelerationProfile::kBins / top_mps;
    for (std::size_t bin = 0; bin < profile.acceleration_mps2.size(); ++bin) {
        const double middle_mps = (static_cast<double>(bin) + 0.5) / profile.bins_per_mps;
        profile.acceleration_mps2[bin] = acceleration_mps2(middle_mps);
    }
    return profile;
}

AccelerationProfile power_profile(const DriverTables& driver) {
    const double top_mps = (DriverTables::kProfileNodes - 1) / driver.power_nodes_per_mps;
    return tabulate_acceleration(
        [&](double speed_mps) {
            return interpolate_on_grid(driver.power_mps2, speed_mps * driver.power_nodes_per_mps);
        },
        top_mps);
}

}  // namespace stopline
