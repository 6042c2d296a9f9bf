// Tests of the checks of vehicles, drivers and policies: vehicles must be able to keep their gaps, and parameters that
// are used beyond their data give a warning.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

std::string error_with(const std::vector<std::string>& overrides) { return error_of("title: x\n", overrides); }

// Returns the number of warnings that contain the text.
std::ptrdiff_t warnings_with(const std::vector<std::string>& overrides, const std::string& text) {
    const Scenario scenario = parse_scenario("title: x\n", "x.yaml", overrides);
    return std::count_if(scenario.warnings.begin(), scenario.warnings.end(),
                         [&](const std::string& line) { return contains(line, text); });
}

std::vector<std::string> population_with_gap(const std::string& law_and_gap) {
    return {"policies=[{name: P, law: " + law_and_gap + "}]", "populations=[P]"};
}

TEST(DrivingChecks, StandstillGapCoversAHardStop) {
    EXPECT_EQ(error_with(population_with_gap("constant_distance, standstill_gap: 2 m")), "");
    for (const std::string law :
         {"constant_distance, standstill_gap: 1.9 m", "constant_time, time_gap: 0.3 s, standstill_gap: 1.9 m",
          "switch_time_gap, time_gap: 1 s, switch_speed: 20 km/h, standstill_gap: 0.2 m"}) {
        EXPECT_TRUE(contains(error_with(population_with_gap(law)), "field 'policies[P].standstill_gap': value "))
            << law;
    }
    EXPECT_EQ(error_with({"policies=[{name: P, law: constant_distance, standstill_gap: 0.2 m}]"}), "")
        << "no population uses the policy";
}

TEST(DrivingChecks, MesoscaleGapCoversTheToleranceBand) {
    // The constant-distance model (equation (1) of the paper) keeps the gap only within a tolerance band. With the
    // parameters of Table 2, a vehicle can stop with a gap 1 m smaller than the standstill gap.
    std::vector<std::string> small = population_with_gap("constant_distance, standstill_gap: 0.9 m");
    small.emplace_back("fidelity=meso");
    small.emplace_back("meso=table2");
    EXPECT_TRUE(
        contains(error_with(small), "with the mesoscale parameters 'table2' vehicles come nearer by up to 1 m"));
    small[0] = population_with_gap("constant_distance, standstill_gap: 1 m")[0];
    EXPECT_EQ(error_with(small), "");
    small[0] = population_with_gap("constant_time, time_gap: 1 s, standstill_gap: 0.3 m")[0];
    EXPECT_EQ(error_with(small), "") << "the model for time gaps has no band";
}

TEST(DrivingChecks, TyresGiveTheDecelerationOfDrivers) {
    EXPECT_EQ(error_with({"vehicle.brake_friction=0.72"}), "");
    EXPECT_TRUE(
        contains(error_with({"vehicle.brake_friction=0.7"}), "field 'vehicle.brake_friction': the tyres give "));
    EXPECT_EQ(error_with({"vehicle.brake_friction=0.7", "fidelity=meso"}), "") << "the mesoscale mode has no tyres";
    EXPECT_EQ(error_with({"vehicle.brake_friction=0.5",
                          "driver={base: startup_kit, cacc: {deceleration_emergency: 4.9 m/s2}}"}),
              "");
}

TEST(DrivingChecks, LagsAreShorterThanThePrediction) {
    EXPECT_EQ(error_with({"vehicle.brake_lag=0.5 s"}), "");
    EXPECT_TRUE(contains(error_with({"vehicle.brake_lag=0.51 s"}),
                         "field 'vehicle.brake_lag': a lag of 0.51 s is longer than the controller foresees"));
    EXPECT_TRUE(contains(error_with({"vehicle.lag_gear_factors=[1, 2, 1, 1, 1]"}),
                         "field 'vehicle.lag_times': a lag of 0.65 s is longer"));
    EXPECT_EQ(error_with({"vehicle.lag_gear_factors=[1, 1.5, 1, 1, 1]"}), "");
}

TEST(DrivingChecks, NoBrakingIsHarderThanAnEmergency) {
    const auto with = [](const std::string& fields) {
        return error_with({"driver={base: startup_kit, " + fields + "}"});
    };
    EXPECT_EQ(with("stop: {decision_deceleration: 7 m/s2}"), "");
    EXPECT_TRUE(contains(with("stop: {decision_deceleration: 7.5 m/s2}"), "field 'driver.stop.decision_deceleration'"));
    EXPECT_TRUE(contains(with("stop: {deceleration: 7.5 m/s2}"), "field 'driver.stop.deceleration'"));
    EXPECT_TRUE(contains(with("cacc: {emergency_threshold: 4 m/s2}"), "field 'driver.cacc.emergency_threshold'"));
}

