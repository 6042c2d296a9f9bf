// Accelerations of the mesoscale mode as tables by speed: those of platoon leaders, and bounds for all vehicles.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>

#include "driver/acceleration_laws.h"
#include "driver/driver_settings.h"

namespace stopline {

// An acceleration as a function of speed. It is constant within each bin and beyond the last bin.
struct AccelerationProfile {
    static constexpr int kBins = 64;
    double bins_per_mps = 0.0;  // 0: no profile
    std::array<double, kBins> acceleration_mps2{};

    double at(double speed_mps) const {
        const double bin = std::clamp(speed_mps * bins_per_mps, 0.0, kBins - 1.0);
        return acceleration_mps2[static_cast<std::size_t>(bin)];
    }
};

// Converts leader_profile_mps and leader_profile_mps2 of the settings into bins. Each bin gets the acceleration of the
// listed speed that is nearest to the middle of the bin. If the settings list no speeds, bins_per_mps is 0.
AccelerationProfile leader_profile(const MesoSettings& settings);

// Tabulates an acceleration, m/s2, over the speed, m/s. Speeds beyond `top_mps` have the value of the last bin.
AccelerationProfile tabulate_acceleration(const std::function<double(double)>& acceleration_mps2, double top_mps);

// Returns, by speed, the lowest accelerations on lanes whose speed limit is above the limit for which the models were
// calibrated. The values come from DriverTables::power_mps2.
AccelerationProfile power_profile(const DriverTables& driver);

}  // namespace stopline
