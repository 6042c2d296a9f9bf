// Tests of the checks that compare several fields. Each message names the field to change.
#include <gtest/gtest.h>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

// Returns the error of the default scenario with overrides, or "" if it is accepted.
std::string error_with(const std::vector<std::string>& overrides) { return error_of("title: x\n", overrides); }

TEST(Checks, DefaultsAreAccepted) { EXPECT_EQ(error_with({}), ""); }

TEST(Checks, SharesSumToOne) {
    EXPECT_TRUE(contains(error_with({"populations[MIX].components[0].share=60 %"}),
                         "field 'populations[MIX].components': the shares sum to 110 %, not to 100 %"));
    EXPECT_EQ(
        error_with(
            {"populations=[{name: A, components: [{policy: CDG, share: 33.3333 %}, {policy: CTG-Ref, share: 66.6667 %}]}]"}),
        "");
    // In double precision 10 % + 70 % + 20 % is slightly less than 100 %.
    EXPECT_EQ(
        error_with(
            {"populations=[{name: A, components: [{policy: CDG, share: 10 %}, {policy: CTG-Ref, share: 70 %}, {policy: "
             "CTG-HBS, share: 20 %}]}]"}),
        "");
}

TEST(Checks, NamesAreKnownAndUnique) {
    EXPECT_TRUE(
        contains(error_with({"populations=[CDG, XYZ]"}), "there is no policy 'XYZ'; known: CDG, CDG-6m, CTG-Ref"));
    EXPECT_TRUE(contains(error_with({"populations=[CDG, CDG]"}),
                         "field 'populations[CDG].name': the name 'CDG' appears twice"));
    EXPECT_TRUE(contains(error_with({"policies=[{name: A, law: constant_distance, standstill_gap: 2 m}, {name: A, law: "
                                     "constant_distance, standstill_gap: 3 m}]"}),
                         "field 'policies[A].name': the name 'A' appears twice"));
    EXPECT_TRUE(
        contains(error_with({"measure.baseline=CTG"}), "field 'measure.baseline': there is no population 'CTG'"));
    EXPECT_EQ(error_with({"measure.baseline=MIX"}), "");
}

TEST(Checks, ABaselineCanBeTakenBack) {
    const std::string file = "populations: [CDG, CTG-Ref]\nmeasure: {baseline: CTG-Ref}\n";
    EXPECT_TRUE(contains(error_of(file, {"populations=[CDG]"}),
                         "there is no population 'CTG-Ref'; known: CDG; give one of these, or none for no comparison"));
    EXPECT_EQ(parse_scenario(file, "x", {"populations=[CDG]", "measure.baseline=none"}).measure.baseline, "");
    const Scenario without = parse_scenario("populations: [CDG, CTG-Ref]\nname: x\n", "x");
    EXPECT_EQ(parse_scenario(file, "x", {"measure.baseline=none"}).hash, without.hash);
}

// `baseline: none` means no comparison, so it cannot name a population.
TEST(Checks, NoPopulationCanBeNamedNone) {
    const std::string file =
        "populations: [CDG, {name: none, components: [{policy: CTG-Ref, share: 100 %}]}]\nmeasure: {baseline: CDG}\n";
    EXPECT_TRUE(contains(error_of(file, {}),
                         "field 'populations[none].name': the name 'none' is reserved: as measure.baseline it means no "
                         "comparison; give another name"));
}

TEST(Checks, LoopsLieOnLanes) {
    const auto error = [](const std::string& loops, const std::string& kind = "intersection") {
        return error_of("network: {kind: " + kind + "}\nmeasure: {loops: [" + loops + "]}\n");
    };
    EXPECT_EQ(error("{name: a, lane: west_in_0, position: 0 m}, {name: b, lane: west_in_0, position: -40 m}"), "");
    EXPECT_TRUE(contains(error("{name: a, lane: west_out_0, position: 1 m}, {name: a, lane: west_in_0, position: 2 m}"),
                         "field 'measure.loops[a].name': the name 'a' appears twice"));
    EXPECT_TRUE(contains(error("{name: a, lane: west_on_0, position: 1 m}"),
                         "field 'measure.loops[a].lane': no lane has the name 'west_on_0'; did you mean 'west_in_0'?"));
    for (const std::string far : {"-1000 m", "1000 m"}) {
        EXPECT_TRUE(
            contains(error("{name: a, lane: west_in_0, position: " + far + "}"),
                     "field 'measure.loops[a].position': value " + far +
                         " is not on the lane west_in_0: allowed are -200 m to 200 m, the length up to the stop line"));
    }
    EXPECT_TRUE(contains(error("{name: west_in_0_stop_line, lane: west_in_0, position: 1 m}"),
                         "field 'measure.loops[west_in_0_stop_line].name': value 'west_in_0_stop_line' is the id of a "
                         "detector that --e1 lists anyway"));
    EXPECT_EQ(error("{name: west_in_0_near, lane: west_in_0, position: 1 m}"), "");
}

