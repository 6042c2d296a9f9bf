// Compares queue discharge with ideal followers, which keep the gap law behind the same leader without error or delay.
// The difference is the loss by controllers and powertrains.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr int kQueue = 30;
constexpr double kGreen_s = 5.0;
constexpr double kRun_s = 45.0;

struct Discharge {
    std::vector<double> leader_m;    // [step since green] front of the platoon leader past the stop line
    std::vector<double> passages_s;  // [vehicle] passage of the stop line, since the start of green
    double step_s, length_m;
};

Discharge discharge(const std::string& policy) {
    TrackPlan plan;
    plan.policy = policy;
    plan.exit_m = 1500.0;
    plan.green_from_s = kGreen_s;
    Track track(plan);
    const double front_m = plan.length_m - track.model().common_driver().stop.margin_m;
    track.place_platoon(0, front_m, 0.0, kQueue);
    Discharge result{{}, {}, track.step_s(), track.model().vehicles[0].length_m};
    while (track.time_s() < kGreen_s + kRun_s) {
        if (track.time_s() > kGreen_s - 0.5 * track.step_s()) {
            const bool passed = track.count(1) > 0;
            result.leader_m.push_back(passed ? track.vehicle(1, 0).position_m
                                             : track.vehicle(0, 0).position_m - plan.length_m);
        }
        track.step();
    }
    for (const Passage& passage : track.state().records.passages) {
        if (passage.from_lane == 0) result.passages_s.push_back(passage.time_s - kGreen_s);
    }
    return result;
}

// Returns the times at which the vehicles of an ideal platoon pass the stop line behind the same platoon leader. With
// standstill gap r and time gap h, the gap law gap(v) = r + h v gives the speed v = dx/dt = (gap - r) / h.
std::vector<double> ideal_passages_s(const Discharge& d, double r_m, double h_s) {
    std::vector<double> leader_m = d.leader_m;
    std::vector<double> passages;
    for (int n = 0; n <= kQueue; ++n) {
        if (n > 0) {
            std::vector<double> own_m;
            double x = leader_m.front() - d.length_m - r_m;
            for (const double front_m : leader_m) {
                const double limit_m = front_m - d.length_m - r_m;
                // At limit_m the gap is r and the speed 0. Within one step the leader counts as stopped, so the
                // follower approaches limit_m exponentially with the time constant h.
                x = h_s > 0.0 ? limit_m + (x - limit_m) * std::exp(-d.step_s / h_s) : limit_m;
                own_m.push_back(x);
            }
            leader_m = own_m;
        }
        for (std::size_t k = 1; k < leader_m.size(); ++k) {
            if (leader_m[k] < 0.0) continue;
            const double share = leader_m[k] / (leader_m[k] - leader_m[k - 1]);
            passages.push_back((static_cast<double>(k) - share) * d.step_s);
            break;
        }
    }
    return passages;
}

int count_until(const std::vector<double>& times, double limit_s) {
    return static_cast<int>(std::count_if(times.begin(), times.end(), [&](double t) { return t <= limit_s; }));
}

void expect_near_ideal(const char* policy, double r_m, double h_s, double allowed_s) {
    const Discharge d = discharge(policy);
    const std::vector<double> ideal = ideal_passages_s(d, r_m, h_s);
    const std::size_t n = std::min(ideal.size(), d.passages_s.size());
    ASSERT_GE(n, 20u);
    double largest_s = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
        const double late_s = d.passages_s[k] - ideal[k];
        EXPECT_NEAR(late_s, 0.0, allowed_s) << policy << ", vehicle " << k + 1;
        if (std::fabs(late_s) > std::fabs(largest_s)) largest_s = late_s;
    }
    EXPECT_NEAR(count_until(d.passages_s, 15.0), count_until(ideal, 15.0), 1) << policy;
    EXPECT_NEAR(count_until(d.passages_s, 30.0), count_until(ideal, 30.0), 1) << policy;
    std::printf("%s: %d vehicles in 15 s, ideal %d; largest difference from an ideal passage %+.3f s\n", policy,
                count_until(d.passages_s, 15.0), count_until(ideal, 15.0), largest_s);
}

// Each vehicle starts 20 ms (the V2V delay) later than its leader, and makes up for this delay while driving.
TEST(IdealFollower, IsMatchedByConstantDistance) { expect_near_ideal("CDG", 2.95, 0.0, 0.25); }
TEST(IdealFollower, IsMatchedByConstantTimeGap) { expect_near_ideal("CTG-Ref", 2.95, 0.87, 0.45); }
TEST(IdealFollower, IsMatchedByALargerTimeGap) { expect_near_ideal("CTG-HBS", 2.95, 1.22, 0.45); }

}  // namespace
}  // namespace stopline
