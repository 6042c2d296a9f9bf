#include "runs/single_light/ideal_platoon.h"

#include <algorithm>
#include <cmath>

#include "sim/state/model.h"

namespace stopline {

namespace {

// Returns the speed of the leader at a time, interpolated between the samples, m/s.
double speed_at(std::span<const SpeedSample> samples, double time_s) {
    const auto after = std::upper_bound(samples.begin(), samples.end(), time_s,
                                        [](double time, const SpeedSample& sample) { return time < sample.time_s; });
    if (after == samples.begin()) return samples.empty() ? 0.0 : samples.front().speed_mps;
    const auto before = after - 1;
    if (after == samples.end()) return before->speed_mps;
    const double share = (time_s - before->time_s) / (after->time_s - before->time_s);
    return before->speed_mps + share * (after->speed_mps - before->speed_mps);
}

// Returns the speed v >= 0 with v dt + gap(v) = available_m, m/s (see ideal_platoon.h). Uses Newton steps from
// `guess_mps`. A Newton step is exact where the gap law is linear.
double gap_keeping_speed_mps(const GapPolicy& policy, double available_m, double guess_mps) {
    double speed_mps = guess_mps;
    constexpr int kSteps = 20;
    for (int k = 0; k < kSteps; ++k) {
        double gap_m = 0.0;
        double slope_s = 0.0;
        policy.evaluate({&speed_mps, 1}, {&gap_m, 1}, {&slope_s, 1});
        const double next_mps =
            std::max(speed_mps - (speed_mps * kIdealStep_s + gap_m - available_m) / (kIdealStep_s + slope_s), 0.0);
        if (std::abs(next_mps - speed_mps) < 1e-12) break;
        // At a kink of the gap law, Newton steps can alternate between two speeds, so later steps are halved.
        speed_mps = k < kSteps / 2 ? next_mps : 0.5 * (speed_mps + next_mps);
    }
    return speed_mps;
}

}  // namespace

std::vector<double> ideal_passages_s(std::span<const SpeedSample> leader, const std::vector<IdealVehicle>& vehicles,
                                     double to_line_m, double until_s) {
    const std::size_t count = vehicles.size();
    std::vector<double> front_m(count, -to_line_m);
    std::vector<double> speed_mps(count, 0.0);
    std::vector<GapPolicy> ready;
    for (std::size_t i = 0; i < count; ++i) {
        ready.push_back(make_gap_policy(*vehicles[i].policy));
        if (i > 0) front_m[i] = front_m[i - 1] - vehicles[i - 1].length_m - equilibrium_gap_m(ready[i], 0.0);
    }
    std::vector<double> passages_s;
    const auto steps = static_cast<std::int64_t>(std::floor(until_s / kIdealStep_s));
    for (std::int64_t step = 0; step < steps && passages_s.size() < count; ++step) {
        const double now_s = static_cast<double>(step) * kIdealStep_s;
        for (std::size_t i = 0; i < count; ++i) {
            if (i == 0) {
                speed_mps[i] = speed_at(leader, now_s + 0.5 * kIdealStep_s);
            } else {
                const double available_m = front_m[i - 1] - vehicles[i - 1].length_m - front_m[i];
                speed_mps[i] = gap_keeping_speed_mps(ready[i], available_m, speed_mps[i]);
            }
            const double last_m = front_m[i];
            front_m[i] += speed_mps[i] * kIdealStep_s;
            if (last_m < 0.0 && front_m[i] >= 0.0) passages_s.push_back(now_s - last_m / speed_mps[i]);
        }
    }
    return passages_s;
}

}  // namespace stopline
