// Fields of V2V communication.
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "scenario/schema/field_rows.h"
#include "scenario/schema/fields.h"
#include "v2v/channel.h"
#include "v2v/plan.h"
#include "v2v/platoon_length.h"

namespace stopline {
namespace {

const Table& delivery_curve_table() {
    using S = DeliveryCurve;
    static const Table table = make_table<S>(
        "share of delivered messages over distance, for one density of vehicles",
        {
            number<&S::density_vpkm>("vehicles_per_km", "", {0, 10'000}, "density: vehicles per km of road").required(),
            curve<&S::distance_m, &S::delivered>("delivered", {"m", {0, 10'000}}, {"%", {0, 100}}, {1, 200},
                                                 "share of delivered messages over distance; linear between the "
                                                 "points, constant beyond them")
                .required(),
        });
    return table;
}

const Table& delivery_table() {
    using S = DeliverySettings;
    static const Table table = make_table<S>(
        "delivery of messages by a radio technology",
        {
            text<&S::name>("name", TextField::Rule::name, "name of the technology; default: the name of the file"),
            list<&S::curves>("curves", delivery_curve_table, {1, 100},
                             "curves for rising densities; linear between the densities")
                .required(),
        });
    return table;
}

const Table& fallback_table() {
    using S = FallbackSettings;
    static const Table table = make_table<S>(
        "driving without recent messages",
        {
            number<&S::radar_time_gap_s>("radar_time_gap", "s", {0.1, 10},
                                         "smallest time gap while radar replaces the messages (dCACC)"),
            number<&S::acc_time_gap_s>("acc_time_gap", "s", {0.1, 10},
                                       "smallest time gap of ACC: the newest message is older than 1 s, or the leader "
                                       "has no V2V"),
        });
    return table;
}

const Table& platoon_law_table() {
    using S = PlatoonLawSettings;
    // With larger values vehicles overlap if the channel loses messages in bursts.
    static const Table table =
        make_table<S>("following with the messages of the platoon leader (Rajamani 2000)",
                      {
                          number<&S::leader_weight>("leader_weight", "", {0, 0.5}, "weight of the platoon leader, C1"),
                          number<&S::damping>("damping", "", {1, 1.5}, "damping ratio, xi"),
                          number<&S::bandwidth_1ps>("bandwidth", "1/s", {0.01, 0.4}, "bandwidth, omega_n"),
                      });
    return table;
}

// Returns the names of the channels that read a field.
std::vector<std::string> channels_with(std::string_view field) {
    std::vector<std::string> names;
    for (const V2vChannel* channel : v2v_channels()) {
        const auto is_field = [&](const char* name) { return std::string_view(name) == field; };
        if (std::any_of(channel->fields.begin(), channel->fields.end(), is_field)) names.emplace_back(channel->name);
    }
    return names;
}

std::string channel_meaning() {
    std::string meaning = "the channel";
    for (const V2vChannel* channel : v2v_channels()) {
        meaning += std::string("; ") + channel->name + ": " + channel->meaning;
    }
    return meaning;
}

void check_v2v(const V2vSettings& settings, Checker& check) {
    const V2vChannel& channel = find_v2v_channel(settings.channel);
    const std::string problem = channel.problem == nullptr ? std::string() : channel.problem(settings);
    // If the file that `delivery` names has no curves or is missing, an error has been reported there before.
    const bool has_empty_delivery =
        channel.reads_density && check.given("delivery") && settings.delivery.curves.empty();
    if (!has_empty_delivery && !problem.empty()) check.error("channel", problem);
    if (settings.jitter_s == 0.0) return;
    const bool exponential = settings.jitter_form == "exponential";
    const double interval_s = message_interval_s(settings, 0.0);
    const double most_s = kJitterIntervals * interval_s / (exponential ? kLongestJitter : 1.0);
    constexpr double kRounding = 1e-9;
    if (settings.jitter_s <= most_s + kRounding) return;
    check.error("jitter", fmt::format("value {} must be at most {}, which is {:g} intervals between messages{}: use a "
                                      "longer interval",
                                      short_text(settings.jitter_s, unit("ms")), short_text(most_s, unit("ms")),
                                      kJitterIntervals / (exponential ? kLongestJitter : 1.0),
                                      interval_s == 0.0 ? "; this channel sends in every step" : ""));
}

}  // namespace

const Table& platoon_table() {
    using S = PlatoonSettings;
    static const Table table = make_table<S>(
        "length of platoons",
        {
            text<&S::max_vehicles>(
                "max_vehicles", TextField::Rule::name,
                "largest number of vehicles of a platoon: a number, none, or by_stability (computed "
                "from the delay of the messages). The next vehicle leads a platoon of its own, which "
                "keeps a time gap while it drives"),
            number<&S::time_gap_s>("time_gap", "s", {0.1, 10}, "time gap between such platoons"),
        },
        [](const S& s, Checker& check) {
            constexpr double kAnyTime_s = 0.1;
            if (max_platoon_vehicles(s, {}, kAnyTime_s, kAnyTime_s) >= 0) return;
            check.error("max_vehicles",
                        "value '" + s.max_vehicles + "' must be none, by_stability, or a whole number from 1 to 1000");
        });
    return table;
}

const Table& v2v_table() {
    using S = V2vSettings;
    static const Table table = make_table<S>(
        "V2V messages between automated vehicles; by default every message arrives after "
        "cacc.v2v_delay",
        {
            choice<&S::channel>("channel", v2v_channel_names(), channel_meaning()),
            number<&S::loss>("loss", "%", {0, 99}, "share of lost messages").only_if("channel", channels_with("loss")),
            number<&S::burst_messages>("burst", "", {1, 10'000}, "mean number of successive lost messages")
                .only_if("channel", channels_with("burst")),
            section<&S::delivery>("delivery", delivery_table, "delivery over distance and density", "v2v")
                .only_if("channel", channels_with("delivery")),
            number<&S::interval_s>("interval", "s", {0, 1},
                                   "time between the messages of a vehicle; 0 s: every step with the channel ideal, "
                                   "0.1 s with other channels"),
            choice<&S::jitter_form>("jitter_form", {"uniform", "exponential"},
                                    "distribution of the jitter; exponential: cut off at five times the mean"),
            number<&S::jitter_s>("jitter", "s", {0, 1},
                                 "random delay of a message in addition to cacc.v2v_delay; uniform: its largest value, "
                                 "exponential: its mean"),
            number<&S::range_m>("range", "m", {1, 10'000}, "messages do not reach further than this"),
            choice<&S::topology>("topology", {"predecessor", "predecessor_and_leader"},
                                 "vehicles whose messages a follower uses: its leader, or its leader and the first "
                                 "vehicle of its platoon"),
            section<&S::platoon_law>("platoon_law", platoon_law_table, "following with the platoon leader's messages")
                .only_if("topology", {"predecessor_and_leader"}),
            section<&S::fallback>("fallback", fallback_table, "driving without recent messages"),
        },
        check_v2v);
    return table;
}

const Table& speed_advice_table() {
    using S = SpeedAdviceSettings;
    static const Table table = make_table<S>(
        "speed advice of signals",
        {
            choice<&S::mode>("mode", {"off", "glosa"},
                             "glosa: the signal announces its next green, and the vehicle slows down early so that it "
                             "arrives at green without a stop (green light optimal speed advisory)"),
            number<&S::range_m>("range", "m", {10, 10'000},
                                "distance to the stop line within which the vehicle gets the messages of the signal")
                .only_if("mode", {"glosa"}),
            number<&S::min_speed_mps>("min_speed", "km/h", {5, 200}, "lowest advised speed").only_if("mode", {"glosa"}),
            number<&S::deceleration_mps2>("deceleration", "m/s2", {0.1, 5},
                                          "strongest braking towards the advised speed")
                .only_if("mode", {"glosa"}),
        });
    return table;
}

}  // namespace stopline
