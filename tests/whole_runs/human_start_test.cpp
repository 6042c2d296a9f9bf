// The start of a queue of human drivers beside public data. Reaction time and time gap of the drivers come from the
// literature, and their acceleration from standing starts of a single car (data/drivers/startup_kit.yaml). Nothing is
// fitted to these data:
//
//   start delay      0.82 s and 1.01 s from the start of the leader to the own start, at standstill gaps of 1.48 m and
//                    2.49 m with standard deviations of 1.30 m and 0.90 m (data/startup/standing_and_following.csv).
//                    The start wave is the distance from front to front divided by this delay. So one standard
//                    deviation of the gap around both means gives waves of 6.5 to 9.7 m/s for cars of 5.15 m.
//   first headways   3.8 s, 3.1 s, 2.7 s and 2.4 s at the stop line, then 2.2 s and 2.1 s (Greenshields, Schapiro,
//                    Ericksen 1947, "Traffic performance at urban street intersections"). The first one is from the
//                    start of green. Their spread is not published; the test allows 20 %.
//   discharge        24, 24 and 22 vehicles a lane in 70 s of green (issue 17830 of SUMO). A further lane lies between
//                    18 and 29 with 95 % (prediction interval of three values). The headways of 1947 give 31 vehicles.
//                    The Highway Capacity Manual gives 36: saturation flow 1,900 vehicles/h, lost time 2 s.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kGreen_s = 5.0;
constexpr double kGreenTime_s = 70.0;
constexpr int kQueue = 60;

struct QueueStart {
    double wave_mps = 0.0;               // speed of the start wave between the 5th and the 20th vehicle
    std::array<double, 4> headways_s{};  // of the rears at the stop line; the first one is from the start of green
    int passed = 0;                      // vehicles whose fronts pass the stop line within 70 s of green
};

// Returns the time at which a point of the vehicle passes the stop line, interpolated between two positions.
double passing_s(double before_m, double after_m, double line_m, double time_s, double step_s) {
    return time_s - step_s * (after_m - line_m) / (after_m - before_m);
}

QueueStart start_of(const std::string& policy, const std::vector<std::string>& overrides) {
    TrackPlan plan;
    plan.policy = policy;
    plan.length_m = 600.0;
    plan.exit_m = 1500.0;
    plan.green_from_s = kGreen_s;
    plan.overrides = overrides;
    Track track(plan);
    track.place_platoon(0, plan.length_m - track.model().drivers[0].tables.stop.margin_m, 0.0, kQueue - 1);
    const double length_m = track.model().vehicles[0].length_m;
    const double spacing_m = track.vehicle(0, 0).position_m - track.vehicle(0, 1).position_m;
    std::vector<double> start_s(kQueue, 0.0);
    std::vector<double> rear_m(kQueue, -1e3);
    std::vector<double> rear_passed_s;
    QueueStart result;
    while (track.time_s() < kGreen_s + kGreenTime_s) {
        track.step();
        const auto watch = [&](const VehicleView& vehicle, double front_m) {
            const std::size_t id = at(vehicle.id);
            if (vehicle.speed_mps > 0.1 && start_s[id] == 0.0) start_s[id] = track.time_s();
            const double before_m = rear_m[id];
            rear_m[id] = front_m - length_m;
            if (before_m < plan.length_m && rear_m[id] >= plan.length_m && before_m > 0.0)
                rear_passed_s.push_back(passing_s(before_m, rear_m[id], plan.length_m, track.time_s(), track.step_s()));
        };
        for (int k = 0; k < track.count(1); ++k) {
            const VehicleView vehicle = track.vehicle(1, k);
            watch(vehicle, plan.length_m + vehicle.position_m);
        }
        for (int k = 0; k < track.count(0); ++k) watch(track.vehicle(0, k), track.vehicle(0, k).position_m);
        result.passed = kQueue - track.count(0);
    }
    result.wave_mps = 15.0 * spacing_m / (start_s[19] - start_s[4]);
    for (std::size_t k = 0; k < 4; ++k)
        result.headways_s[k] = rear_passed_s[k] - (k == 0 ? kGreen_s : rear_passed_s[k - 1]);
    return result;
}

const std::vector<std::string> kMeso{"fidelity=meso", "meso=fitted"};
const std::vector<std::string> kFull{};
constexpr std::array<double, 4> kHeadways_s{3.8, 3.1, 2.7, 2.4};

class HumanStart : public ::testing::TestWithParam<bool> {
protected:
    static std::vector<std::string> fidelity() { return GetParam() ? kMeso : kFull; }
};
INSTANTIATE_TEST_SUITE_P(Fidelities, HumanStart, ::testing::Bool(),
                         [](const auto& fidelity) { return fidelity.param ? "meso" : "full"; });

