// Tests of loading scenarios: values, defaults, overrides, data files and messages.
#include "scenario/load_scenario.h"

#include <gtest/gtest.h>
#include <stdlib.h>  // setenv is POSIX

#include <algorithm>

#include "base/io/data_directory.h"
#include "scenario/scenario_text.h"
#include "spacing_laws/gap_policy.h"

namespace stopline {
namespace {

// The smallest file: one field.
constexpr const char* kSmall = "title: small\n";

TEST(LoadScenario, SingleLightIsTheExperimentOfSectionThree) {
    const Scenario s = load_scenario(shipped("scenarios/single_light.yaml"));
    EXPECT_EQ(s.name, "single_light");
    EXPECT_EQ(s.fidelity, "full");
    EXPECT_EQ(s.step_s, 0.01);
    EXPECT_EQ(s.network.kind, "approach");
    EXPECT_EQ(s.network.approach.lanes, 1);
    EXPECT_EQ(s.network.approach.speed_limit_mps, 50.0 / 3.6);
    EXPECT_EQ(s.signal.yellow_s, 3.0);
    EXPECT_GE(s.signal.green_s, 30.0);
    EXPECT_EQ(s.demand.vehicles, 60);
    EXPECT_EQ(s.vehicle_name, "petrol_eu4_72kw");
    EXPECT_EQ(s.driver_name, "startup_kit");
    EXPECT_EQ(s.vehicle.length_m, 5.15);
    EXPECT_EQ(s.measure.green_s, (std::vector<double>{5, 10, 15, 20, 25, 30}));
    EXPECT_EQ(s.measure.baseline, "CTG-Ref");
    ASSERT_EQ(s.populations.size(), 8u);
    const PopulationSettings& mix = s.populations[4];
    EXPECT_EQ(mix.name, "MIX");
    EXPECT_EQ(mix.pattern, PopulationSettings::Pattern::alternating);
    ASSERT_EQ(mix.components.size(), 2u);
    EXPECT_EQ(mix.components[0].policy, "CDG");
    EXPECT_EQ(mix.components[1].policy, "CTG-Ref");
    EXPECT_EQ(mix.components[1].share, 0.5);
}

TEST(LoadScenario, EveryShippedScenarioLoads) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(shipped("scenarios"))) {
        if (entry.path().extension() != ".yaml") continue;
        EXPECT_EQ(input_error_of([&] { load_scenario(entry.path()); }), "");
        ++files;
    }
    EXPECT_GE(files, 2);
}

TEST(LoadScenario, FilesOfOtherKindsAreRefusedAsAWhole) {
    EXPECT_EQ(error_of("scenario: a.yaml\naxes: []\n"),
              "test.yaml:1:1: is a sweep, not a scenario (it has the field 'axes'); run it with stopline-sweep");
    EXPECT_TRUE(contains(error_of("intersections: []\n"), "is a streets file, not a scenario"));
    const std::string stray_field = error_of("network: {kind: grid}\nintersections: []\n");
    EXPECT_TRUE(contains(stray_field, "test.yaml:2:1: field 'intersections' is unknown")) << stray_field;
    for (const char* const file : {"scenarios/sweeps/intersection.yaml", "data/berlin/three_lanes.yaml"}) {
        const std::string message = input_error_of([&] { load_scenario(shipped(file)); });
        EXPECT_TRUE(contains(message, "not a scenario"));
        EXPECT_EQ(lines_of(message), 1U);
    }
}

TEST(LoadScenario, MissingFieldsHaveTheDefaultsOfTheStructs) {
    const Scenario s = parse_scenario(kSmall, "dir/my file.yaml");
    const Scenario defaults;
    EXPECT_EQ(s.name, "my_file");
    EXPECT_EQ(s.title, "small");
    EXPECT_EQ(s.duration_s, defaults.duration_s);
    EXPECT_EQ(s.signal.first_green_s, SignalSettings{}.first_green_s);
    EXPECT_EQ(s.network.approach.length_m, ApproachSettings{}.length_m);
    EXPECT_EQ(s.vehicle.name, "petrol_eu4_72kw");
    EXPECT_EQ(s.driver.name, "startup_kit");
    EXPECT_TRUE(s.measure.green_s.empty());
    std::vector<std::string> names;
    for (const PopulationSettings& population : s.populations) names.push_back(population.name);
    EXPECT_EQ(names, (std::vector<std::string>{"CDG", "CDG-6m", "SWITCH-1", "SWITCH-2", "MIX", "CTG-Ref", "CTG-HCM",
                                               "CTG-HBS"}));
}

