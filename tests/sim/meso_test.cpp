// Conformance of every policy's mesoscale model, at several steps: equilibrium, no collision, stop at red, speeds within bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kLine_m = 900.0;

using Conformance = testing::TestWithParam<std::tuple<std::string, double, const char*>>;

TrackPlan meso_plan(const std::string& policy, double step_s, double dawdling = 0.0,
                    const std::string& parameters = "table2") {
    TrackPlan plan;
    plan.policy = policy;
    plan.length_m = kLine_m;
    plan.overrides = {"fidelity=meso", "meso={base: " + parameters + ", step: " +
                                           std::to_string(static_cast<int>(std::lround(1e3 * step_s))) + " ms}"};
    if (dawdling >= 0.0) {
        const std::string value = std::to_string(dawdling);
        plan.overrides.push_back("meso.constant_time.dawdling=" + value);
        plan.overrides.push_back("meso.constant_distance.dawdling=" + value);
    }
    return plan;
}

std::vector<std::string> policy_names() {
    std::vector<std::string> names;
    for (const GapPolicySettings& policy : load_policies()) names.push_back(policy.name);
    return names;
}

class MesoModel : public Conformance {
protected:
    const std::string& policy() const { return std::get<0>(GetParam()); }
    double step_s() const { return std::get<1>(GetParam()); }
    TrackPlan plan(double dawdling = 0.0) const {
        return meso_plan(policy(), step_s(), dawdling, std::get<2>(GetParam()));
    }
    static Model dawdling_like(Model model, double sigma) {
        for (Krauss& krauss : model.krauss) krauss.dawdling = sigma;
        return model;
    }
    // What the policy adds to its standstill gap above a switching speed.
    static double more_m(const Model& model, double speed_mps) {
        const GapPolicySettings& s = model.policies[0].settings;
        return model.krauss[0].constant_distance ? equilibrium_gap_m(s, speed_mps) - s.standstill_gap_m : 0.0;
    }
};
INSTANTIATE_TEST_SUITE_P(EveryPolicy, MesoModel,
                         testing::Combine(testing::ValuesIn(policy_names()), testing::Values(0.05, 0.1, 0.2),
                                          testing::Values("table2", "fitted", "passages")),
                         [](const testing::TestParamInfo<MesoModel::ParamType>& setting) {
                             std::string name = std::get<0>(setting.param);
                             std::replace_if(
                                 name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
                             return name + "_" + std::to_string(static_cast<int>(1e3 * std::get<1>(setting.param))) +
                                    "ms_" + std::get<2>(setting.param);
                         });

TEST_P(MesoModel, SettlesInTheEquilibriumGap) {
    for (const double kmh : {10.0, 25.0, 40.0, 47.0}) {
        Track track(this->plan());
        const double v = kmh / 3.6;
        const double expected_m = track.model().krauss[0].equilibrium_gap_m(v) + more_m(track.model(), v);
        // From twice the gap: the band's own equilibria lie below.
        track.place(0, 100.0, v);
        track.place(0, 100.0 - track.model().vehicles[0].length_m - 2.0 * expected_m, v);
        double front_m = 100.0;
        while (front_m < kLine_m - 20.0) {
            track.drive(0, 0, front_m, v, 0.0, 0.0, 0.2);
            track.step();
            front_m += v * track.step_s();
        }
        const double gap_m = front_m - track.model().vehicles[0].length_m - track.seen(0, 1).position_m;
        EXPECT_NEAR(gap_m, expected_m, 1e-3) << kmh << " km/h";
        EXPECT_NEAR(track.seen(0, 1).speed_mps, v, 0.01) << kmh << " km/h";
    }
}

// From every state from which the model's own braking avoids a collision, behind a leader that brakes as hard as the model
// reckons with and then stands.
TEST_P(MesoModel, NeverCollidesFromAFeasibleState) {
    const Model model = build_model(scenario_of(this->plan()), 0);
    for (const double own_kmh : {5.0, 20.0, 35.0, 50.0}) {
        for (const double ahead_kmh : {0.0, 10.0, 30.0, 50.0}) {
            for (const double spare_m : {0.0, 0.3, 2.0, 20.0}) {
                for (const double dawdling : {0.0, 0.4}) {
                    Track track(dawdling_like(model, dawdling));
                    const Krauss& krauss = track.model().krauss[0];
                    const double b = krauss.deceleration_mps2;
                    const double own = own_kmh / 3.6;
                    double ahead = ahead_kmh / 3.6;
                    const double tau = std::max(krauss.reaction_s, step_s());
                    const double needed_m =
                        std::max(own * tau + (own * own - ahead * ahead) / (2.0 * b), 0.0) + more_m(track.model(), own);
                    double front_m = 300.0;
                    const double gap_m = krauss.standstill_gap_m + krauss.band_m + needed_m + spare_m;
                    track.place(0, front_m, ahead);
                    track.place(0, front_m - track.model().vehicles[0].length_m - gap_m, own);
                    for (int k = 0; k < 400; ++k) {
                        track.drive(0, 0, front_m, ahead, 0.0, 0.0, 0.2);
                        track.step();
                        ahead = std::max(ahead - b * track.step_s(), 0.0);
                        front_m += ahead * track.step_s();
                        ASSERT_GE(track.seen(0, 1).gap_m, 0.0)
                            << own_kmh << " behind " << ahead_kmh << " km/h, " << spare_m << " m to spare";
                        ASSERT_GE(track.seen(0, 1).speed_mps, 0.0);
                    }
                }
            }
        }
    }
}

TEST_P(MesoModel, StopsAtRedFromEveryFeasibleState) {
    TrackPlan plan = this->plan();
    plan.green_from_s = kForever_s;
    const Model model = build_model(scenario_of(plan), 0);
    for (const double kmh : {5.0, 20.0, 35.0, 50.0}) {
        for (const double spare_m : {0.0, 0.5, 5.0, 60.0, 300.0}) {
            for (const double dawdling : {0.0, 0.4}) {
                Track track(dawdling_like(model, dawdling));
                const Krauss& krauss = track.model().krauss[0];
                const double v = kmh / 3.6;
                const double tau = std::max(krauss.reaction_s, step_s());
                const double room_m = v * tau + v * v / (2.0 * krauss.deceleration_mps2);
                const double line_m = kLine_m - track.model().driver.stop.margin_m;
                track.place(0, line_m - room_m - spare_m, v);
                track.run(120.0);
                ASSERT_EQ(track.count(0), 1) << kmh << " km/h, " << spare_m << " m to spare";
                EXPECT_LE(track.seen(0, 0).position_m, kLine_m);
                EXPECT_GT(track.seen(0, 0).position_m, line_m - 1.0);
                EXPECT_LT(track.seen(0, 0).speed_mps, 0.05);
            }
        }
    }
}

TEST_P(MesoModel, AQueueStartsAndStopsWithoutCollision) {
    for (const double dawdling : {-1.0, 0.0, 1.0}) {
        TrackPlan plan = this->plan(dawdling);
        plan.green_from_s = 2.0;
        plan.green_s = 12.0;
        Track track(plan);
        double front_m = kLine_m - track.model().driver.stop.margin_m;
        for (int k = 0; k < 40; ++k) {
            track.place(0, front_m, 0.0);
            front_m -= track.model().vehicles[0].length_m + track.model().krauss[0].equilibrium_gap_m(0.0);
        }
        track.run(60.0);
        EXPECT_LT(track.count(0), 40);
        EXPECT_GT(track.count(0), 15);
    }
}

TEST(MesoFreeDriving, AcceleratesEvenlyUpToTheLeadersShareOfTheLimit) {
    Track track(meso_plan("CTG-Ref", 0.1));
    track.place(0, 10.0, 0.0);
    for (int k = 1; k <= 150; ++k) {
        track.step();
        const double expected = std::min(1.7 * 0.1 * k, 0.95 * 50.0 / 3.6);
        ASSERT_NEAR(track.seen(0, 0).speed_mps, expected, 1e-9);
    }
}

TEST(MesoFreeDriving, DawdlesAsMuchAsSigmaSays) {
    double lost_mps = 0.0;
    constexpr int kVehicles = 40;
    TrackPlan plan = meso_plan("CTG-Ref", 0.1, 0.4);
    plan.lanes = kVehicles;
    plan.limit_mps = 40.0;
    Track track(plan);
    for (int k = 0; k < kVehicles; ++k) track.place(2 * k, 10.0, 5.0);
    track.run(10.0);
    for (int k = 0; k < kVehicles; ++k) lost_mps += (5.0 + 1.7 * 10.0 - track.seen(2 * k, 0).speed_mps) / kVehicles;
    // Half of sigma a dt a step on average; 100 steps of 40 vehicles: standard error 0.006 m/s.
    EXPECT_NEAR(lost_mps, 0.5 * 0.4 * 1.7 * 10.0, 0.03);
}

constexpr const char* kPopulations =
    "[CDG, CTG-Ref, SWITCH-2, {name: two, components: [{policy: CDG, share: 50 %}, {policy: CTG-Ref, share: 50 %}]}, "
    "{name: three, components: [{policy: SWITCH-1, share: 40 %}, {policy: CTG-Ref, share: 30 %}, {policy: CDG, share: 30 %}]}]";

Model mixed_model(const std::string& population) {
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml",
                      {"fidelity=meso", "demand.left=15 %", "demand.right=10 %", "meso.constant_distance.dawdling=0.2",
                       "meso.start_relay_vehicles=4", "meso.constant_time.gap_tracking=1",
                       "meso.leader_profile={2 km/h: 2 m/s2, 20 km/h: 0.5 m/s2, 40 km/h: 1 m/s2}",
                       std::string("populations=") + kPopulations});
    const auto named = [&](const PopulationSettings& p) { return p.name == population; };
    const auto found = std::find_if(scenario.populations.begin(), scenario.populations.end(), named);
    return build_model(scenario, static_cast<std::size_t>(found - scenario.populations.begin()));
}

