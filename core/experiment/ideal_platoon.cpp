#include "experiment/ideal_platoon.h"

#include <algorithm>
#include <cmath>

#include "sim/model.h"

namespace stopline {

namespace {

double speed_at(std::span<const SpeedSample> samples, double time_s) {
    const auto after = std::upper_bound(samples.begin(), samples.end(), time_s,
                                        [](double time, const SpeedSample& sample) { return time < sample.time_s; });
    if (after == samples.begin()) return samples.empty() ? 0.0 : samples.front().speed_mps;
    const auto before = after - 1;
    if (after == samples.end()) return before->speed_mps;
    const double share = (time_s - before->time_s) / (after->time_s - before->time_s);
    return before->speed_mps + share * (after->speed_mps - before->speed_mps);
}

// The speed v >= 0 with v dt + gap(v) = room, by Newton's steps from `guess_mps`: exact on each straight piece of a gap law.
double speed_that_keeps(const GapPolicySettings& policy, const GapLaw& law, double room_m, double guess_mps) {
    double speed_mps = guess_mps;
    constexpr int kSteps = 20;
    for (int k = 0; k < kSteps; ++k) {
        double gap_m = 0.0;
        double slope_s = 0.0;
        law.evaluate(policy, {&speed_mps, 1}, {&gap_m, 1}, {&slope_s, 1});
        const double better_mps =
            std::max(speed_mps - (speed_mps * kIdealStep_s + gap_m - room_m) / (kIdealStep_s + slope_s), 0.0);
        if (std::abs(better_mps - speed_mps) < 1e-12) break;
        // Over a bend of the law the step back may lead to where it came from.
        speed_mps = k < kSteps / 2 ? better_mps : 0.5 * (speed_mps + better_mps);
    }
    return speed_mps;
}

}  // namespace

std::vector<double> ideal_passages_s(std::span<const SpeedSample> leader,
                                     const std::vector<const GapPolicySettings*>& policies, double length_m,
                                     double to_line_m, double until_s) {
    const std::size_t vehicles = policies.size();
    std::vector<double> front_m(vehicles, -to_line_m);
    std::vector<double> speed_mps(vehicles, 0.0);
    std::vector<const GapLaw*> laws(vehicles);
    for (std::size_t i = 0; i < vehicles; ++i) {
        laws[i] = &find_gap_law(policies[i]->law);
        if (i > 0) front_m[i] = front_m[i - 1] - length_m - equilibrium_gap_m(*policies[i], 0.0);
    }
    std::vector<double> passages_s;
    const auto steps = static_cast<std::int64_t>(std::floor(until_s / kIdealStep_s));
    for (std::int64_t step = 0; step < steps && passages_s.size() < vehicles; ++step) {
        const double now_s = static_cast<double>(step) * kIdealStep_s;
        for (std::size_t i = 0; i < vehicles; ++i) {
            if (i == 0) {
                speed_mps[i] = speed_at(leader, now_s + 0.5 * kIdealStep_s);
            } else {
                const double room_m = front_m[i - 1] - length_m - front_m[i];
                speed_mps[i] = speed_that_keeps(*policies[i], *laws[i], room_m, speed_mps[i]);
            }
            const double before_m = front_m[i];
            front_m[i] += speed_mps[i] * kIdealStep_s;
            if (before_m < 0.0 && front_m[i] >= 0.0) passages_s.push_back(now_s - before_m / speed_mps[i]);
        }
    }
    return passages_s;
}

}  // namespace stopline