// All values differ, so that the test fails if the row of a field table is bound to the wrong member.
TEST(LoadScenario, EachFieldFillsItsOwnMember) {
    const Scenario s = parse_scenario(R"(
name: n
title: t
step: 20 ms
duration: 300 s
seed: 18446744073709551615
network: {approach: {lanes: 3, length: 900 m, exit_length: 400 m, speed_limit: 60 km/h, gradient: 2 %}}
signal: {first_green: 100 s, green: 20 s, yellow: 4 s, all_red: 6 s, cycle: 50 s}
demand: {vehicles: 50, entry_speed: 36 km/h}
driver:
  base: startup_kit
  cacc: {feedback_kp: 0.3 1/s2, feedback_kd: 0.8 1/s, radar_delay: 0.11 s, radar_range: 120 m, v2v_delay: 0.03 s,
    prediction_start: 0.2 s, prediction_end: 0.6 s, acceleration_max: 2.1 m/s2, deceleration_comfort: 3.1 m/s2,
    deceleration_emergency: 7.5 m/s2, emergency_threshold: 2.9 m/s2, emergency_gap: 0.7 m, jerk_up: 5 m/s3,
    jerk_down: 20 m/s3, catch_up_factor: 1.1}
  free_drive: {acceleration: {0 km/h: 2 m/s2, 36 km/h: 1 m/s2}, speed_gain: 0.4 1/s, deceleration: 1.2 m/s2,
    hesitation: 0.5 s, profile_limit: 72 km/h, power_share: 65 %}
  stop: {deceleration: 2.2 m/s2, decision_deceleration: 3.3 m/s2, margin: 1.5 m}
policies:
- {name: P, law: switch_distance, standstill_gap: 3 m, switch_speed: 18 km/h, reference_speed: 54 km/h, reference_gap: 9 m}
- {name: Q, law: switch_time_gap, standstill_gap: 4 m, switch_speed: 36 km/h, time_gap: 0.7 s}
populations: [P, {name: R, pattern: random, components: [{policy: P, share: 25 %}, {policy: Q, share: 75 %}]}]
measure: {green: [5 s, 20 s], baseline: R}
)",
                                      "t.yaml");
    EXPECT_EQ(s.name, "n");
    EXPECT_EQ(s.step_s, 0.02);
    EXPECT_EQ(s.duration_s, 300.0);
    EXPECT_EQ(s.seed, 18446744073709551615u);
    EXPECT_EQ(s.network.approach.lanes, 3);
    EXPECT_EQ(s.network.approach.length_m, 900.0);
    EXPECT_EQ(s.network.approach.exit_length_m, 400.0);
    EXPECT_EQ(s.network.approach.speed_limit_mps, 60.0 / 3.6);
    EXPECT_EQ(s.network.approach.gradient, 0.02);
    EXPECT_EQ(s.signal.first_green_s, 100.0);
    EXPECT_EQ(s.signal.green_s, 20.0);
    EXPECT_EQ(s.signal.yellow_s, 4.0);
    EXPECT_EQ(s.signal.all_red_s, 6.0);
    EXPECT_EQ(s.signal.cycle_s, 50.0);
    EXPECT_EQ(s.demand.vehicles, 50);
    EXPECT_EQ(s.demand.entry_speed_mps, 10.0);
    const CaccSettings& c = s.driver.cacc;
    EXPECT_EQ(c.feedback_kp_1ps2, 0.3);
    EXPECT_EQ(c.feedback_kd_1ps, 0.8);
    EXPECT_EQ(c.radar_delay_s, 0.11);
    EXPECT_EQ(c.radar_range_m, 120.0);
    EXPECT_EQ(c.v2v_delay_s, 0.03);
    EXPECT_EQ(c.prediction_start_s, 0.2);
    EXPECT_EQ(c.prediction_end_s, 0.6);
    EXPECT_EQ(c.acceleration_max_mps2, 2.1);
    EXPECT_EQ(c.deceleration_comfort_mps2, 3.1);
    EXPECT_EQ(c.deceleration_emergency_mps2, 7.5);
    EXPECT_EQ(c.emergency_threshold_mps2, 2.9);
    EXPECT_EQ(c.emergency_gap_m, 0.7);
    EXPECT_EQ(c.jerk_up_mps3, 5.0);
    EXPECT_EQ(c.jerk_down_mps3, 20.0);
    EXPECT_EQ(c.catch_up_factor, 1.1);
    EXPECT_EQ(s.driver.free_drive.speed_mps, (std::vector<double>{0.0, 10.0}));
    EXPECT_EQ(s.driver.free_drive.acceleration_mps2, (std::vector<double>{2.0, 1.0}));
    EXPECT_EQ(s.driver.free_drive.speed_gain_1ps, 0.4);
    EXPECT_EQ(s.driver.free_drive.deceleration_mps2, 1.2);
    EXPECT_EQ(s.driver.free_drive.hesitation_s, 0.5);
    EXPECT_EQ(s.driver.free_drive.profile_limit_mps, 20.0);
    EXPECT_EQ(s.driver.free_drive.power_share, 0.65);
    EXPECT_EQ(s.driver.stop.deceleration_mps2, 2.2);
    EXPECT_EQ(s.driver.stop.decision_deceleration_mps2, 3.3);
    EXPECT_EQ(s.driver.stop.margin_m, 1.5);
    const auto policy = [&](const std::string& name) {
        return *std::find_if(s.policies.begin(), s.policies.end(), [&](const auto& p) { return p.name == name; });
    };
    EXPECT_EQ(policy("P").law, "switch_distance");
    EXPECT_EQ(policy("P").standstill_gap_m, 3.0);
    EXPECT_EQ(law_parameter(policy("P"), "switch_speed"), 5.0);
    EXPECT_EQ(law_parameter(policy("P"), "reference_speed"), 15.0);
    EXPECT_EQ(law_parameter(policy("P"), "reference_gap"), 9.0);
    EXPECT_EQ(law_parameter(policy("Q"), "time_gap"), 0.7);
    EXPECT_EQ(law_parameter(policy("Q"), "switch_speed"), 10.0);
    EXPECT_EQ(policy("CDG").standstill_gap_m, 2.95);  // the policies of the paper remain
    ASSERT_EQ(s.populations.size(), 2u);
    EXPECT_EQ(s.populations[0].components.at(0).share, 1.0);
    EXPECT_EQ(s.populations[1].pattern, PopulationSettings::Pattern::random);
    EXPECT_EQ(s.populations[1].components.at(1).policy, "Q");
    EXPECT_EQ(s.populations[1].components.at(0).share, 0.25);
    EXPECT_EQ(s.measure.green_s, (std::vector<double>{5.0, 20.0}));
    EXPECT_EQ(s.measure.baseline, "R");
}