TEST(DrivingChecks, FastRoadsGiveOneWarning) {
    const std::string full = "are beyond the data of driver 'startup_kit', which hold up to 50 km/h";
    const std::string meso = "are beyond the data of the mesoscale parameters 'table2', which hold up to 50 km/h";
    const std::string limit = "network.approach.speed_limit=";
    EXPECT_EQ(warnings_with({limit + "50 km/h"}, "beyond the data"), 0);
    EXPECT_EQ(warnings_with({limit + "100 km/h"}, full), 1);
    EXPECT_EQ(warnings_with({limit + "100 km/h"}, "speed limits up to 100 km/h"), 1);
    EXPECT_EQ(warnings_with({limit + "100 km/h", "fidelity=meso"}, "beyond the data"), 1);
    EXPECT_EQ(warnings_with({limit + "100 km/h", "fidelity=meso"}, meso), 1);
}

TEST(DrivingChecks, LongMesoscaleStepsGiveAWarningWithConstantDistances) {
    EXPECT_EQ(warnings_with({"fidelity=meso", "meso.step=0.1 s"}, "meso.step"), 0);
    EXPECT_EQ(warnings_with({"fidelity=meso", "meso.step=0.2 s"}, "meso.step of 200 ms is longer than"), 1);
    EXPECT_EQ(warnings_with({"fidelity=meso", "meso.step=0.2 s", "populations=[CTG-Ref]"}, "meso.step"), 0);
}

// Mesoscale mode: a vehicle stops up to b (dt - tau)^2 / 2 too late. The parameters `start_passages` have a reaction
// time tau of about 1 ms for the policy CDG. With the deceleration b = 2.5 m/s2 of driver.stop and steps of 0.5 s this
// gives 0.311 m.
TEST(DrivingChecks, MarginsCoverTheStepsOfAStop) {
    const auto with = [](std::vector<std::string> overrides) {
        overrides.insert(overrides.begin(), {"fidelity=meso", "meso=start_passages", "populations=[CDG]",
                                             "network.kind=intersection", "duration=400 s"});
        return error_with(overrides);
    };
    EXPECT_EQ(with({"meso.step=0.5 s"}), "");
    EXPECT_EQ(with({"meso.step=0.5 s", "driver.stop.margin=0.313 m"}), "");
    EXPECT_TRUE(contains(with({"meso.step=0.5 s", "driver.stop.margin=0.31 m"}),
                         "field 'driver.stop.margin': value 0.31 m is too small: with meso.step = 0.5 s, vehicles can "
                         "stop 0.3112844 m too late. Give at least 0.313 m, or a shorter step"));
    EXPECT_TRUE(contains(with({"meso.step=0.5 s", "driver.give_way.margin=0.2 m"}), "field 'driver.give_way.margin'"));
    EXPECT_EQ(with({"driver.give_way.margin=0.014 m"}), "");
    EXPECT_TRUE(contains(with({"driver.give_way.margin=0 m"}), "at least 0.014 m"));
}

// If the deceleration of a stop is near the emergency deceleration, a vehicle cannot stop in the step after the one in
// which it reaches its place. With 5 m/s2 and 7 m/s2 it then overshoots by up to b (2 dt - tau)^2 / 2 - e dt^2, which
// is
// 2.5 - 1.75 = 0.75 m for steps of 0.5 s and without reaction time. One step alone would give 0.625 m.
TEST(DrivingChecks, MarginsCoverTheLimitOfBraking) {
    const auto with_margin = [](const std::string& margin) {
        return error_with(
            {"fidelity=meso",
             "meso={base: passages, step: 0.5 s, constant_distance: {deceleration: 5 m/s2, reaction: 0 s}}",
             "populations=[CDG]", "network.kind=intersection", "duration=400 s", "driver.stop.deceleration=6 m/s2",
             "driver.give_way.margin=1 m", "driver.stop.margin=" + margin});
    };
    EXPECT_TRUE(contains(with_margin("0.75 m"), "vehicles can stop 0.75 m too late. Give at least 0.751 m"))
        << with_margin("0.75 m");
    EXPECT_EQ(with_margin("0.751 m"), "");
}

TEST(DrivingChecks, FullDynamicsNeedsAMarginBeforeConflictAreas) {
    const std::vector<std::string> intersection{"network.kind=intersection", "duration=400 s"};
    const auto with = [&](std::vector<std::string> overrides) {
        overrides.insert(overrides.begin(), intersection.begin(), intersection.end());
        return error_with(overrides);
    };
    EXPECT_TRUE(contains(with({"driver.give_way.margin=0.009 m"}),
                         "field 'driver.give_way.margin': value 0.009 m is too small: in full dynamics"));
    EXPECT_EQ(with({"driver.give_way.margin=0.01 m"}), "");
    EXPECT_TRUE(contains(with({"populations=[{name: P, components: [{policy: CDG, share: 100 %, driver: {base: "
                               "startup_kit, give_way: {margin: 0 m}}}]}]"}),
                         "field 'populations[P].components[0].driver.give_way.margin'"));
    EXPECT_EQ(error_with({"driver.give_way.margin=0 m"}), "") << "a single light has no conflict areas";
}

}  // namespace
}  // namespace stopline
