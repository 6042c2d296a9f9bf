// Repeated runs, scalar kernels and vectorised kernels give the same bits with mixed policies and vehicles.
#include <gtest/gtest.h>

#include <vector>

#include "base/random.h"
#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

// Returns two lanes on a slope with all shipped vehicles and policies. The signal turns green, yellow and red.
Model mixed_model() {
    TrackPlan plan;
    plan.policy = "MIX";
    plan.lanes = 2;
    plan.length_m = 700.0;
    plan.exit_m = 300.0;
    plan.gradient = 0.03;
    plan.green_from_s = 6.0;
    plan.green_s = 20.0;
    Model model = build_model(scenario_of(plan), 0);
    model.vehicles.clear();
    for (const std::string& name : data_names("vehicles")) {
        model.vehicles.push_back(compile_powertrain(load_vehicle(name)));
    }
    model.policies.clear();
    for (const GapPolicySettings& policy : load_policies()) {
        model.policies.push_back(make_gap_policy(policy));
    }
    model.classes.assign(model.policies.size(), {});
    return model;
}

// Places a queue and approaching vehicles on each lane.
Track mixed_track(bool scalar) {
    Track track(mixed_model(), scalar);
    const auto types = static_cast<std::uint64_t>(track.model().vehicles.size());
    const auto policies = static_cast<std::uint64_t>(track.model().policies.size());
    for (std::uint64_t lane = 0; lane < 2; ++lane) {
        double position_m = 699.0;
        for (std::uint64_t k = 0; k < 30; ++k) {
            const auto type = static_cast<int>(random_bits(5, k, lane, Purpose::vehicle_type) % types);
            track.place(static_cast<int>(2 * lane), position_m, k < 20 ? 0.0 : 12.0,
                        static_cast<int>(random_bits(5, k, lane, Purpose::policy) % policies), type);
            position_m -= track.model().vehicles[at(type)].length_m + (k < 19 ? 3.05 : 17.0);
        }
    }
    return track;
}

// Runs for a minute. Returns the state hash of every 20th step.
std::vector<std::uint64_t> hashes(Track track) {
    std::vector<std::uint64_t> samples;
    while (track.time_s() < 60.0) {
        track.step();
        if (track.state().tick % 20 == 0) samples.push_back(track.simulation().state_hash());
    }
    return samples;
}

TEST(Determinism, RepeatedRunsGiveTheSameBits) { EXPECT_EQ(hashes(mixed_track(false)), hashes(mixed_track(false))); }

TEST(Determinism, ScalarKernelsGiveTheSameBits) {
    const std::vector<std::uint64_t> batches = hashes(mixed_track(false));
    const std::vector<std::uint64_t> scalar = hashes(mixed_track(true));
    for (std::size_t k = 0; k < batches.size(); ++k) {
        ASSERT_EQ(batches[k], scalar[k]) << "first difference before " << 0.2 * static_cast<double>(k + 1) << " s";
    }
}

TEST(Determinism, ScalarKernelsGiveTheSameBitsForEachVehicle) {
    for (const char* policy : {"CDG", "CTG-HBS", "SWITCH-2"}) {
        for (const std::string& vehicle : data_names("vehicles")) {
            TrackPlan plan;
            plan.policy = policy;
            plan.vehicle = vehicle;
            plan.length_m = 400.0;
            plan.green_from_s = 3.0;
            plan.green_s = 12.0;
            std::vector<std::uint64_t> final_hashes;
            for (const bool scalar : {false, true}) {
                plan.scalar = scalar;
                Track track(plan);
                track.place_platoon(0, 399.0, 0.0, 21);
                track.run(30.0);
                final_hashes.push_back(track.simulation().state_hash());
            }
            EXPECT_EQ(final_hashes[0], final_hashes[1]) << policy << " with " << vehicle;
        }
    }
}

TEST(Determinism, StateHashDetectsTheSmallestChangeOfPosition) {
    Track track = mixed_track(false);
    Track other = mixed_track(false);
    EXPECT_EQ(track.simulation().state_hash(), other.simulation().state_hash());
    double& position_m = other.mutable_state().vehicles.position_m[other.slot(2, 7)];
    position_m = std::nextafter(position_m, 0.0);
    EXPECT_NE(track.simulation().state_hash(), other.simulation().state_hash());
}

}  // namespace
}  // namespace stopline