TEST(LoadScenario, ErrorsNamePlaceFieldValueAndRemedy) {
    EXPECT_EQ(
        error_of("signal:\n  green: 15\n"),
        "test.yaml:2:10: field 'signal.green': value '15' has no unit: write e.g. '15 s' (allowed: 0.1 s to 7200 s)");
    EXPECT_EQ(error_of("demand:\n  left: 5\n"),
              "test.yaml:2:9: field 'demand.left': value '5' has no unit: write e.g. '5 %' (allowed: 0 % to 100 %)");
    EXPECT_TRUE(contains(error_of("demand:\n  left: 500 %\n"), "value '500 %' is out of range"));
    EXPECT_TRUE(contains(error_of("demand:\n  left: -1 %\n"), "value '-1 %' is out of range"));
    EXPECT_TRUE(contains(error_of("demand:\n  left: 1\n"), "value '1' has no unit: write '1 %' or '100 %', whichever"));
    EXPECT_EQ(error_of("signal:\n  green: -15 s\n"),
              "test.yaml:2:10: field 'signal.green': value '-15 s' is out of range (allowed: 0.1 s to 7200 s)");
    EXPECT_EQ(
        error_of("signal:\n  gren: 15 s\n"),
        "test.yaml:2:3: field 'signal.gren' is unknown; did you mean 'green'? Known: controller, first_green, green, cross_green, "
        "yellow, all_red, offset, cycle, phases, programmes, clock, stop_detector, advance_detector, "
        "platoon_range");
    EXPECT_EQ(error_of("fidelity: ful\n"),
              "test.yaml:1:11: field 'fidelity': value 'ful' is unknown; did you mean 'full'? "
              "Known: full, meso");
    EXPECT_TRUE(contains(error_of("vehicle: petrol_eu4_72kW2\n"),
                         "did you mean 'petrol_eu4_72kw'? Known: articulated_lorry_35t, "));
    EXPECT_TRUE(contains(error_of("populations: [CGD]\n"),
                         "test.yaml:1:15: field 'populations[CGD].components[0].policy': "
                         "there is no policy 'CGD'; did you mean 'CDG'?"));
}

