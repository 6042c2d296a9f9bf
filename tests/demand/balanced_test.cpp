// Tests of balanced draws: the order is random, but every 20 vehicles have the given shares.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "demand/demand_plan.h"

namespace stopline {
namespace {

DemandPlan plan_of(const std::vector<double>& shares, std::uint64_t seed = 1) {
    DemandPlan plan;
    plan.pattern = plan.route_pattern = DemandPlan::Pattern::balanced;
    plan.seed = seed;
    DemandPlan::Inlet inlet;
    for (int k = 0; k < static_cast<int>(shares.size()); ++k) {
        plan.policies.push_back(k);
        inlet.routes.push_back(k);
    }
    inlet.shares = plan.policy_shares = shares;
    plan.inlets = {inlet, inlet};
    return plan;
}

TEST(BalancedDraw, KeepsTheSharesInEveryTwentyVehicles) {
    for (const std::vector<double>& shares : {std::vector{0.5, 0.5}, {0.05, 0.95}, {0.37, 0.63}, {0.3, 0.1, 0.6}}) {
        const DemandPlan plan = plan_of(shares);
        std::vector<double> total(shares.size(), 0.0);
        for (std::int64_t block = 0; block < 200; ++block) {
            std::vector<double> drawn(shares.size(), 0.0);
            for (std::int64_t k = 20 * block; k < 20 * (block + 1); ++k) {
                drawn[static_cast<std::size_t>(plan.route_of(0, k))] += 1.0;
            }
            for (std::size_t c = 0; c < shares.size(); ++c) {
                ASSERT_LE(std::fabs(drawn[c] - 20.0 * shares[c]), 1.0 + 1e-9) << "block " << block;
                total[c] += drawn[c];
            }
        }
        for (std::size_t c = 0; c < shares.size(); ++c) EXPECT_NEAR(total[c] / 4000.0, shares[c], 0.005);
    }
}

TEST(BalancedDraw, HasARandomOrder) {
    const DemandPlan plan = plan_of({0.5, 0.5});
    int changes = 0;
    for (std::int64_t k = 1; k < 4000; ++k) changes += plan.route_of(0, k) != plan.route_of(0, k - 1) ? 1 : 0;
    EXPECT_NEAR(changes, 2100, 150) << "alternating would give 4000";
}

TEST(BalancedDraw, DiffersBetweenInletsSeedsAndPurposes) {
    const DemandPlan first = plan_of({0.5, 0.5});
    const DemandPlan second = plan_of({0.5, 0.5}, 2);
    int equal_inlets = 0;
    int equal_seeds = 0;
    int equal_purposes = 0;
    for (std::int64_t k = 0; k < 2000; ++k) {
        equal_inlets += first.route_of(0, k) == first.route_of(1, k) ? 1 : 0;
        equal_seeds += first.route_of(0, k) == second.route_of(0, k) ? 1 : 0;
        equal_purposes += first.route_of(0, k) == first.policy_of(0, k) ? 1 : 0;
    }
    for (const int count : {equal_inlets, equal_seeds, equal_purposes}) EXPECT_NEAR(count, 1000, 150);
}

}  // namespace
}  // namespace stopline
