// The start of a queue of human drivers beside public data. The parameters of the drivers come from the literature
// (driver/driver_settings.h) and are not fitted to these data:
//
//   discharge        24, 24 and 22 vehicles a lane in 70 s of green (issue 17830 of SUMO). A further lane lies between
//                    18 and 29 with 95 % (prediction interval of three values).
//   first headways   3.8 s, 3.1 s, 2.7 s and 2.4 s at the stop line (Greenshields, Schapiro, Ericksen 1947, "Traffic
//                    performance at urban street intersections"). The first one is from the start of green.
//   start wave       6.8 m/s, from drive-off measurements of Salles, Kaufmann, Reuss 2020
//
// The simulated start wave is slower and the headways are longer than in these data. The reason is the acceleration for
// cities in the literature, 1 m/s2, which is less than half of that in measured standing starts (data/startup).
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
    std::array<double, 4> headways_s{};  // at the stop line; the first one is from the start of green
    int passed = 0;                      // vehicles that pass the stop line within 70 s of green
};

QueueStart start_of(const std::string& policy, const std::vector<std::string>& overrides, double step_s) {
    TrackPlan plan;
    plan.policy = policy;
    plan.length_m = 600.0;
    plan.exit_m = 1500.0;
    plan.green_from_s = kGreen_s;
    plan.overrides = overrides;
    plan.step_s = step_s;
    Track track(plan);
    track.place_platoon(0, plan.length_m - track.model().drivers[0].tables.stop.margin_m, 0.0, kQueue - 1);
    const double spacing_m = track.vehicle(0, 0).position_m - track.vehicle(0, 1).position_m;
    std::vector<double> start_s(kQueue, 0.0);
    std::vector<double> passed_s;
    while (track.time_s() < kGreen_s + kGreenTime_s) {
        track.step();
        for (int k = 0; k < track.count(0); ++k) {
            const VehicleView vehicle = track.vehicle(0, k);
            if (vehicle.speed_mps > 0.1 && start_s[at(vehicle.id)] == 0.0) start_s[at(vehicle.id)] = track.time_s();
        }
        while (static_cast<int>(passed_s.size()) < kQueue - track.count(0)) passed_s.push_back(track.time_s());
    }
    QueueStart result;
    result.wave_mps = 15.0 * spacing_m / (start_s[19] - start_s[4]);
    for (std::size_t k = 0; k < 4; ++k) result.headways_s[k] = passed_s[k] - (k == 0 ? kGreen_s : passed_s[k - 1]);
    result.passed = static_cast<int>(passed_s.size());
    return result;
}

const std::vector<std::string> kMeso{"fidelity=meso", "meso=fitted"};
constexpr std::array<double, 4> kHeadways_s{3.8, 3.1, 2.7, 2.4};

TEST(HumanStart, DischargesAsManyVehiclesAsMeasured) {
    const int full = start_of("HUMAN", {}, 0.01).passed;
    EXPECT_GE(full, 18);
    EXPECT_LE(full, 29);
    const int meso = start_of("HUMAN", kMeso, 0.01).passed;
    EXPECT_NEAR(meso, full, 4);
    EXPECT_LT(meso, start_of("CTG-Ref", kMeso, 0.01).passed);
}

TEST(HumanStart, HasTheMeasuredHeadwaysWithTheMeasuredAcceleration) {
    const QueueStart cities = start_of("HUMAN", {}, 0.01);
    const QueueStart starts = start_of("HUMAN", {"driver.human.idm.acceleration=2.5 m/s2"}, 0.01);
    for (std::size_t k = 1; k < kHeadways_s.size(); ++k) {
        EXPECT_GT(cities.headways_s[k], kHeadways_s[k] + 0.5) << k;
        EXPECT_NEAR(starts.headways_s[k], kHeadways_s[k], 0.35) << k;
    }
}

// The start wave is slower than measured, and slower than with automated vehicles. Without reaction time it is faster.
TEST(HumanStart, StartWaveIsSlowerThanMeasured) {
    for (const std::vector<std::string>& fidelity : {std::vector<std::string>(), kMeso}) {
        std::vector<std::string> at_once = fidelity;
        at_once.insert(at_once.end(), {"driver.human.reaction=0 s", "driver.human.reaction_spread=0 s"});
        const double human_mps = start_of("HUMAN", fidelity, 0.01).wave_mps;
        EXPECT_GT(human_mps, 3.5);
        EXPECT_LT(human_mps, 6.0);
        EXPECT_GT(start_of("HUMAN", at_once, 0.01).wave_mps, human_mps + 0.3);
        EXPECT_GT(start_of("CTG-Ref", fidelity, 0.01).wave_mps, 8.0);
    }
}

// A leader stops as hard as the tyres allow. No human driver of the platoon behind it runs into its leader, although
// some have a reaction time above their time gap (Track checks for overlaps).
TEST(HumanStart, NobodyRunsIntoALeaderThatStopsHard) {
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