TEST(LoadScenario, SuggestsTheWholePathOfAField) {
    const auto error_for = [](const std::string& text) { return error_of(kSmall, {text}); };
    for (const char* written : {"hesitation=1 s", "driver.hesitation=1 s", "signal.hesitation=1 s"}) {
        EXPECT_TRUE(contains(error_for(written), "is unknown; did you mean 'driver.free_drive.hesitation'? Known: "));
    }
    EXPECT_TRUE(
        contains(error_for("time_gap=1 s"),
                 "'time_gap' is unknown; did you mean 'driver.platoon.time_gap' or 'policies[NAME].time_gap'?"));
    EXPECT_TRUE(contains(error_for("policies.CTG-Ref.time_gap=1 s"),
                         "field 'policies' is a list: name its entry in brackets, as in 'policies[CTG-Ref].time_gap'"));
    EXPECT_TRUE(contains(error_for("policies.time_gap=1 s"), "as in 'policies[NAME].time_gap'"));
    EXPECT_TRUE(contains(error_of("hesitation: 1 s\n"), "did you mean 'driver.free_drive.hesitation'?"));
    EXPECT_TRUE(contains(error_of("driver: {base: startup_kit, hesitation: 1 s}\n"),
                         "field 'driver.hesitation' is unknown; did you mean 'driver.free_drive.hesitation'?"));
    EXPECT_TRUE(contains(error_of("green: 5 s\n"),
                         "did you mean 'signal.green' or 'measure.green' or 'signal.phases[0].green'?"));
}

TEST(LoadScenario, NamesTheBaseIfASectionIsIncomplete) {
    const std::string error = error_of("vehicle: {mass: 1700 kg}\n");
    EXPECT_EQ(lines_of(error), 1u);
    EXPECT_TRUE(contains(error,
                         "test.yaml:1:10: field 'vehicle': 22 fields are missing: add 'base: NAME' to take them "
                         "from a file of data/vehicles, or give all of them (length, "));
    EXPECT_EQ(error_of("vehicle: {base: petrol_eu4_72kw, mass: 1700 kg}\n"), "");
}

TEST(LoadScenario, ReadsMovementsInAnyOrder) {
    const auto hash = [](const std::string& movements) {
        return parse_scenario(
                   "network: {kind: intersection, intersection: {lanes: [{movements: " + movements + "}]}}\n", "x.yaml")
            .hash;
    };
    EXPECT_EQ(hash("left+straight"), hash("straight+left"));
    for (const char* written : {"left+straight+right", "right+left+straight", "left+right+straight"}) {
        EXPECT_EQ(hash(written), hash("straight+left+right")) << written;
    }
    const auto error = [](const std::string& movements) {
        return error_of("network: {kind: intersection, intersection: {lanes: [{movements: " + movements + "}]}}\n");
    };
    EXPECT_TRUE(contains(error("left+left"), "value 'left+left' is unknown"));
    EXPECT_TRUE(contains(error("left+"), "value 'left+' is unknown"));
    EXPECT_TRUE(contains(error("left+straigth"), "value 'left+straigth' is unknown"));
}

