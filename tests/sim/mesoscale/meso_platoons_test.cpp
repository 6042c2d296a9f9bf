// Platoons of limited length in the mesoscale mode: saturation headways, starts, places, and the same bits for any
// number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kLimit_mps = 50.0 / 3.6;
constexpr double kTimeGap_s = 0.87;

TrackPlan limited(const std::string& max_vehicles, const std::string& policy = "CDG") {
    TrackPlan plan;
    plan.policy = policy;
    plan.overrides = {"fidelity=meso", "meso=passages", "driver.platoon.max_vehicles=" + max_vehicles};
    return plan;
}

Track queue(TrackPlan plan, int vehicles) {
    plan.green_from_s = 3.0;
    plan.length_m = 8.2 * vehicles;
    plan.exit_m = 3000.0;
    Track track(plan);
    const double spacing_m = track.model().vehicles[0].length_m + 2.95;
    for (int k = 0; k < vehicles; ++k) {
        track.place(0, plan.length_m - 1.0 - k * spacing_m, 0.0);
        if (k > 0) track.make_follower(0, k);
    }
    return track;
}

int place_of(const Track& track, int lane, int k) { return track.state().vehicles.platoon.place[track.slot(lane, k)]; }

// Returns the time at which each vehicle of a queue passes the stop line.
std::vector<double> passing_times_s(const std::string& max_vehicles, const std::string& policy, int vehicles,
                                    double duration_s) {
    Track track = queue(limited(max_vehicles, policy), vehicles);
    track.run(duration_s);
    std::vector<double> times_s(at(vehicles), -1.0);
    for (const Passage& passage : track.state().records.passages) {
        if (passage.from_lane == 0) times_s[at(passage.vehicle)] = passage.time_s;
    }
    EXPECT_GT(times_s.back(), 0.0) << "the last vehicle has not passed";
    return times_s;
}

// The leaders of mini-platoons keep the time gap T, all others only the standstill gap s. With the vehicle length L,
// the speed v and n vehicles in a platoon, the mean headway is
//     ((L + s)/v + T + (n - 1) (L + s)/v) / n = (L + s)/v + T/n
TEST(MesoPlatoons, SaturationHeadwayIsThatOfTheClosedForm) {
    constexpr int kVehicles = 130;
    constexpr int kFirst = 40;  // from here on the vehicles pass at the free speed
    constexpr double kSpacing_m = 8.1;
    for (const int n : {2, 4, 8, 10, 17}) {
        const std::vector<double> times_s = passing_times_s(std::to_string(n), "CDG", kVehicles, 190.0);
        const int from = (kFirst + n - 1) / n * n;
        const int to = (kVehicles - 1) / n * n;
        ASSERT_GE(to - from, 3 * n);
        const double headway_s = (times_s[at(to)] - times_s[at(from)]) / (to - from);
        const double expected_s = kSpacing_m / kLimit_mps + kTimeGap_s / n;
        EXPECT_NEAR(headway_s, expected_s, 0.015 * expected_s) << n << " vehicles";
        RecordProperty("headway_ms_" + std::to_string(n), static_cast<int>(std::lround(1e3 * headway_s)));
    }
}

TEST(MesoPlatoons, PlatoonsOfOneVehicleKeepTheTimeGapOfCtg) {
    constexpr int kVehicles = 50;
    const std::vector<double> limited_s = passing_times_s("1", "CDG", kVehicles, 100.0);
    const std::vector<double> ctg_s = passing_times_s("none", "CTG-Ref", kVehicles, 100.0);
    const auto headway_s = [&](const std::vector<double>& times_s) { return (times_s[49] - times_s[10]) / 39.0; };
    EXPECT_NEAR(headway_s(limited_s), headway_s(ctg_s), 0.015 * headway_s(ctg_s));
}

// With the parameters table2, platoon leaders have no acceleration of their own.
TEST(MesoPlatoons, TheLimitWorksWithAllParameters) {
    const auto crossings = [](const std::string& meso, const std::string& max_vehicles) {
        TrackPlan plan = limited(max_vehicles);
        plan.overrides[1] = "meso=" + meso;
        Track track = queue(plan, 40);
        track.run(33.0);
        return track.count(1);
    };
    for (const std::string meso : {"passages", "table2", "fitted"}) {
        const int unlimited = crossings(meso, "none");
        const int four = crossings(meso, "4");
        const int one = crossings(meso, "1");
        EXPECT_GT(unlimited, four) << meso;
        EXPECT_GT(four, one) << meso;
        EXPECT_NEAR(static_cast<double>(unlimited) / one, 2.1, 0.3) << meso;
    }
}

