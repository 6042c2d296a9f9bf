// A car-following model that only this test knows. It shows that the mesoscale mode asks every question about a model
// through the trait CarFollowing and the family of the model.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "driver/krauss.h"
#include "sim/mesoscale/following_families.h"
#include "sim/mesoscale/meso_dynamics.h"
#include "sim/mesoscale/meso_kernels.inl"
#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

// A vehicle drives so that it reaches the position of its leader's rear, minus 3 m, after 2 s.
struct TwoSeconds {
    static constexpr std::array kNames{FollowingName{"two_seconds", "a model of this test"}};
    static constexpr double kStandstill_m = 3.0;
    static constexpr double kTime_s = 2.0;

    static TwoSeconds make(const FollowingSettings& /*settings*/, const MesoGap& /*gap*/) { return {}; }
    double equilibrium_gap_m(double speed_mps) const { return kStandstill_m + kTime_s * speed_mps; }
    double smallest_gap_m() const { return kStandstill_m; }
    FollowingBraking braking() const { return {2.0, 0.5}; }
    bool relays_starts() const { return false; }
    bool has_power_limit() const { return false; }
    bool leader_uses_following_speed() const { return true; }
    SumoFollowing in_sumo() const { return {"Krauss", 2.0, 2.0, kTime_s, kStandstill_m, 0.0, false}; }

    template <class R, class Random>
    static R following_speed_mps(const TwoSeconds&, const FollowingInputOf<R>& in, const Random&, double) {
        return (in.gap_m - kStandstill_m) * (1.0 / kTime_s);
    }
    template <class R>
    static R leader_speed_mps(const TwoSeconds&, const FollowingInputOf<R>&, const R& following_mps, bool, bool) {
        return following_mps;
    }
    template <bool power_limit, class R>
    static R desired_speed_mps(const TwoSeconds&, const FollowingInputOf<R>& in, const R& following_mps, double dt,
                               const R&) {
        return min_of(following_mps, R(in.speed_mps + 2.0 * dt));
    }
    template <class R, class Random>
    static R disturbed_speed_mps(const TwoSeconds&, const R& bounded_mps, const Random&, double) {
        return bounded_mps;
    }
};

const MesoKernels& two_seconds_kernels(bool /*scalar*/) {
    static const MesoKernels kKernels = kernels_of<double, TwoSeconds>("two_seconds");
    return kKernels;
}
const FollowingFamily kTwoSeconds = following_family<TwoSeconds>(TwoSeconds::kNames[0], two_seconds_kernels);

// Returns a model in which the vehicles of the last policy drive with TwoSeconds.
Model model_of(const std::string& population) {
    TrackPlan plan;
    plan.policy = population;
    plan.length_m = 600.0;
    plan.green_from_s = 2.0;
    plan.overrides = {"fidelity=meso"};
    Model model = build_model(scenario_of(plan), 0);
    model.following.back() = FollowingModel(kTwoSeconds, TwoSeconds());
    return model;
}

TEST(FollowingModel, AModelOfAnyKindDrives) {
    Track track(model_of("CTG-Ref"), true);
    track.place(0, 300.0, 10.0);
    track.place(0, 300.0 - track.model().vehicles[0].length_m - 40.0, 10.0);
    double front_m = 300.0;
    while (front_m < 590.0) {
        track.drive(0, 0, front_m, 10.0, 0.0, 0.0, 0.2);
        track.step();
        front_m += 10.0 * track.step_s();
    }
    EXPECT_NEAR(front_m - track.model().vehicles[0].length_m - track.vehicle(0, 1).position_m, 23.0, 0.1);
}

// CDG and the model of the test alternate in a queue. The queue starts, and no vehicle overlaps another one.
TEST(FollowingModel, ModelsMixInOneRun) {
    Track track(model_of("MIX"), true);
    ASSERT_EQ(track.model().following.size(), 2u);
    EXPECT_TRUE(track.model().following[0].is("constant_distance"));
    EXPECT_TRUE(track.model().following[1].is("two_seconds"));
    double front_m = 595.0;
    for (int k = 0; k < 20; ++k) {
        track.place(0, front_m, 0.0, k % 2);
        front_m -= track.model().vehicles[0].length_m + TwoSeconds::kStandstill_m;
    }
    track.run(40.0);
    EXPECT_LT(track.count(0), 15);
}

// Every registered model runs in the vectorised and in the scalar kernels, alone and beside others.
TEST(FollowingModel, EveryFamilyGivesTheSameBitsInAllKernels) {
    std::string all = "{name: ALL, components: [";
    std::string policies = "policies=[";
    std::vector<std::string> populations;
    const std::span<const FollowingFamily> families = following_families();
    for (const FollowingFamily& family : families) {
        const std::string name = "P" + std::to_string(populations.size());
        policies += "{name: " + name +
                    ", law: constant_time, standstill_gap: 2.95 m, time_gap: 1 s, mesoscale: " + family.text.name +
                    "},";
        all += "{policy: " + name + ", share: " + std::to_string(100.0 / static_cast<double>(families.size())) + " %},";
        populations.push_back(name);
    }
    populations.push_back(all + "]}");
    ASSERT_GE(families.size(), 4u);
    for (const std::string& population : populations) {
        SCOPED_TRACE(population);
        const Scenario scenario =
            load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml",
                          {"fidelity=meso", "meso=passages", policies + "]", "populations=[" + population + "]",
                           "measure.baseline=" + (population[0] == '{' ? "ALL" : population)});
        Model vectorised = build_model(scenario, 0);
        Model scalar = vectorised;
        scalar.scalar_kernels = true;
        Simulation first(vectorised);
        Simulation second(scalar);
        for (int k = 1; k <= 15; ++k) {
            first.run_until(10.0 * k);
            second.run_until(10.0 * k);
            ASSERT_EQ(first.state_hash(), second.state_hash()) << "at " << 10 * k << " s";
        }
        EXPECT_TRUE(first.state().records.violations.none());
        EXPECT_GT(first.state().insertion.next_id, 50);
    }
}

}  // namespace
}  // namespace stopline