TEST(LoadScenario, ReportsAllErrorsInTheOrderOfTheFile) {
    const std::string message =
        error_of("stepp: 1 s\nsignal: {green: 15, yellow: red}\nvehicle: none\nduration: nan\n");
    EXPECT_EQ(lines_of(message), 5u) << message;
    std::size_t last = 0;
    for (const char* part :
         {"test.yaml:1:1: ", "test.yaml:2:17: ", "test.yaml:2:29: ", "test.yaml:3:10: ", "test.yaml:4:11: "}) {
        const std::size_t at = message.find(part);
        ASSERT_NE(at, std::string::npos) << part << " in\n" << message;
        EXPECT_GE(at, last);
        last = at;
    }
    std::string many;
    for (int i = 0; i < 50; ++i) many += "field_" + std::to_string(i) + ": 1\n";
    EXPECT_EQ(lines_of(error_of(many)), 21u);
    EXPECT_TRUE(contains(error_of(many), "... and 30 more errors"));
}

TEST(LoadScenario, RefusesFilesWithoutFields) {
    for (const char* text : {"", "\n\n", "# comment\n", "---\n", "~\n", "hello\n", "[1, 2]\n", "- a: 1\n", "42\n"}) {
        EXPECT_TRUE(contains(error_of(text), "needs 'field: value' lines")) << text;
    }
    EXPECT_NE(input_error_of([] { load_scenario("/nonexistent/x.yaml"); }), "");
    EXPECT_TRUE(contains(
        input_error_of([] { load_scenario(shipped("scenarios/gird.yaml")); }),
        "scenarios/gird.yaml: no such file; did you mean '" + shipped("scenarios/grid.yaml").generic_string() + "'?"));
    EXPECT_NE(input_error_of([] { load_scenario(""); }), "");
}

TEST(Overrides, AreAppliedFromLeftToRight) {
    const Scenario s = parse_scenario(
        kSmall, "x", {"measure.green=[5 s, 10 s]", "measure.green[1]=7 s", "title=x = y", "title=x = y"});
    EXPECT_EQ(s.title, "x = y");  // only the first = separates path and value
    EXPECT_EQ(s.measure.green_s, (std::vector<double>{5.0, 7.0}));
}

TEST(Overrides, GiveAWarningIfALaterOneReplacesThem) {
    const auto warnings_for = [](const std::vector<std::string>& overrides) {
        return parse_scenario(kSmall, "x", overrides).warnings;
    };
    const Scenario s = parse_scenario(kSmall, "x", {"signal.green=20 s", "signal.green=25 s"});
    EXPECT_EQ(s.signal.green_s, 25.0);
    EXPECT_EQ(s.warnings, (std::vector<std::string>{"--set 'signal.green=20 s': has no effect, because the later --set "
                                                    "'signal.green=25 s' replaces it"}));
    for (const auto& [earlier, later] : std::vector<std::pair<std::string, std::string>>{
             {"vehicle.mass=1.4 t", "vehicle=diesel_eu4_103kw"},
             {"vehicle=petrol_eu4_72kw", "vehicle=diesel_eu4_103kw"},
             {"policies[CTG-Ref].time_gap=0.6 s", "policies[2].time_gap=0.7 s"},
             {"populations[0].pattern=random", "populations=[CDG]"}}) {
        const std::vector<std::string> warnings = warnings_for({earlier, later});
        ASSERT_EQ(warnings.size(), 1U) << earlier;
        EXPECT_TRUE(contains(warnings[0], "--set '" + earlier + "': has no effect")) << earlier;
    }
    // A part of a section or list that is set later is no replacement.
    EXPECT_TRUE(warnings_for({"vehicle=diesel_eu4_103kw", "vehicle.mass=1.4 t", "measure.green=[5 s, 6 s]",
                              "measure.green[1]=7 s"})
                    .empty());
}

