#include "v2v/platoon_length.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "string_stability/string_limits.h"

namespace stopline {

int stable_platoon_vehicles(const CaccSettings& cacc, double message_age_s, double lag_s) {
    constexpr double kLongest = 1000.0;
    FollowerModel model;
    model.cacc = cacc;
    model.cacc.v2v_delay_s = message_age_s;
    model.lag_s = lag_s;
    model.leader_lag_s = lag_s;
    const double followers = doubling_followers(peak_gain(Follower(model)).gain);
    return followers > kLongest ? 0 : std::max(static_cast<int>(followers), 1);
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

int max_platoon_vehicles(const PlatoonSettings& settings, const CaccSettings& cacc, double message_age_s,
                         double lag_s) {
    constexpr int kLongest = 1000;
    if (settings.max_vehicles == kAnyLength) return 0;
    if (settings.max_vehicles == kStableLength) return stable_platoon_vehicles(cacc, message_age_s, lag_s);
    int number = 0;
    const char* const end = settings.max_vehicles.data() + settings.max_vehicles.size();
    const auto [last, error] = std::from_chars(settings.max_vehicles.data(), end, number);
    return error == std::errc() && last == end && number >= 1 && number <= kLongest ? number : -1;
}

}  // namespace stopline
