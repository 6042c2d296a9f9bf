#include "v2v/platoon_length.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

namespace stopline {

int stable_platoon_vehicles(double delay_s) {
    constexpr std::array kDelay_s{0.02, 0.05, 0.10, 0.15};
    constexpr std::array kVehicles{43.0, 17.0, 8.0, 6.0};
    // max|Gamma| grows smoothly with the delay, so its logarithm ln 2 / n is interpolated, not n itself.
    const double two = std::log(2.0);
    std::size_t k = 1;
    while (k + 1 < kDelay_s.size() && kDelay_s[k] < delay_s) ++k;
    const double share = (delay_s - kDelay_s[k - 1]) / (kDelay_s[k] - kDelay_s[k - 1]);
    const double below = two / kVehicles[k - 1];
    const double growth = below + std::max(share, 0.0) * (two / kVehicles[k] - below);
    return static_cast<int>(two / growth);
}

bool needs_receivers(const DriverSettings& driver) {
    return is_active_channel(driver.v2v, driver.cacc.radar_range_m) || driver.v2v.topology != "predecessor" ||
           driver.platoon.max_vehicles != kAnyLength;
}

double mean_message_age_s(const DriverSettings& driver, double step_s) {
    const V2vSettings& v2v = driver.v2v;
    const double jitter_s = v2v.jitter_form == "exponential" ? v2v.jitter_s : 0.5 * v2v.jitter_s;
    return driver.cacc.v2v_delay_s + jitter_s + 0.5 * std::max(message_interval_s(v2v, step_s) - step_s, 0.0);
}

int max_platoon_vehicles(const PlatoonSettings& settings, double message_age_s) {
    constexpr int kLongest = 1000;
    if (settings.max_vehicles == kAnyLength) return 0;
    if (settings.max_vehicles == kStableLength) return stable_platoon_vehicles(message_age_s);
    int number = 0;
    const char* const end = settings.max_vehicles.data() + settings.max_vehicles.size();
    const auto [last, error] = std::from_chars(settings.max_vehicles.data(), end, number);
    return error == std::errc() && last == end && number >= 1 && number <= kLongest ? number : -1;
}

}  // namespace stopline