TEST(Overrides, NamesSelectPopulationsOfTheFile) {
    const std::string file =
        "populations:\n"
        "- {name: MIX, components: [{policy: CDG, share: 30 %}, {policy: CTG-Ref, share: 70 %}]}\n"
        "- CTG-Ref\n";
    const Scenario s = parse_scenario(file, "x", {"populations=[SWITCH-1, MIX]", "measure.baseline=MIX"});
    ASSERT_EQ(s.populations.size(), 2U);
    EXPECT_EQ(s.populations[0].components.at(0).policy, "SWITCH-1");
    ASSERT_EQ(s.populations[1].components.size(), 2U);
    EXPECT_EQ(s.populations[1].components[0].share, 0.3);
    const Scenario by_default = parse_scenario(kSmall, "x", {"populations=[MIX]", "measure.baseline=MIX"});
    EXPECT_EQ(by_default.populations.at(0).components.size(), 2U) << "MIX of the default list";
    // An earlier override of the population has no effect.
    const Scenario replaced =
        parse_scenario(file, "x", {"populations[MIX].pattern=random", "populations=[MIX]", "measure.baseline=MIX"});
    EXPECT_EQ(replaced.populations.at(0).pattern, s.populations[1].pattern);
}

TEST(Overrides, ReachAllFieldsAndEntries) {
    const Scenario s =
        parse_scenario(kSmall, "x",
                       {"vehicle=diesel_eu4_103kw", "vehicle.mass=1.4 t", "policies[CTG-Ref].time_gap=0.6 s",
                        "policies[0].standstill_gap=3 m", "populations[MIX].components[1].share=75 %",
                        "populations[4].components[0].share=25 %", "populations[CTG-Ref].pattern=random",
                        "measure.green=[5 s, 10 s, 15 s]", "measure.green[1]=7 s", "driver.cacc.v2v_delay=100 ms",
                        "vehicle.full_load={0 rpm: 100 N m, 9000 rpm: 50 N m}", "network.approach.lanes=2"});
    EXPECT_EQ(s.vehicle.name, "diesel_eu4_103kw");
    EXPECT_EQ(s.vehicle.mass_kg, 1400.0);
    EXPECT_EQ(s.vehicle.load_kg, 292.0);
    EXPECT_EQ(s.vehicle.full_load.y, (std::vector<double>{100.0, 50.0}));
    EXPECT_EQ(s.policies[0].standstill_gap_m, 3.0);
    EXPECT_EQ(law_parameter(s.policies[2], "time_gap"), 0.6);
    EXPECT_EQ(s.policies.size(), load_policies().size());
    EXPECT_EQ(s.populations[4].components[1].share, 0.75);
    EXPECT_EQ(s.populations[5].pattern, PopulationSettings::Pattern::random);
    EXPECT_EQ(s.measure.green_s, (std::vector<double>{5.0, 7.0, 15.0}));
    EXPECT_EQ(s.driver.cacc.v2v_delay_s, 0.1);
    EXPECT_EQ(s.network.approach.lanes, 2);
}

TEST(Overrides, ReachEntriesWithADotInTheirName) {
    const Scenario s = parse_scenario("populations: [{name: a.b, components: [{policy: CDG, share: 100 %}]}]\n", "x",
                                      {"populations[a.b].pattern=random"});
    EXPECT_EQ(s.populations[0].pattern, PopulationSettings::Pattern::random);
}