void expect_same_bits(const Model& model, const Model& other) {
    Simulation one(model);
    Simulation two(other);
    for (int k = 1; k <= 20; ++k) {
        one.run_until(10.0 * k);
        two.run_until(10.0 * k);
        ASSERT_EQ(one.state_hash(), two.state_hash()) << "at " << 10 * k << " s";
    }
    EXPECT_TRUE(one.state().records.violations.none());
}

// The compiler's vectors and one vehicle at a time, with mixed policies.
TEST(MesoKernels, GiveTheSameBitsAsOneVehicleAtATime) {
    for (const char* const population : {"CDG", "two", "CTG-Ref", "SWITCH-2", "three"}) {
        SCOPED_TRACE(population);
        const Model fast = mixed_model(population);
        Model slow = fast;
        slow.scalar_kernels = true;
        expect_same_bits(fast, slow);
    }
}

// Where no policy has a transient gap, leaders take the safe speed of followers; with one too small to matter they have their own.
TEST(MesoKernels, LeadersAreAsSafeAsFollowersWithoutTransientGap) {
    for (const char* const population : {"CDG", "two", "CTG-Ref", "three"}) {
        SCOPED_TRACE(population);
        Model without = mixed_model(population);
        Model with = without;
        for (Krauss& krauss : without.krauss) krauss.transient_gap_s2 = 0.0;
        for (Krauss& krauss : with.krauss) krauss.transient_gap_s2 = 1e-30;
        expect_same_bits(without, with);
    }
}

}  // namespace
}  // namespace stopline
