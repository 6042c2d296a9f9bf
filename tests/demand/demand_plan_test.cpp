// Tests of the demand plan: shares of policies and routes. A draw depends only on seed, inlet and vehicle number.
#include "demand/demand_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace stopline {
namespace {

constexpr int kVehicles = 20'000;

DemandPlan mix(DemandPlan::Pattern pattern, std::vector<double> shares) {
    DemandPlan plan;
    plan.pattern = pattern;
    for (std::size_t k = 0; k < shares.size(); ++k) plan.policies.push_back(static_cast<int>(k));
    plan.policy_shares = std::move(shares);
    plan.inlets.push_back({0, kVehicles, {0}, {1.0}});
    plan.inlets.push_back({1, kVehicles, {1, 2, 3}, {0.7, 0.1, 0.2}});
    return plan;
}

TEST(AlternatingMix, OfTwoHalvesStartsWithTheFirst) {
    const DemandPlan plan = mix(DemandPlan::Pattern::alternating, {0.5, 0.5});
    for (std::int64_t k = 0; k < 200; ++k) EXPECT_EQ(plan.policy_of(0, k), k % 2) << k;
}

TEST(AlternatingMix, KeepsTheSharesInEveryPrefix) {
    for (const std::vector<double>& shares : {std::vector{0.5, 0.5},
                                              {0.25, 0.75},
                                              {0.9, 0.1},
                                              {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0},
                                              {0.2, 0.3, 0.5},
                                              {1.0, 0.0}}) {
        const DemandPlan plan = mix(DemandPlan::Pattern::alternating, shares);
        std::vector<double> drawn(shares.size(), 0.0);
        for (std::int64_t k = 0; k < 300; ++k) {
            drawn[static_cast<std::size_t>(plan.policy_of(0, k))] += 1.0;
            for (std::size_t c = 0; c < shares.size(); ++c) {
                const double expected = shares[c] * static_cast<double>(k + 1);
                ASSERT_LT(std::fabs(drawn[c] - expected), 1.0 + 1e-9)
                    << "after " << k + 1 << " vehicles, component " << c;
            }
        }
    }
}

TEST(RandomMix, RealisesTheSharesWithinSamplingError) {
    for (const std::vector<double>& shares : {std::vector{0.5, 0.5}, {0.05, 0.95}, {0.2, 0.3, 0.5}}) {
        const DemandPlan plan = mix(DemandPlan::Pattern::random, shares);
        std::vector<double> drawn(shares.size(), 0.0);
        for (std::int64_t k = 0; k < kVehicles; ++k) drawn[static_cast<std::size_t>(plan.policy_of(0, k))] += 1.0;
        for (std::size_t c = 0; c < shares.size(); ++c) {
            const double deviation = std::sqrt(kVehicles * shares[c] * (1.0 - shares[c]));
            EXPECT_NEAR(drawn[c], kVehicles * shares[c], 4.0 * deviation) << c;
        }
    }
}

// With two equal shares and independent draws, the policy of n successive vehicles changes n / 2 times on average.
TEST(RandomMix, DoesNotAlternate) {
    const DemandPlan plan = mix(DemandPlan::Pattern::random, {0.5, 0.5});
    double changes = 0.0;
    for (std::int64_t k = 1; k < kVehicles; ++k)
        changes += plan.policy_of(0, k) != plan.policy_of(0, k - 1) ? 1.0 : 0.0;
    EXPECT_NEAR(changes, 0.5 * kVehicles, 4.0 * std::sqrt(0.25 * kVehicles));
}

TEST(RandomMix, DoesNotDependOnTheQueryOrder) {
    const DemandPlan plan = mix(DemandPlan::Pattern::random, {0.3, 0.7});
    std::vector<int> forward;
    for (std::int64_t k = 0; k < 1000; ++k) forward.push_back(plan.policy_of(1, k));
    for (std::int64_t k = 999; k >= 0; --k) {
        plan.route_of(1, k);
        plan.policy_of(0, k);
        EXPECT_EQ(plan.policy_of(1, k), forward[static_cast<std::size_t>(k)]);
    }
}

// Returns the share of vehicles to which two plans give different policies.
double difference(const DemandPlan& a, int inlet_a, const DemandPlan& b, int inlet_b) {
    double different = 0.0;
    for (std::int64_t k = 0; k < kVehicles; ++k)
        different += a.policy_of(inlet_a, k) != b.policy_of(inlet_b, k) ? 1.0 : 0.0;
    return different / kVehicles;
}

TEST(RandomMix, DiffersBetweenSeedsAndInletsAndAgreesWithItself) {
    const DemandPlan plan = mix(DemandPlan::Pattern::random, {0.5, 0.5});
    DemandPlan other = plan;
    other.seed = 2;
    EXPECT_EQ(difference(plan, 0, plan, 0), 0.0);
    EXPECT_NEAR(difference(plan, 0, other, 0), 0.5, 0.02);
    EXPECT_NEAR(difference(plan, 0, plan, 1), 0.5, 0.02);
}

TEST(Routes, HaveTheirSharesAndAreIndependentOfThePolicy) {
    const DemandPlan plan = mix(DemandPlan::Pattern::random, {0.5, 0.5});
    std::vector<std::vector<double>> drawn(2, std::vector<double>(4, 0.0));
    for (std::int64_t k = 0; k < kVehicles; ++k) {
        EXPECT_EQ(plan.route_of(0, k), 0);
        drawn[static_cast<std::size_t>(plan.policy_of(1, k))][static_cast<std::size_t>(plan.route_of(1, k))] += 1.0;
    }
    const std::vector<double> shares{0.0, 0.7, 0.1, 0.2};
    for (const std::vector<double>& of_policy : drawn) {
        for (std::size_t r = 0; r < shares.size(); ++r) {
            const double share = 0.5 * shares[r];
            EXPECT_NEAR(of_policy[r], kVehicles * share, 4.0 * std::sqrt(kVehicles * share * (1.0 - share)) + 1e-9);
        }
    }
}

TEST(SinglePolicy, AppliesToEveryVehicle) {
    const DemandPlan plan = mix(DemandPlan::Pattern::random, {1.0});
    for (std::int64_t k = 0; k < 100; ++k) EXPECT_EQ(plan.policy_of(0, k), 0);
}

}  // namespace
}  // namespace stopline