TEST(Overrides, ErrorsNameTheOverride) {
    const auto error_for = [](const std::string& text) { return error_of(kSmall, {text}); };
    EXPECT_EQ(error_for("signal.green=20"),
              "--set 'signal.green=20': field 'signal.green': value '20' has no unit: write e.g. '20 s' "
              "(allowed: 0.1 s to 7200 s)");
    EXPECT_TRUE(contains(error_for("signal.gren=20 s"),
                         "--set 'signal.gren=20 s': field 'signal.gren' is unknown; did you mean 'green'?"));
    EXPECT_TRUE(contains(error_for("sgnal.green=20 s"), "did you mean 'signal'?"));
    EXPECT_TRUE(contains(error_for("signal.green.x=1 s"), "has no field 'x' inside"));
    EXPECT_TRUE(contains(error_for("populations[99].name=x"), "has no entry [99]"));
    EXPECT_TRUE(contains(error_for("populations[].name=x"), "has no entry []"));
    EXPECT_TRUE(contains(error_for("policies[XYZ].time_gap=1 s"), "has no entry [XYZ]; it has the entries 0 to "));
    EXPECT_TRUE(contains(error_for("policies[CTG-Reff].time_gap=1 s"),
                         "field 'policies' has no entry [CTG-Reff]; did you mean 'CTG-Ref'? It has the entries 0 to "));
    EXPECT_TRUE(contains(error_for("measure.green[0]=1 s"), "has no entry [0]"));
    EXPECT_TRUE(contains(error_for("populations[0][1].name=x"), "has no entry"));
    EXPECT_TRUE(
        contains(error_for("policies[CDG].time_gap=1 s"), "applies only if law is constant_time or switch_time_gap"));
    EXPECT_TRUE(contains(error_for("vehicle=nothing"), "there is no 'nothing' in"));
    EXPECT_TRUE(contains(error_for("signal.green="), "needs a single value, not nothing"));
    EXPECT_TRUE(contains(error_for("signal=["), "--set 'signal=[': not valid YAML"));
    EXPECT_TRUE(contains(error_for("signal=&a [*a]"), "inside its own anchor"));
    for (const char* text : {"", "=", "=5 s", "signal.green", "signal"}) {
        EXPECT_TRUE(contains(error_for(text), "needs the form path=value")) << text;
    }
    for (const char* text : {".=1", "..=1", "[=1", "]=1", "a[=1", "signal.=1", ".signal=1", "signal[0].green=1 s",
                             "measure.green[0].x=1 s", "vehicle[0]=1"}) {
        EXPECT_NE(error_for(text), "") << text;
    }
}

TEST(Overrides, ErrorsOfAWholeSectionNameTheOverride) {
    const std::string sumo = "network: {kind: sumo, net: a.net.xml, routes: a.rou.xml}\n";
    EXPECT_TRUE(contains(error_of(sumo, {"signal.green=20 s"}),
                         "--set 'signal.green=20 s': field 'signal' applies only if network.kind is "));
    EXPECT_TRUE(contains(error_of(sumo + "signal: {green: 20 s}\n", {"signal.yellow=3 s"}),
                         "test.yaml:2:9: field 'signal' applies only if network.kind is "));
}

TEST(DataFiles, AreFoundByNameOrPath) {
    const TemporaryFolder folder;
    folder.write("cars/mine.yaml", "base: ../other.yaml\nload: 75 kg\n");
    folder.write("other.yaml", "base: petrol_eu4_72kw\nmass: 1300 kg\nload: 60 kg\n");
    folder.write("run.yaml", "vehicle: cars/mine.yaml\n");
    const Scenario s = load_scenario(folder.path() / "run.yaml");
    EXPECT_EQ(s.vehicle_name, "mine");
    EXPECT_EQ(s.vehicle.mass_kg, 1300.0);
    EXPECT_EQ(s.vehicle.load_kg, 75.0);
    EXPECT_EQ(s.vehicle.wheel_diameter_m, 0.606);
    EXPECT_EQ(load_vehicle("cars/mine.yaml", folder.path()).load_kg, 75.0);
    EXPECT_EQ(load_vehicle((folder.path() / "other.yaml").string()).load_kg, 60.0);
}