TEST(Checks, OwnPoliciesReplacePoliciesOfThePaper) {
    const Scenario s =
        parse_scenario("policies: [{name: CDG, law: constant_distance, standstill_gap: 2 m}]\n", "x.yaml");
    EXPECT_EQ(s.policies.size(), load_policies().size());
    EXPECT_EQ(s.policies[0].name, "CDG");
    EXPECT_EQ(s.policies[0].standstill_gap_m, 2.0);
    const std::string own = "{name: CDG, law: constant_distance, standstill_gap: 2 m}";
    EXPECT_TRUE(contains(error_with({"policies=[" + own + ", " + own + "]"}), "the name 'CDG' appears twice"));
}

TEST(Checks, PoliciesHaveExactlyTheFieldsOfTheirLaw) {
    const auto with = [](const std::string& fields) {
        return error_with({"policies=[{name: A, standstill_gap: 3 m, " + fields + "}]"});
    };
    EXPECT_EQ(with("law: constant_distance"), "");
    EXPECT_EQ(with("law: constant_time, time_gap: 1 s"), "");
    EXPECT_EQ(with("law: switch_time_gap, time_gap: 1 s, switch_speed: 30 km/h"), "");
    EXPECT_EQ(with("law: switch_distance, switch_speed: 30 km/h, reference_speed: 50 km/h, reference_gap: 9 m"), "");
    EXPECT_TRUE(contains(with("law: constant_time"), "field 'policies[A].time_gap' is missing"));
    EXPECT_TRUE(contains(with("law: constant_distance, time_gap: 1 s"),
                         "applies only if law is constant_time or switch_time_gap"));
    EXPECT_TRUE(
        contains(with("law: switch_distance, switch_speed: 60 km/h, reference_speed: 50 km/h, reference_gap: 9 m"),
                 "must be greater than switch_speed"));
    EXPECT_TRUE(
        contains(with("law: switch_distance, switch_speed: 30 km/h, reference_speed: 50 km/h, reference_gap: 2 m"),
                 "must be at least standstill_gap"));
    // An unknown law gives one error only; its other fields are not checked.
    EXPECT_EQ(lines_of(with("law: constant_tine, time_gap: 1 s")), 1u);
}

TEST(Checks, TimesAreWholeSteps) {
    EXPECT_EQ(error_with({"step=20 ms"}), "");
    EXPECT_EQ(error_with({"step=5 ms"}), "");
    EXPECT_TRUE(contains(error_with({"signal.green=15.005 s"}),
                         "field 'signal.green': 15.005 s is not a whole number of steps of 10 ms"));
    // Rounding is no alternative: if the times of the two streets were rounded separately, their cycles would differ
    // and drift apart.
    const std::string grid = STOPLINE_SOURCE_DIR "/scenarios/grid.yaml";
    for (const std::string field : {"cross_green", "offset"}) {
        try {
            static_cast<void>(load_scenario(grid, {"signal." + field + "=10.05 s"}));
            ADD_FAILURE() << field;
        } catch (const InputError& error) {
            EXPECT_TRUE(
                contains(error.what(), "'signal." + field + "': 10.05 s is not a whole number of steps of 100 ms"));
        }
    }
    EXPECT_TRUE(
        contains(error_with({"step=7 ms"}), "field 'signal.yellow': 3 s is not a whole number of steps of 7 ms"));
    EXPECT_TRUE(
        contains(error_with({"measure.green=[5.001 s]"}), "field 'measure.green[0]': 5.001 s is not a whole number"));
}

