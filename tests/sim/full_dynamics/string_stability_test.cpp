// Measures how a disturbance travels through a platoon. The speed of the platoon leader oscillates. The ratio of each
// follower's amplitude to that of its leader is measured at the end of the platoon.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "base/units.h"
#include "support/track.h"

namespace stopline {
namespace {

using namespace testing_support;

constexpr double kMean_mps = 11.0;
constexpr double kAmplitude_mps = 0.3;
constexpr int kFollowers = 8;
constexpr double kFront_m = 400.0;
constexpr double kFrequencies_radps[] = {0.2, 0.4, 0.6, 0.8, 1.1, 1.4, 2.0};

// The amplitude of an oscillation at one frequency, from samples of whole periods.
class Amplitude {
public:
    void add(double value, double phase) {
        cosine_ += value * std::cos(phase);
        sine_ += value * std::sin(phase);
        ++count_;
    }
    double value() const { return 2.0 * std::hypot(cosine_, sine_) / count_; }

private:
    double cosine_ = 0.0;
    double sine_ = 0.0;
    int count_ = 0;
};

struct Case {
    const char* policy;
    const char* v2v_delay;
    // Limits of the amplification per vehicle, at the frequency at which the amplification is largest.
    double min_amplification, max_amplification;
};

// Linear analysis for a lag of 0.3 s: for CDG the amplification is 1.02 with a V2V delay of 20 ms, and 1.09 with 100
// ms. A longer lag, such as that of lorries, gives less. For a time gap it is below 1 if the time gap exceeds 0.25 s
// (delay of 20 ms) or 0.64 s (100 ms).
const Case kCases[] = {
    {"CDG", "20 ms", 1.01, 1.03},
    {"CDG", "100 ms", 1.03, 1.10},
    {"CTG-Ref", "20 ms", 0.0, 1.0},
    {"CTG-Ref", "100 ms", 0.0, 1.0},
};

Track oscillating_platoons(const Case& c, const std::string& vehicle) {
    TrackPlan plan;
    plan.policy = c.policy;
    plan.vehicle = vehicle;
    plan.lanes = static_cast<int>(std::size(kFrequencies_radps));
    plan.length_m = 4000.0;
    plan.overrides = {std::string("driver.cacc.v2v_delay=") + c.v2v_delay};
    Track track(plan);
    for (int k = 0; k < plan.lanes; ++k) track.place_platoon(2 * k, kFront_m, kMean_mps, kFollowers);
    return track;
}

// Prescribes the motion of a platoon leader. The amplitude grows slowly from 0, so that no sudden change excites the
// platoon.
void drive_oscillating_leader(Track& track, int lane, double w) {
    constexpr double kLag_s = 0.2;
    const double t = track.time_s();
    const double amplitude_mps = kAmplitude_mps * std::min(1.0, t / 20.0);
    const double a = amplitude_mps * w * std::cos(w * t);
    const double jerk = -amplitude_mps * w * w * std::sin(w * t);
    track.drive(lane, 0, kFront_m + kMean_mps * t + amplitude_mps / w * (1.0 - std::cos(w * t)),
                kMean_mps + amplitude_mps * std::sin(w * t), a, a + kLag_s * jerk, kLag_s);
}

// Returns the amplification per vehicle at each frequency. It is measured on the last vehicles, where the transient of
// the first follower has died out.
std::vector<double> amplifications(Track& track) {
    constexpr double kFrom_s = 90.0;
    constexpr double kWindow_s = 95.0;
    constexpr int kLast = 4;
    std::vector<std::vector<Amplitude>> amplitudes(std::size(kFrequencies_radps),
                                                   std::vector<Amplitude>(kFollowers + 1));
    while (track.time_s() < kFrom_s + kWindow_s) {
        for (std::size_t k = 0; k < amplitudes.size(); ++k) {
            const int lane = static_cast<int>(2 * k);
            const double w = kFrequencies_radps[k];
            drive_oscillating_leader(track, lane, w);
            const double whole_periods_s = std::floor(kWindow_s * w / (2.0 * kPi)) * 2.0 * kPi / w;
            if (track.time_s() < kFrom_s || track.time_s() >= kFrom_s + whole_periods_s) continue;
            for (int n = 0; n <= kFollowers; ++n) {
                amplitudes[k][at(n)].add(track.vehicle(lane, n).speed_mps, w * track.time_s());
            }
        }
        track.step();
    }
    std::vector<double> result;
    for (const std::vector<Amplitude>& platoon : amplitudes) {
        result.push_back(std::pow(platoon[kFollowers].value() / platoon[kFollowers - kLast].value(), 1.0 / kLast));
    }
    return result;
}

class SlowStringStability : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(EveryVehicle, SlowStringStability, testing::ValuesIn(data_names("vehicles")), as_name);

TEST_P(SlowStringStability, AmplificationAgreesWithLinearAnalysis) {
    for (const Case& c : kCases) {
        Track track = oscillating_platoons(c, GetParam());
        const std::vector<double> by_frequency = amplifications(track);
        const double largest = *std::max_element(by_frequency.begin(), by_frequency.end());
        EXPECT_GT(largest, c.min_amplification) << c.policy << ", V2V " << c.v2v_delay;
        EXPECT_LT(largest, c.max_amplification) << c.policy << ", V2V " << c.v2v_delay;
        std::printf("%s, V2V %s: largest amplification per vehicle %.3f;", c.policy, c.v2v_delay, largest);
        for (const double value : by_frequency) std::printf(" %.3f", value);
        std::printf("\n");
    }
}

}  // namespace
}  // namespace stopline
