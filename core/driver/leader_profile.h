// The acceleration of platoon leaders in the mesoscale mode, as a table by speed.
#pragma once

#include <array>

#include "driver/acceleration_laws.h"
#include "driver/driver_settings.h"

namespace stopline {

// The acceleration of platoon leaders as a function of speed. It is constant within each bin and beyond the last bin.
struct LeaderProfile {
    static constexpr int kBins = 64;
    double bins_per_mps = 0.0;  // 0: no profile
    std::array<double, kBins> acceleration_mps2{};
};
// Converts leader_profile_mps and leader_profile_mps2 of the settings into bins. Each bin gets the acceleration of the
// listed speed that is nearest to the middle of the bin. If the settings list no speeds, bins_per_mps is 0.
LeaderProfile leader_profile(const MesoSettings& settings);

// Returns, by speed, the lowest accelerations on lanes whose speed limit is above the limit for which the models were
// calibrated. The values come from DriverTables::power_mps2.
LeaderProfile power_profile(const DriverTables& driver);

}  // namespace stopline