TEST(MesoPlatoons, VehiclesStartTogetherAndKeepTheirPlacesAcrossTheStopLine) {
    constexpr int kVehicles = 14;
    constexpr int kLongest = 4;
    Track track = queue(limited("4"), kVehicles);
    Track unlimited = queue(limited("none"), kVehicles);
    std::map<int, double> started_s;
    std::map<int, double> started_without_limit_s;
    const auto note = [](const Track& one, std::map<int, double>& times_s) {
        for (const int lane : {0, 1}) {
            for (int k = 0; k < one.count(lane); ++k) {
                const VehicleView view = one.vehicle(lane, k);
                if (view.speed_mps > 0.0) times_s.emplace(view.id, one.time_s());
            }
        }
    };
    while (track.time_s() < 70.0) {
        track.step();
        unlimited.step();
        note(track, started_s);
        note(unlimited, started_without_limit_s);
        if (track.time_s() < 3.0) {
            for (int k = 0; k < kVehicles && track.time_s() > 2.0; ++k) EXPECT_EQ(place_of(track, 0, k), k % kLongest);
        }
    }
    ASSERT_EQ(started_s.size(), at(kVehicles));
    for (const auto& [id, time_s] : started_s) EXPECT_NEAR(time_s, started_without_limit_s.at(id), 0.101) << id;
    ASSERT_EQ(track.count(1), kVehicles);
    for (int k = 1; k < kVehicles; ++k) {
        EXPECT_EQ(place_of(track, 1, k), k % kLongest);
        const VehicleView view = track.vehicle(1, k);
        const double wanted_m = 2.95 + (k % kLongest == 0 ? kTimeGap_s * view.speed_mps : 0.0);
        EXPECT_NEAR(view.gap_m, wanted_m, 0.5) << "vehicle " << k;
    }
}

TEST(MesoPlatoons, AnotherPolicyBreaksThePlatoon) {
    TrackPlan plan = limited("3", "P");
    plan.overrides.insert(plan.overrides.end(), {"measure.baseline=P",
                                                 "populations=[{name: P, components: [{policy: CDG, share: 50 %}, "
                                                 "{policy: CTG-Ref, share: 50 %}]}]"});
    plan.green_from_s = kForever_s;
    Track track(plan);
    const std::vector<int> policies{0, 0, 1, 0, 0, 0, 0};
    for (int k = 0; k < 7; ++k) {
        track.place(0, plan.length_m - 1.0 - 8.1 * k, 0.0, policies[at(k)]);
        if (k > 0) track.make_follower(0, k);
    }
    track.run(5.0);
    const std::vector<int> places{0, 1, -1, 0, 1, 2, 0};
    for (int k = 0; k < 7; ++k) EXPECT_EQ(place_of(track, 0, k), places[at(k)]) << "vehicle " << k;
}

// The gap of a mini-platoon that forms at full speed opens by about 1.5 m/s. The braking stays well below comfortable
// braking (3.5 m/s2).
TEST(MesoPlatoons, AGapOpensGentlyInMotion) {
    TrackPlan plan = limited("4");
    plan.length_m = 3000.0;
    Track track(plan);
    track.place_platoon(0, 500.0, 0.95 * kLimit_mps, 7);
    double hardest_mps2 = 0.0;
    double fastest_opening_mps = 0.0;
    while (track.time_s() < 60.0) {
        track.step();
        for (int k = 1; k < 8; ++k) hardest_mps2 = std::min(hardest_mps2, track.vehicle(0, k).acceleration_mps2);
        fastest_opening_mps =
            std::max(fastest_opening_mps, track.vehicle(0, 3).speed_mps - track.vehicle(0, 4).speed_mps);
    }
    EXPECT_GT(hardest_mps2, -2.0);
    EXPECT_LT(fastest_opening_mps, 2.0);
    EXPECT_GT(fastest_opening_mps, 1.0);
    EXPECT_NEAR(track.vehicle(0, 4).gap_m, 2.95 + kTimeGap_s * track.vehicle(0, 4).speed_mps, 0.5);
    EXPECT_NEAR(track.vehicle(0, 5).gap_m, 2.95, 0.5);
}

Model small_grid(const std::string& population, const std::string& max_vehicles) {
    return build_model(
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/coordination_grid.yaml",
                      {"network.grid.columns=2", "network.grid.rows=2", "measure.baseline=" + population,
                       "populations=[" + population + "]", "driver.platoon.max_vehicles=" + max_vehicles}),
        0);
}

std::uint64_t hash_after(const Model& model, int threads, double duration_s) {
    Simulation simulation(model, threads);
    simulation.run_until(duration_s);
    EXPECT_TRUE(simulation.state().records.violations.none());
    return simulation.state_hash();
}

TEST(MesoPlatoons, ThreadsAndVectorsDoNotChangeTheRun) {
    Model model = small_grid("CDG", "5");
    const std::uint64_t hash = hash_after(model, 1, 400.0);
    EXPECT_EQ(hash, hash_after(model, 4, 400.0));
    model.scalar_kernels = true;
    EXPECT_EQ(hash, hash_after(model, 1, 400.0));
    EXPECT_NE(hash, hash_after(small_grid("CDG", "none"), 1, 400.0));
}

TEST(MesoPlatoons, ALimitDoesNotChangePoliciesWithATimeGap) {
    EXPECT_EQ(hash_after(small_grid("CTG-Ref", "5"), 1, 200.0), hash_after(small_grid("CTG-Ref", "none"), 1, 200.0));
}

}  // namespace
}  // namespace stopline
