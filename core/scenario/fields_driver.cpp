// Fields of the driver: controller, free driving, stopping; spacing policies and populations.
#include <cmath>
#include <string>
#include <vector>

#include "driver/gap_policy.h"
#include "scenario/field_rows.h"
#include "scenario/fields.h"

namespace stopline {
namespace {

const Table& cacc_table() {
    using S = CaccSettings;
    static const Table table = make_table<S>(
        "following: feedback on the gap, feedforward from the predecessor (Fig. 3 and 4)",
        {
            number<&S::feedback_kp_1ps2>("feedback_kp", "1/s2", {0, 10}, "acceleration per metre of gap error"),
            number<&S::feedback_kd_1ps>("feedback_kd", "1/s", {0, 10}, "acceleration per m/s of gap error's change"),
            number<&S::radar_delay_s>("radar_delay", "s", {0, 1}, "age of a gap the radar reports"),
            number<&S::radar_range_m>("radar_range", "m", {1, 1000}, "how far the radar sees"),
            number<&S::v2v_delay_s>("v2v_delay", "s", {0, 1}, "age of a received message"),
            number<&S::prediction_start_s>("prediction_start", "s", {0, 5},
                                           "CDG: from here after now the predicted acceleration shall be met"),
            number<&S::prediction_end_s>("prediction_end", "s", {0.01, 5}, "CDG: ... to here"),
            number<&S::acceleration_max_mps2>("acceleration_max", "m/s2", {0.1, 10}, "a follower's comfort limit"),
            number<&S::deceleration_comfort_mps2>("deceleration_comfort", "m/s2", {0.1, 10},
                                                  "hardest braking without an emergency"),
            number<&S::deceleration_emergency_mps2>("deceleration_emergency", "m/s2", {0.1, 12},
                                                    "hardest braking in an emergency"),
            number<&S::emergency_threshold_mps2>("emergency_threshold", "m/s2", {0.1, 12},
                                                 "an emergency: more deceleration than this is needed"),
            number<&S::emergency_gap_m>("emergency_gap", "m", {0, 10}, "gap that emergency braking keeps"),
            number<&S::jerk_up_mps3>("jerk_up", "m/s3", {0.1, 1000}, "fastest rise of the command"),
            number<&S::jerk_down_mps3>("jerk_down", "m/s3", {0.1, 1000}, "fastest fall of the command"),
            number<&S::catch_up_factor>("catch_up_factor", "", {1, 1.5},
                                        "speed over the limit at which a follower may close its gap"),
        },
        [](const S& s, Checker& check) {
            if (s.prediction_end_s <= s.prediction_start_s) {
                check.error("prediction_end", "must lie after prediction_start");
            }
            if (s.deceleration_emergency_mps2 < s.deceleration_comfort_mps2) {
                check.error("deceleration_emergency", "must be at least deceleration_comfort");
            }
        });
    return table;
}

const Table& free_drive_table() {
    using S = FreeDriveSettings;
    static const Table table = make_table<S>(
        "driving without a predecessor",
        {
            curve<&S::speed_mps, &S::acceleration_mps2>("acceleration", {"km/h", {0, 300}}, {"m/s2", {0.01, 10}},
                                                        {1, 200},
                                                        "acceleration asked for at a speed, from 0 km/h; constant "
                                                        "beyond the last point")
                .required(),
            number<&S::speed_gain_1ps>("speed_gain", "1/s", {0.01, 10}, "acceleration per m/s below the desired speed"),
            number<&S::deceleration_mps2>("deceleration", "m/s2", {0.1, 10}, "towards a lower limit ahead"),
            number<&S::hesitation_s>("hesitation", "s", {0, 10}, "leader: from green to the release of the brake"),
        },
        [](const S& s, Checker& check) {
            if (s.speed_mps.front() != 0.0) check.error("acceleration", "must begin at 0 km/h");
        });
    return table;
}

const Table& stop_table() {
    using S = StopSettings;
    static const Table table = make_table<S>(
        "stopping at a line",
        {
            number<&S::deceleration_mps2>("deceleration", "m/s2", {0.1, 10}, "braking begins when this is needed"),
            number<&S::decision_deceleration_mps2>("decision_deceleration", "m/s2", {0.1, 10},
                                                   "on yellow: stop if this suffices, else go on"),
            number<&S::margin_m>("margin", "m", {0, 20}, "from the standing front to the line"),
        });
    return table;
}

const Table& component_table() {
    using S = PopulationSettings::Component;
    static const Table table =
        make_table<S>("a part of the population",
                      {
                          text<&S::policy>("policy", TextField::Rule::name, "a spacing policy").required(),
                          number<&S::share>("share", "%", {0, 100}, "share of the vehicles").required(),
                      });
    return table;
}

void check_population(const PopulationSettings& population, Checker& check) {
    double sum = 0.0;
    for (const PopulationSettings::Component& component : population.components) sum += component.share;
    if (std::abs(sum - 1.0) > 1e-9) {
        check.error("components", "the shares sum to " + short_text(sum, unit("%")) + ", not to 100 %");
    }
}

const Table& lane_change_table() {
    using S = LaneChangeSettings;
    static const Table table = make_table<S>(
        "changing lanes, on approaches of networks of the kind 'streets'",
        {
            number<&S::strategic_m>("strategic_distance", "m", {10, 10'000},
                                    "from this far before the stop line on, for each change that it takes, a lane "
                                    "from which the route goes on is looked for"),
            number<&S::urgent_m>("urgent_distance", "m", {10, 1000},
                                 "from here on the speed is adapted to the gaps in the lane beside"),
            number<&S::gap_share>("gap_share", "%", {0, 200},
                                  "of the gap that the policy keeps at the own speed, enough ahead and behind"),
            number<&S::urgent_gap_share>("urgent_gap_share", "%", {0, 200},
                                         "the same at the stop line, for who must change"),
            choice<&S::look_ahead>("look_ahead", {"off", "on"},
                                   "whether vehicles know how they will turn at the next intersection but one"),
            choice<&S::help>("help", {"off", "on"}, "whether others make room for those that must change"),
            number<&S::threshold_mps2>("threshold", "m/s2", {0, 10}, "acceleration that a change for speed must gain"),
            number<&S::politeness>("politeness", "", {0, 1}, "weight of what others gain and lose by it"),
            number<&S::keep_right_mps2>("keep_right", "m/s2", {0, 5}, "advantage of the lane to the right"),
            number<&S::acceleration_mps2>("acceleration", "m/s2", {0.1, 10}, "of the intelligent driver model"),
            number<&S::deceleration_mps2>("deceleration", "m/s2", {0.1, 10}, "the same, comfortable braking"),
            number<&S::pause_s>("pause", "s", {0, 1000}, "after a change, before another one for speed"),
        });
    return table;
}

const Table& give_way_table() {
    using S = GiveWaySettings;
    static const Table table = make_table<S>(
        "giving way inside intersections",
        {
            number<&S::critical_gap_s>("critical_gap", "s", {0, 60},
                                       "shortest time to the next vehicle with priority that is accepted"),
            number<&S::margin_m>("margin", "m", {0, 10}, "from the front to the conflict area when waiting"),
            number<&S::approach_mps2>("approach", "m/s2", {0.1, 10},
                                      "acceleration that vehicles with priority are expected to have"),
        });
    return table;
}

SourceNode scalar_like(const SourceNode& at, std::string text) {
    SourceNode node = at;
    node.text = std::move(text);
    return node;
}

// `CDG` stands for {name: CDG, components: [{policy: CDG, share: 100 %}]}.
SourceNode population_of_one_policy(const SourceNode& policy) {
    SourceNode component;
    component.kind = SourceNode::Kind::map;
    component.place = policy.place;
    component.add({"policy", policy.place}, policy);
    component.add({"share", policy.place}, scalar_like(policy, "100 %"));
    SourceNode components;
    components.kind = SourceNode::Kind::list;
    components.place = policy.place;
    components.items.push_back(std::move(component));
    SourceNode population;
    population.kind = SourceNode::Kind::map;
    population.place = policy.place;
    population.add({"name", policy.place}, policy);
    population.add({"components", policy.place}, std::move(components));
    return population;
}

}  // namespace

const Table& driver_table() {
    using S = DriverSettings;
    static const Table table = make_table<S>(
        "how vehicles are driven",
        {
            text<&S::name>("name", TextField::Rule::name, "name of the driver; if not given, that of the file"),
            section<&S::cacc>("cacc", cacc_table, "following"),
            section<&S::free_drive>("free_drive", free_drive_table, "free driving").required(),
            section<&S::stop>("stop", stop_table, "stopping at a line"),
            section<&S::give_way>("give_way", give_way_table, "giving way inside intersections"),
            section<&S::lane_change>("lane_change", lane_change_table, "changing lanes"),
        });
    return table;
}

const Table& rules_table() {
    using S = HindranceRules;
    static const Table table = make_table<S>(
        "rules that keep traffic going where queues reach back into intersections",
        {
            choice<&S::keep_clear>(
                "keep_clear", {"off", "on"},
                "nobody passes the stop line unless there is room behind the last vehicle that stands "
                "in the exit"),
            number<&S::sight_m>("sight", "m", {1, 10'000}, "how far into the exit drivers look for that")
                .of_rule("keep_clear"),
            choice<&S::light_ahead>("light_ahead", {"off", "on"},
                                    "those who move in the exit count as if they stood up to the light at "
                                    "its end while that is not green")
                .of_rule("keep_clear"),
            number<&S::teleport_cycles>(
                "teleport_cycles", "", {0, 1000},
                "the first vehicle of a lane that has stood for this many cycles is moved on past "
                "the intersection; 0: never"),
            number<&S::pass_blocker_greens>(
                "pass_blocker_greens", "", {0, 1000},
                "who has stood inside an intersection for this many greens no longer holds up "
                "those that cross; 0: never"),
        });
    return table;
}

const Table& gap_policy_table() {
    using S = GapPolicySettings;
    static const Table table = make_table<S>(
        "a spacing policy: the gap kept at a speed",
        {
            text<&S::name>("name", TextField::Rule::name, "name of the policy").required(),
            choice<&S::law>("law", gap_law_names(), "how the gap depends on the speed").required(),
            number<&S::standstill_gap_m>("standstill_gap", "m", {0.1, 100}, "net gap at standstill").required(),
            number<&S::time_gap_s>("time_gap", "s", {0, 20}, "growth of the gap with the speed")
                .required()
                .only("law", {"constant_time", "switch_time_gap"}),
            number<&S::switch_speed_mps>("switch_speed", "km/h", {0, 300}, "below it the gap is the standstill gap")
                .required()
                .only("law", {"switch_time_gap", "switch_distance"}),
            number<&S::reference_speed_mps>("reference_speed", "km/h", {1, 300}, "speed at which ...")
                .required()
                .only("law", {"switch_distance"}),
            number<&S::reference_gap_m>("reference_gap", "m", {0.1, 1000}, "... this gap is reached")
                .required()
                .only("law", {"switch_distance"}),
        },
        [](const S& s, Checker& check) {
            if (s.law != "switch_distance") return;
            if (s.reference_speed_mps <= s.switch_speed_mps) {
                check.error("reference_speed", "must be greater than switch_speed");
            }
            if (s.reference_gap_m < s.standstill_gap_m) {
                check.error("reference_gap", "must be at least standstill_gap");
            }
        });
    return table;
}

const Table& policy_file_table() {
    static const Table table = make_table<PolicyFile>(
        "named spacing policies",
        {list<&PolicyFile::policies>("policies", gap_policy_table, {1, 1000}, "spacing policies").required()});
    return table;
}

const Table& population_table() {
    using S = PopulationSettings;
    static const Table table = make_table<S>(
        "vehicles and the policies they follow; a policy's name alone: all vehicles follow it",
        {
            text<&S::name>("name", TextField::Rule::name, "name of the population").required(),
            enumeration<&S::pattern>("pattern", {"alternating", "random", "balanced"},
                                     "order of the policies in the queue"),
            list<&S::components>("components", component_table, {1, 100}, "policies and shares").required(),
        },
        check_population, population_of_one_policy);
    return table;
}

}  // namespace stopline