TEST_P(HumanStart, DischargesWithinThePublicData) {
    const int humans = start_of("HUMAN", fidelity()).passed;
    EXPECT_GE(humans, 18);
    EXPECT_LE(humans, 36);
    EXPECT_LT(humans, start_of("CTG-Ref", fidelity()).passed);
}

TEST_P(HumanStart, HasTheMeasuredFirstHeadways) {
    const QueueStart humans = start_of("HUMAN", fidelity());
    for (std::size_t k = 0; k < kHeadways_s.size(); ++k) {
        EXPECT_NEAR(humans.headways_s[k], kHeadways_s[k], 0.2 * kHeadways_s[k]) << k;
    }
}

// Without a reaction time the start wave is faster, and with automated vehicles too.
TEST_P(HumanStart, WaveIsSlowerThanWithAutomatedVehicles) {
    std::vector<std::string> at_once = fidelity();
    at_once.emplace_back("driver.human.start_reaction=0 s");
    const double human_mps = start_of("HUMAN", fidelity()).wave_mps;
    EXPECT_GT(start_of("HUMAN", at_once).wave_mps, human_mps + 1.0);
    EXPECT_GT(start_of("CTG-Ref", fidelity()).wave_mps, human_mps + 1.0);
}

TEST(HumanStartWave, IsThatOfMeasurementsInFullDynamics) {
    const double human_mps = start_of("HUMAN", kFull).wave_mps;
    EXPECT_GT(human_mps, 6.5);
    EXPECT_LT(human_mps, 9.7);
}

// In the mesoscale mode the delay of a start is the reaction time plus the delay of the powertrain, in whole steps.
TEST(HumanStartWave, IsThatOfItsDelaysInTheMesoscaleMode) {
    const std::vector<std::string> even{"fidelity=meso", "meso=fitted", "driver.human.reaction_spread=0 s"};
    TrackPlan plan;
    plan.policy = "HUMAN";
    plan.overrides = even;
    const Track track(plan);
    const double delay_s = track.model().drivers[0].human.start_reaction_s + track.model().powertrain_delay_s;
    const double spacing_m = track.model().vehicles[0].length_m + 2.0;
    const double wave_mps = start_of("HUMAN", even).wave_mps;
    EXPECT_LT(wave_mps, spacing_m / (delay_s - track.step_s()));
    EXPECT_GT(wave_mps, spacing_m / (delay_s + 2.0 * track.step_s()));
}

// A leader stops as hard as the tyres allow. No human driver of the platoon behind it runs into its leader, although
// some have a reaction time above their time gap (Track checks for overlaps).
TEST(HumanDrivers, NobodyRunsIntoALeaderThatStopsHard) {
    for (const std::vector<std::string>& fidelity : {std::vector<std::string>(), kMeso}) {
        for (const char* const reaction : {"driver.human.reaction=1 s", "driver.human.reaction=1.7 s"}) {
            TrackPlan plan;
            plan.policy = "HUMAN";
            plan.overrides = fidelity;
            plan.overrides.emplace_back(reaction);
            Track track(plan);
            track.place_platoon(0, 900.0, 13.0, 25);
            track.run(5.0);
            double front_m = track.vehicle(0, 0).position_m;
            double speed_mps = track.vehicle(0, 0).speed_mps;
            while (track.time_s() < 120.0) {
                track.drive(0, 0, front_m, speed_mps, speed_mps > 0.0 ? -7.0 : 0.0, speed_mps > 0.0 ? -7.0 : 0.0, 0.2);
                track.step();
                const double next_mps = std::max(speed_mps - 7.0 * track.step_s(), 0.0);
                front_m += 0.5 * (speed_mps + next_mps) * track.step_s();
                speed_mps = next_mps;
            }
            EXPECT_LT(track.vehicle(0, 25).speed_mps, 0.5);
            EXPECT_GE(track.vehicle(0, 25).gap_m, 0.0);
        }
    }
}

// Human drivers and automated vehicles in one run: the vectorised and the scalar kernels of full dynamics give the same
// bits, and no vehicle breaks a rule.
TEST(HumanDrivers, MixWithAutomatedVehicles) {
    const Scenario scenario = load_scenario(
        STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml",
        {"measure.baseline=mixed",
         "populations=[{name: mixed, components: [{policy: CDG, share: 40 %}, {policy: HUMAN, share: 40 %}, "
         "{policy: CTG-Ref, share: 20 %}]}]"});
    const Model vectorised = build_model(scenario, 0);
    ASSERT_EQ(vectorised.drivers.size(), 2u);
    Model scalar = vectorised;
    scalar.scalar_kernels = true;
    Simulation first(vectorised);
    Simulation second(scalar);
    for (int k = 1; k <= 4; ++k) {
        first.run_until(15.0 * k);
        second.run_until(15.0 * k);
        ASSERT_EQ(first.state_hash(), second.state_hash()) << "at " << 15 * k << " s";
    }
    EXPECT_TRUE(first.state().records.violations.none());
}

}  // namespace
}  // namespace stopline
