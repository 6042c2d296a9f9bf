#include "v2v/plan.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace stopline {

namespace {

// Returns true if no message within the range is lost: the channel has no losses, or its share of lost messages is 0.
bool loses_nothing(const V2vChannel& channel, const V2vSettings& settings) {
    if (channel.is_delivered == nullptr) return true;
    const bool has_share = std::any_of(channel.fields.begin(), channel.fields.end(),
                                       [](std::string_view field) { return field == "loss"; });
    return has_share && settings.loss == 0.0;
}

int ticks_of(double time_s, double step_s) { return static_cast<int>(std::llround(time_s / step_s)); }

}  // namespace

bool is_active_channel(const V2vSettings& settings, double radar_range_m) {
    return settings.channel != "ideal" || settings.interval_s > 0.0 || settings.jitter_s > 0.0 ||
           settings.range_m < radar_range_m;
}

double message_interval_s(const V2vSettings& settings, double step_s) {
    constexpr double kUsual_s = 0.1;
    if (settings.interval_s > 0.0) return settings.interval_s;
    return settings.channel == "ideal" ? step_s : kUsual_s;
}

V2vPlan make_v2v_plan(const V2vSettings& settings, bool active, double delay_s, double step_s, std::uint64_t seed) {
    V2vPlan plan;
    if (!active) return plan;
    plan.is_active = true;
    plan.settings = settings;
    plan.channel = &find_v2v_channel(settings.channel);
    plan.key = v2v_key(seed);
    // The delay is rounded up: a message is never used before it arrives.
    constexpr double kRounding = 1e-9;
    plan.delay_ticks = std::max(static_cast<int>(std::ceil(delay_s / step_s - kRounding)), 1);
    plan.interval_ticks = std::max(ticks_of(message_interval_s(settings, step_s), step_s), 1);
    plan.exponential = settings.jitter_form == "exponential";
    plan.jitter_ticks = settings.jitter_s / step_s;
    plan.longest_jitter_ticks =
        static_cast<int>(std::ceil(plan.jitter_ticks * (plan.exponential ? kLongestJitter : 1.0) - kRounding));
    plan.longest_jitter_ticks = std::min(plan.longest_jitter_ticks, kJitterIntervals * plan.interval_ticks);
    for (std::size_t mode = 0; mode < kLongestAge_s.size(); ++mode) {
        plan.longest_age_ticks[mode] = ticks_of(kLongestAge_s[mode], step_s);
    }
    const int longest_ticks = plan.longest_age_ticks[static_cast<std::size_t>(V2vMode::old_messages)];
    for (int age = 0; age <= longest_ticks || age % kSimdWidth != 0; ++age) {
        plan.time_gap_of_age_s.push_back(static_cast<float>(stable_time_gap_s(std::min(age, longest_ticks) * step_s)));
    }
    plan.hysteresis_ticks = ticks_of(kHysteresis_s, step_s);
    plan.filter = make_leader_filter(step_s);
    plan.is_lossless = loses_nothing(*plan.channel, settings);
    plan.longest_notice_s = (plan.delay_ticks + plan.longest_jitter_ticks + plan.interval_ticks) * step_s;
    plan.uses_platoon_leader = settings.topology == "predecessor_and_leader";
    return plan;
}

int jitter_ticks(const V2vPlan& plan, std::uint64_t link, std::int64_t number) {
    if (plan.longest_jitter_ticks == 0) return 0;
    const double draw = delay_draw(link, number);
    const double jitter = plan.exponential ? -std::log1p(-draw) : draw;
    return std::min(static_cast<int>(std::ceil(jitter * plan.jitter_ticks)), plan.longest_jitter_ticks);
}

int first_send_tick(const V2vPlan& plan, int vehicle) {
    const std::uint64_t bits = mix64(plan.key ^ static_cast<std::uint64_t>(vehicle));
    return static_cast<int>(bits % static_cast<std::uint64_t>(plan.interval_ticks));
}

int next_send_tick(const V2vPlan& plan, int first, int tick) {
    const int late = ((tick - first) % plan.interval_ticks + plan.interval_ticks) % plan.interval_ticks;
    return late == 0 ? tick : tick + plan.interval_ticks - late;
}

double stable_time_gap_s(double age_s) {
    constexpr std::array kAge_s{0.02, 0.06, 0.10, 0.15, 0.20, 0.30, 0.44, 0.50};
    constexpr std::array kTimeGap_s{0.243, 0.422, 0.547, 0.672, 0.779, 0.961, 1.174, 1.256};
    if (age_s <= kAge_s.front()) return kTimeGap_s.front();
    for (std::size_t k = 1; k < kAge_s.size(); ++k) {
        if (age_s > kAge_s[k]) continue;
        const double share = (age_s - kAge_s[k - 1]) / (kAge_s[k] - kAge_s[k - 1]);
        return kTimeGap_s[k - 1] + share * (kTimeGap_s[k] - kTimeGap_s[k - 1]);
    }
    return kTimeGap_s.back();
}

}  // namespace stopline