TEST(DataFiles, InheritMissingFieldsFromBaseFiles) {
    const TemporaryFolder folder;
    folder.write("d0.yaml", "base: startup_kit\ncacc: {radar_range: 99 m, jerk_up: 4 m/s3}\nstop: {margin: 2 m}\n");
    for (int i = 1; i < 7; ++i) {
        const std::string below = "base: ./d" + std::to_string(i - 1) + ".yaml\n";
        folder.write("d" + std::to_string(i) + ".yaml",
                     below + "cacc: {v2v_delay: " + std::to_string(20 + i) + " ms}\n");
    }
    folder.write("run.yaml", "driver: {base: ./d6.yaml, cacc: {jerk_up: 5 m/s3}}\n");
    const DriverSettings driver = load_scenario(folder.path() / "run.yaml").driver;
    EXPECT_EQ(driver.name, "d6");
    EXPECT_EQ(driver.cacc.radar_range_m, 99.0);
    EXPECT_EQ(driver.cacc.v2v_delay_s, 0.026);
    EXPECT_EQ(driver.cacc.jerk_up_mps3, 5.0);
    EXPECT_EQ(driver.stop.margin_m, 2.0);
}

TEST(DataFiles, ErrorsNameTheDataFile) {
    const TemporaryFolder folder;
    folder.write("bad.yaml", "base: petrol_eu4_72kw\nmass: 1300\n");
    folder.write("loop.yaml", "base: ./loop.yaml\n");
    folder.write("run.yaml", "vehicle: ./bad.yaml\n");
    folder.write("looping.yaml", "vehicle: ./loop.yaml\n");
    folder.write("missing.yaml", "vehicle: ./none.yaml\n");
    const auto error_for = [&](const char* name) {
        return input_error_of([&] { load_scenario(folder.path() / name); });
    };
    EXPECT_TRUE(contains(error_for("run.yaml"), "bad.yaml:2:7: field 'vehicle.mass': value '1300' has no unit"));
    EXPECT_TRUE(contains(error_for("looping.yaml"), "the chain of base files is longer than 8 files"));
    EXPECT_TRUE(contains(error_for("missing.yaml"), "missing.yaml:1:10: field 'vehicle': "));
    EXPECT_TRUE(contains(error_for("missing.yaml"), "none.yaml: no such file"));
    EXPECT_NE(input_error_of([] { load_vehicle("none"); }), "");
    EXPECT_NE(input_error_of([] { load_vehicle(""); }), "");
    EXPECT_NE(input_error_of([] { load_driver("."); }), "");
    EXPECT_NE(input_error_of([] { load_policies("/"); }), "");
}

TEST(DataFiles, DirectoryCanBeChosen) {
    const TemporaryFolder folder;
    folder.write("vehicles/a.yaml", "");
    folder.write("vehicles/b.yaml", "");
    folder.write("vehicles/c.txt", "");
    ASSERT_EQ(::setenv("STOPLINE_DATA", folder.path().c_str(), 1), 0);
    const auto names = data_names("vehicles");
    const auto directory = data_directory();
    const auto none = data_names("drivers");
    const std::string error = error_of(kSmall);
    ASSERT_EQ(::unsetenv("STOPLINE_DATA"), 0);
    EXPECT_EQ(directory, folder.path());
    EXPECT_EQ(names, (std::vector<std::string>{"a", "b"}));
    EXPECT_TRUE(none.empty());
    EXPECT_TRUE(contains(error, "there is no 'petrol_eu4_72kw' in"));
    EXPECT_EQ(error_of(kSmall), "");
}

TEST(DataFiles, HaveScenariosBesideThem) {
    EXPECT_EQ(scenario_directory(), data_directory().parent_path() / "scenarios");
    const TemporaryFolder folder;
    const std::filesystem::path data = folder.write("data/vehicles/a.yaml", "").parent_path().parent_path();
    ASSERT_EQ(::setenv("STOPLINE_DATA", data.c_str(), 1), 0);
    const std::string error = input_error_of([] { scenario_directory(); });
    ASSERT_EQ(::unsetenv("STOPLINE_DATA"), 0);
    EXPECT_TRUE(contains(error, "there is no folder " + (folder.path() / "scenarios").string()));
    EXPECT_TRUE(contains(error, "set STOPLINE_DATA"));
}

}  // namespace
}  // namespace stopline
