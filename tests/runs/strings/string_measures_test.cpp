// Tests of the measures of string stability with motions of known form.
#include "runs/strings/string_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "runs/strings/string_sweep.h"

namespace stopline {
namespace {

constexpr double kFrequency_radps = 2.0 * std::numbers::pi / 4.0;  // 400 steps a period

// A platoon whose vehicle k oscillates with the amplitude A gain^k and lags behind its leader by 0.3 rad.
PlatoonMotion oscillation(std::size_t vehicles, double amplitude_mps2, double gain) {
    PlatoonMotion motion;
    motion.vehicles = vehicles;
    motion.samples = 1200;
    motion.standstill_gap_m.assign(vehicles, 3.0);
    for (std::size_t k = 0; k < motion.samples; ++k) {
        for (std::size_t position = 0; position < vehicles; ++position) {
            const auto place = static_cast<double>(position);
            const double wave = std::sin(kFrequency_radps * static_cast<double>(k) * motion.step_s - 0.3 * place);
            motion.acceleration_mps2.push_back(static_cast<float>(amplitude_mps2 * std::pow(gain, place) * wave));
            motion.speed_mps.push_back(10.0F);
            motion.gap_m.push_back(position == 0 ? 0.0F : static_cast<float>(3.0 + 0.1 * place * wave));
            motion.gap_error_m.push_back(position == 0 ? 0.0F : static_cast<float>(0.1 * place * wave));
        }
    }
    return motion;
}

TEST(StringMeasures, OfAnOscillation) {
    const StringMeasures measures = measure_string(oscillation(6, 0.4, 1.2));
    ASSERT_EQ(measures.positions.size(), 6U);
    EXPECT_NEAR(measures.positions[0].l2_mps2, 0.4 / std::sqrt(2.0), 1e-4);
    EXPECT_NEAR(measures.positions[0].linf_mps2, 0.4, 1e-4);
    EXPECT_TRUE(std::isnan(measures.positions[0].linf_ratio));
    for (std::size_t k = 1; k < 6; ++k) {
        const PositionMeasures& one = measures.positions[k];
        const double from_head = std::pow(1.2, static_cast<double>(k));
        EXPECT_NEAR(one.l2_ratio, 1.2, 1e-4);
        EXPECT_NEAR(one.linf_ratio, 1.2, 1e-3);
        EXPECT_NEAR(one.l2_from_head, from_head, 1e-3);
        EXPECT_NEAR(one.linf_from_head, from_head, 1e-3);
        EXPECT_NEAR(one.gap_error_m, 0.1 * static_cast<double>(k), 1e-4);
        EXPECT_NEAR(one.smallest_gap_m, 3.0 - 0.1 * static_cast<double>(k), 1e-4);
        EXPECT_NEAR(one.used_share, static_cast<double>(k) / 30.0, 1e-4);
        // The mean slope of a sine over a short time is at most amplitude times frequency.
        EXPECT_NEAR(one.largest_jerk_mps3, 0.4 * from_head * kFrequency_radps, 0.01 * from_head);
    }
    EXPECT_EQ(measures.first_growing_position, 1);
    EXPECT_EQ(measures.holding_followers, 3);  // 1.2^3 = 1.73, 1.2^4 = 2.07
    EXPECT_NEAR(measures.smallest_gap_m, 2.5, 1e-4);
    EXPECT_NEAR(measures.largest_gap_error_m, 0.5, 1e-4);
    EXPECT_NEAR(measures.largest_used_share, 1.0 / 6.0, 1e-4);
}

TEST(StringMeasures, OfAnOscillationThatDoesNotGrow) {
    const StringMeasures measures = measure_string(oscillation(4, 0.4, 0.8));
    EXPECT_EQ(measures.first_growing_position, 0);
    EXPECT_EQ(measures.holding_followers, 3);
}

TEST(StringMeasures, JerkOfAStoppedVehicleDoesNotCount) {
    PlatoonMotion motion = oscillation(2, 0.0, 1.0);
    // The leader brakes with 2 m/s2 and stops at sample 600. The acceleration then jumps to 0.
    for (std::size_t k = 0; k < motion.samples; ++k) {
        motion.acceleration_mps2[k * 2] = k < 600 ? -2.0F : 0.0F;
        motion.speed_mps[k * 2] = k < 600 ? static_cast<float>(0.11 + 0.02 * (600.0 - static_cast<double>(k))) : 0.0F;
    }
    EXPECT_EQ(measure_string(motion).positions[0].largest_jerk_mps3, 0.0);
}

TEST(SwingGain, IsTheGeometricMeanOfTheGains) {
    const std::vector<std::complex<double>> waves = amplitudes(oscillation(6, 0.2, 1.2), kFrequency_radps);
    ASSERT_EQ(waves.size(), 6U);
    for (std::size_t k = 0; k < waves.size(); ++k) {
        EXPECT_NEAR(std::abs(waves[k]), 0.2 * std::pow(1.2, static_cast<double>(k)), 1e-5);
        EXPECT_NEAR(std::arg(waves[k]), -0.3 * static_cast<double>(k) - 0.5 * std::numbers::pi, 1e-4);
    }
    const SwingGain gain = swing_gain(waves, kFrequency_radps);
    EXPECT_NEAR(gain.mean, 1.2, 1e-4);
    EXPECT_NEAR(gain.first, 1.2, 1e-4);
    EXPECT_NEAR(gain.largest, 1.2, 1e-4);
}

TEST(SwingGain, EndsWhereTheLimitsOfAccelerationAct) {
    // The amplitudes at positions 4 and 5 are above 1 m/s2. They do not fit the geometric series.
    const std::vector<std::complex<double>> waves{0.5, 0.6, 0.72, 0.864, 1.5, 0.2};
    EXPECT_NEAR(swing_gain(waves, 1.0).mean, 1.2, 1e-9);
    EXPECT_NEAR(swing_gain(waves, 1.0).largest, 1.2, 1e-9);
    // At 3 rad/s, the limit of the jerk allows 0.83 m/s2, so position 3 does not count either.
    EXPECT_NEAR(swing_gain({0.5, 0.6, 0.72, 0.95}, 3.0).largest, 1.2, 1e-9);
}

TEST(SwingGain, EndsWhereTheOscillationIsTooWeak) {
    const std::vector<std::complex<double>> waves{1.0, 0.2, 0.04, 0.008, 0.007};
    EXPECT_NEAR(swing_gain(waves, 1.0).mean, 0.2, 1e-9);
    const std::vector<std::complex<double>> weak{1.0, 0.1, 0.01};
    EXPECT_NEAR(swing_gain(weak, 1.0).mean, 0.1, 1e-9);
}

StringSweepPoint point(double time_gap_s, double gain) { return {0.1, time_gap_s, gain, 1.0, {}, true}; }

TEST(StringBorder, LiesBetweenTheLastGrowingAndTheNextTimeGap) {
    const double limit = 1.0 + kSwingTolerance;
    EXPECT_NEAR(measured_border_s({point(0.2, limit + 0.03), point(0.4, limit + 0.01), point(0.6, limit - 0.01)}), 0.5,
                1e-9);
    EXPECT_EQ(measured_border_s({point(0.2, 0.9), point(0.4, 0.8)}), 0.2);
    EXPECT_TRUE(std::isnan(measured_border_s({point(0.2, 0.9), point(0.4, 1.1)})));
}

}  // namespace
}  // namespace stopline