TEST(Checks, MessagesArriveInTheNextStepOrLater) {
    const std::string both =
        "a message cannot arrive before the next step: step, 50 ms, must be at most driver.cacc.v2v_delay, 20 ms";
    EXPECT_TRUE(contains(error_with({"step=50 ms"}), "--set 'step=50 ms': field 'step': " + both));
    EXPECT_TRUE(contains(error_with({"driver.cacc.v2v_delay=5 ms"}),
                         "--set 'driver.cacc.v2v_delay=5 ms': field 'driver.cacc.v2v_delay': a message cannot arrive"));
    EXPECT_EQ(error_with({"step=50 ms", "driver.cacc.v2v_delay=50 ms"}), "");
    EXPECT_TRUE(contains(error_with({"step=200 ms", "driver.cacc.v2v_delay=1 s"}),
                         "value '200 ms' is out of range (allowed: 0.001 s to 0.1 s)"));
}

TEST(Checks, AMissingFileOfDeliveryIsReportedOnce) {
    const auto error_with_delivery = [](const std::string& file) {
        return error_with({"driver.v2v={channel: delivery_over_distance, delivery: " + file + "}"});
    };
    const std::string missing = error_with_delivery("nonsense");
    EXPECT_TRUE(contains(missing, "there is no 'nonsense' in ")) << missing;
    EXPECT_EQ(lines_of(missing), 1U) << missing;
    EXPECT_EQ(error_with_delivery("cv2x_4_subchannels"), "");
    const std::string empty = error_with_delivery("{curves: []}");
    EXPECT_TRUE(contains(empty, "field 'driver.v2v.delivery.curves': has 0 entries")) << empty;
    EXPECT_EQ(lines_of(empty), 1U) << empty;
}

TEST(Checks, MissingSectionsHaveDefaults) {
    for (const std::string kind : {"intersection", "grid"}) {
        const Scenario s = parse_scenario("network: {kind: " + kind + "}\nduration: 600 s\n", "x.yaml");
        ASSERT_EQ(s.network.intersection.lanes.size(), 2u) << kind;
        EXPECT_EQ(s.network.intersection.lanes[0].movements, "straight+left");
        EXPECT_EQ(s.network.intersection.lanes[1].movements, "straight+right");
    }
}

TEST(Checks, SignalFitsItsCycleAndTheRun) {
    EXPECT_TRUE(
        contains(error_with({"signal.cycle=60 s"}), "a cycle of 60 s is shorter than green + yellow + all red = 68 s"));
    EXPECT_EQ(error_with({"signal.cycle=68 s"}), "");
    EXPECT_TRUE(
        contains(error_with({"signal.first_green=200 s"}), "value 200 s must be below the duration of the run, 200 s"));
    EXPECT_TRUE(contains(error_with({"measure.green=[61 s]"}), "lies after the end of the green time of 60 s"));
    EXPECT_TRUE(contains(error_with({"signal.first_green=180 s", "measure.green=[30 s]"}),
                         "the run ends earlier, at duration = 200 s"));
    EXPECT_EQ(error_with({"signal.first_green=180 s", "measure.green=[20 s]"}), "");
}

TEST(Checks, QueueFitsTheApproach) {
    // 60 vehicles of 5.15 m with standstill gaps of 6 m, the first one 1 m before the line: 60 x (5.15 m + 6 m) + 1 m.
    EXPECT_TRUE(
        contains(error_with({"network.approach.length=669.9 m"}), "a queue of 60 vehicles a lane is 670 m long"));
    EXPECT_EQ(error_with({"network.approach.length=670 m"}), "");
    EXPECT_EQ(error_with({"network.approach.length=490 m", "populations=[CDG, CTG-Ref]"}), "");
    EXPECT_TRUE(contains(error_with({"network.approach.length=480 m", "populations=[CDG, CTG-Ref]"}), "is 487 m long"));
}

TEST(Checks, VehiclesOnNeighbouringLanesDoNotTouch) {
    for (const std::string kind : {"intersection", "grid"}) {
        const auto with = [&](const std::string& field) {
            return error_of(
                "network: {kind: " + kind + "}\nduration: 600 s\nsignal: {green: 20 s}\nmeasure: {green: []}\n",
                {"network.intersection." + field});
        };
        EXPECT_TRUE(contains(with("clearance=5 m"),
                             "field 'network.intersection.clearance': value 5 m is too large for "
                             "lanes of 3.5 m: vehicles on neighbouring lanes would touch. The maximum is 3 m"));
        EXPECT_TRUE(contains(with("lane_width=2 m"), "value 2 m is too large for lanes of 2 m"));
        EXPECT_EQ(with("clearance=3 m"), "");
        EXPECT_EQ(with("lane_width=2.5 m"), "");
    }
}

