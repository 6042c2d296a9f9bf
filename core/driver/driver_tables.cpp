// Compiles the settings of the driver into the tables of the kernels.
#include <algorithm>

#include "base/input_error.h"
#include "driver/acceleration_laws.h"
#include "driver/idm.h"

namespace stopline {

DriverTables compile_driver(const DriverSettings& settings) {
    const FreeDriveSettings& free = settings.free_drive;
    if (free.speed_mps.empty() || free.speed_mps.size() != free.acceleration_mps2.size()) {
        throw InputError("driver: the acceleration profile needs at least one speed, and one acceleration per speed");
    }
    DriverTables t;
    t.cacc = settings.cacc;
    t.stop = settings.stop;
    const IdmParameters idm = idm_parameters(settings.human.idm, 0.0, 0.0);
    t.human = {std::min(idm.acceleration_mps2, settings.cacc.acceleration_max_mps2), idm.closing_s2pm};
    t.speed_gain_1ps = free.speed_gain_1ps;
    t.deceleration_mps2 = free.deceleration_mps2;
    const double top_mps = std::max(free.speed_mps.back(), 1.0);
    t.profile_nodes_per_mps = (DriverTables::kProfileNodes - 1) / top_mps;
    std::size_t k = 1;
    for (std::size_t node = 0; node < t.profile_mps2.size(); ++node) {
        const double speed = static_cast<double>(node) / t.profile_nodes_per_mps;
        while (k + 1 < free.speed_mps.size() && free.speed_mps[k] < speed) ++k;
        if (free.speed_mps.size() == 1) {
            t.profile_mps2[node] = free.acceleration_mps2[0];
            continue;
        }
        const double share = (speed - free.speed_mps[k - 1]) / (free.speed_mps[k] - free.speed_mps[k - 1]);
        const double clipped = std::clamp(share, 0.0, 1.0);
        t.profile_mps2[node] =
            free.acceleration_mps2[k - 1] + clipped * (free.acceleration_mps2[k] - free.acceleration_mps2[k - 1]);
    }
    return t;
}

void extend_by_power(const FreeDriveSettings& free, const std::function<double(double)>& available_mps2,
                     DriverTables& t) {
    constexpr double kTop_mps = 250.0 / 3.6;
    constexpr double kRounding = 1.001;
    const double profile_limit_mps = free.profile_limit_mps > 0.0 ? free.profile_limit_mps : free.speed_mps.back();
    // The desired speed of a follower that closes its gap is catch_up_factor times the limit. On a road with the limit
    // profile_limit_mps, this speed must not count as beyond the profile.
    t.profile_end_mps = kRounding * t.cacc.catch_up_factor * profile_limit_mps;
    t.power_nodes_per_mps = (DriverTables::kProfileNodes - 1) / kTop_mps;
    for (std::size_t node = 0; node < t.power_mps2.size(); ++node) {
        const double speed_mps = static_cast<double>(node) / t.power_nodes_per_mps;
        t.power_mps2[node] = free.power_share * std::max(available_mps2(speed_mps), 0.0);
    }
}

}  // namespace stopline