TEST(Checks, MesoscaleStepsAreAtMostHalfASecond) {
    EXPECT_TRUE(contains(error_of("fidelity: meso\n", {"meso={base: fitted, step: 1 s}"}),
                         "field 'meso.step': value '1 s' is out of range (allowed: 0.01 s to 0.5 s)"));
    EXPECT_EQ(error_of("fidelity: meso\n", {"meso={base: fitted, step: 0.5 s}"}), "");
}

TEST(Checks, GearSettingsAreConsistent) {
    EXPECT_TRUE(contains(error_with({"vehicle.gear_ratios=[3, 2, 1]"}),
                         "field 'vehicle.rotating_mass_factors': has 5 values for 3 gears"));
    EXPECT_TRUE(contains(error_with({"vehicle.lag_gear_factors=[1]"}), "has 1 values for 5 gears"));
    EXPECT_TRUE(contains(error_with({"vehicle.gear_ratios=[3.6, 2, 2, 1.4, 1]"}), "must fall from gear to gear"));
    EXPECT_TRUE(contains(error_with({"vehicle.gear_ratios=[9, 8, 7, 6, 5, 4, 3, 2, 1]"}),
                         "has 9 entries (allowed: 1 to 8 values"));
    EXPECT_TRUE(contains(error_with({"vehicle.shift_down=1500 rpm"}), "the gearbox would hunt"));
    EXPECT_TRUE(contains(error_with({"vehicle.shift_up_full_load=1900 rpm"}), "must be at least shift_up_part_load"));
    EXPECT_TRUE(contains(error_with({"vehicle.shift_up_full_load=6501 rpm"}), "must be at most limiter_speed"));
    EXPECT_TRUE(contains(error_with({"vehicle.shift_down=700 rpm"}), "must be greater than idle_speed"));
    EXPECT_TRUE(
        contains(error_with({"vehicle.lag_times=[0.1 s]"}), "has 1 values, but the map has 8 speeds x 2 shares"));
    // Shift speeds are optional for one gear and required for several gears.
    const std::string errors = error_with({"vehicle=electric_100kw", "vehicle.gear_ratios=[9.7, 5]",
                                           "vehicle.rotating_mass_factors=[1, 1]", "vehicle.lag_gear_factors=[1, 1]"});
    EXPECT_TRUE(
        contains(errors, "field 'vehicle.shift_up_part_load': is missing: a vehicle with several gears needs it"));
    EXPECT_TRUE(contains(errors, "field 'vehicle.minimum_gear_time': is missing"));
}

TEST(Checks, EngineSpeedsAreConsistent) {
    EXPECT_TRUE(contains(error_with({"vehicle.limiter_speed=700 rpm"}), "must be greater than idle_speed"));
    EXPECT_TRUE(contains(error_with({"vehicle.launch_speed=7000 rpm"}), "must be below limiter_speed"));
    EXPECT_TRUE(contains(error_with({"vehicle.launch_speed=700 rpm"}), "must be at least idle_speed"));
    EXPECT_TRUE(
        contains(error_with({"vehicle.full_load={1000 rpm: 1 N m, 7000 rpm: 1 N m}"}),
                 "field 'vehicle.full_load': covers 1000 rpm to 7000 rpm, but the engine runs at 798 rpm to 6500 rpm"));
    EXPECT_TRUE(contains(error_with({"vehicle.drag_torque={0 rpm: 0 N m, 6000 rpm: 0 N m}"}),
                         "field 'vehicle.drag_torque': covers"));
}

TEST(Checks, DriverSettingsAreConsistent) {
    EXPECT_TRUE(contains(error_with({"driver.cacc.prediction_end=0.1 s"}), "must be greater than prediction_start"));
    EXPECT_TRUE(
        contains(error_with({"driver.cacc.deceleration_emergency=3 m/s2"}), "must be at least deceleration_comfort"));
    EXPECT_TRUE(contains(error_with({"driver.free_drive.acceleration={1 km/h: 2 m/s2}"}), "must begin at 0 km/h"));
    EXPECT_TRUE(
        contains(error_with({"driver.free_drive.acceleration={0 km/h: 2 m/s2, 0 m/s: 1 m/s2}"}), "does not rise"));
    EXPECT_EQ(error_with({"driver.free_drive.acceleration={0 km/h: 2 m/s2}"}), "");
}

}  // namespace
}  // namespace stopline
