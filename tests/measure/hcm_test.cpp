// The report by the Highway Capacity Manual for synthetic cycles and passages.
#include "measure/hcm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "measure/signal_equations.h"

namespace stopline {
namespace {

constexpr double kCycle_s = 60.0;
constexpr double kGreen_s = 30.0;  // green from 27 to 57 s of each cycle, which begins with 27 s of red and ends on red
constexpr double kHeadway_s = 2.0;
constexpr double kLost_s = 1.5 + 0.6 + 0.3 + 0.1;  // start-up lost time of the first four vehicles

LaneGraph one_lane() { return make_approach({}); }

// Returns a lane in which a queue of 14 vehicles passes in every cycle. The last one passes at the end of green plus
// the end gain: 14 x 2 s + 2.5 s = 30.5 s after the start of green.
HcmRecord saturated_lane(int cycles) {
    HcmRecord record;
    record.lane = 0;
    record.approach = "lane";
    record.intersection = "0";
    for (int k = 0; k < cycles; ++k) {
        const double from_s = k * kCycle_s;
        const double green_s = from_s + 27.0;
        record.intervals.push_back(
            {from_s, from_s + kCycle_s, green_s, green_s + kGreen_s, 16, 120.0, 2, 2, true, 2, 2});
        record.green_starts_s.push_back(green_s);
        double time_s = green_s;
        for (int n = 0; n < 14; ++n) {
            const double extra_s = n == 0 ? 1.5 : n == 1 ? 0.6 : n == 2 ? 0.3 : n == 3 ? 0.1 : 0.0;
            time_s += kHeadway_s + extra_s;
            record.passages.push_back({time_s, 20.0, 1, true});
        }
    }
    return record;
}

std::vector<HcmRow> rows_of(const std::vector<HcmRecord>& records, const TimeWindow& window = {0.0, 1e6}) {
    return hcm_rows(one_lane(), records, window);
}

TEST(Hcm, SyntheticDischargeIsExact) {
    const HcmRow row = rows_of({saturated_lane(10)}).front();
    EXPECT_EQ(row.cycles, 10);
    EXPECT_NEAR(row.cycle_s, kCycle_s, 1e-9);
    EXPECT_NEAR(row.green_s, kGreen_s, 1e-9);
    EXPECT_NEAR(row.saturation_flow_veh_h, 1800.0, 1e-9);
    EXPECT_NEAR(row.startup_lost_time_s, kLost_s, 1e-9);
    EXPECT_NEAR(row.discharge.headway_s[0], 3.5, 1e-9);
    EXPECT_NEAR(row.discharge.headway_s[7], kHeadway_s, 1e-9);
    EXPECT_NEAR(row.end_gain_s, 0.5, 1e-9);
    EXPECT_NEAR(row.effective_green_s, 30.0 - kLost_s + 0.5, 1e-9);  // 28 s, the time for 14 vehicles
    EXPECT_NEAR(row.capacity_veh_h, 14.0 * 3600.0 / kCycle_s, 1e-9);
    EXPECT_NEAR(row.passed_veh_h, row.capacity_veh_h, 1e-9);
    EXPECT_NEAR(row.saturation, 1.0, 1e-9);
    EXPECT_NEAR(row.control_delay_s, 20.0, 1e-9);
    EXPECT_NEAR(row.stops, 1.0, 1e-9);
    EXPECT_NEAR(row.residual_share, 1.0, 1e-9);
}

TEST(Hcm, CountsWholeCyclesWithinTheWindowOnly) {
    const HcmRow row = rows_of({saturated_lane(10)}, {30.0, 250.0}).front();
    EXPECT_EQ(row.cycles, 3);  // 60 s to 240 s
    EXPECT_NEAR(row.passed_veh_h, 840.0, 1e-9);
    EXPECT_NEAR(row.initial_queue_veh, 2.0, 1e-9);
    EXPECT_TRUE(rows_of({saturated_lane(10)}, {30.0, 100.0}).empty());
}

// A left turn with a protected and a permissive green in each cycle of the signal, 120 s.
TEST(Hcm, TwoGreensOfACycleAreOneCycleWithoutFormula) {
    HcmRecord record = saturated_lane(20);
    for (int k = 0; k < 20; ++k) {
        HcmInterval& interval = record.intervals[static_cast<std::size_t>(k)];
        interval.cycle = k / 2;
        interval.back_veh = k % 2 == 0 ? 16 : 3;
        interval.residual_veh = k % 2 == 0 ? 2 : 0;
    }
    const std::vector<HcmRow> rows = rows_of({record});
    const HcmRow& row = rows.front();
    EXPECT_EQ(row.cycles, 10);
    EXPECT_NEAR(row.cycle_s, 2.0 * kCycle_s, 1e-9);
    EXPECT_NEAR(row.green_s, 2.0 * kGreen_s, 1e-9);
    EXPECT_NEAR(row.effective_green_s, 2.0 * 28.0, 1e-9);  // each green has its own lost time and end gain
    EXPECT_NEAR(row.capacity_veh_h, 14.0 * 3600.0 / kCycle_s, 1e-9);
    EXPECT_NEAR(row.saturation, 1.0, 1e-9);
    EXPECT_NEAR(row.back_50_veh, 16.0, 1e-9);
    EXPECT_NEAR(row.residual_share, 0.0, 1e-9);  // the queue clears in the second green
    EXPECT_NEAR(row.control_delay_s, 20.0, 1e-9);
    EXPECT_EQ(row.level, 'B');
    for (const double value : {row.uniform_delay_s, row.incremental_delay_s, row.initial_queue_delay_s,
                               row.formula_back_50_veh, row.formula_back_95_veh, rows.back().formula_delay_s()}) {
        EXPECT_TRUE(std::isnan(value)) << value;
    }
    EXPECT_EQ(row.formula_level, '-');
    EXPECT_EQ(rows.back().formula_level, '-');
    EXPECT_NEAR(rows.back().control_delay_s, 20.0, 1e-9);
}

TEST(Hcm, CountsWholeCyclesOfTwoGreensOnly) {
    HcmRecord record = saturated_lane(6);
    const std::vector<std::int64_t> cycles{4, 5, 5, 6, 6, 7};  // the record begins and ends within a cycle
    for (std::size_t k = 0; k < 6; ++k) record.intervals[k].cycle = cycles[k];
    record.first_cycle = 4;
    record.last_cycle = 7;
    EXPECT_EQ(rows_of({record}).front().cycles, 2);
    EXPECT_NEAR(rows_of({record}).front().cycle_s, 2.0 * kCycle_s, 1e-9);
    const HcmRow later = rows_of({record}, {130.0, 1e6}).front();
    EXPECT_EQ(later.cycles, 1);
    EXPECT_EQ(rows_of({record}, {0.0, 290.0}).front().cycles, 1);
}

// The last cycle has one green only. It is complete because the record ends in the next cycle.
TEST(Hcm, ACycleWithFewerGreensIsCompleteWhenTheNextOneHasBegun) {
    HcmRecord record = saturated_lane(6);
    const std::vector<std::int64_t> cycles{4, 5, 5, 6, 6, 7};
    for (std::size_t k = 0; k < 6; ++k) record.intervals[k].cycle = cycles[k];
    record.first_cycle = 4;
    record.last_cycle = 8;
    EXPECT_EQ(rows_of({record}).front().cycles, 3);
    EXPECT_NEAR(rows_of({record}).front().cycle_s, 5.0 / 3.0 * kCycle_s, 1e-9);
}

// The controller skips the lane in every second cycle: its queue passes in the other cycles.
TEST(Hcm, CyclesWithoutGreenCount) {
    HcmRecord record = saturated_lane(10);
    std::vector<HcmInterval> intervals;
    for (int k = 0; k < 10; ++k) {
        HcmInterval served = record.intervals[static_cast<std::size_t>(k)];
        served.cycle = 2 * k + 1;
        served.residual_veh = 0;
        HcmInterval skipped;
        skipped.from_s = served.from_s;
        skipped.to_s = served.from_s = served.from_s + 20.0;
        skipped.cycle = 2 * k;
        skipped.back_veh = 4;
        skipped.residual_veh = 4;
        intervals.push_back(skipped);
        intervals.push_back(served);
    }
    record.intervals = intervals;
    record.last_cycle = 20;
    const HcmRow row = rows_of({record}).front();
    EXPECT_EQ(row.cycles, 20);
    EXPECT_NEAR(row.cycle_s, 0.5 * kCycle_s, 1e-9);
    EXPECT_NEAR(row.green_s, 0.5 * kGreen_s, 1e-9);
    EXPECT_NEAR(row.greens_per_cycle, 0.5, 1e-9);
    EXPECT_NEAR(row.effective_green_s, 0.5 * 28.0, 1e-9);
    EXPECT_NEAR(row.capacity_veh_h, 14.0 * 3600.0 / kCycle_s, 1e-9);
    EXPECT_NEAR(row.residual_share, 0.5, 1e-9);
    EXPECT_NEAR(row.back_50_veh, 10.0, 1e-9);  // between 4 and 16
    EXPECT_FALSE(std::isnan(row.formula_delay_s()));
}

// The green of every second cycle lasts until the end of the next cycle of the signal.
TEST(Hcm, AGreenThroughTwoCyclesIsOneGreen) {
    HcmRecord record = saturated_lane(10);
    std::vector<HcmInterval> intervals;
    for (const HcmInterval& whole : record.intervals) {
        HcmInterval first = whole;
        first.cycle = 2 * static_cast<std::int64_t>(intervals.size() / 2);
        first.to_s = first.green_to_s = whole.green_from_s + 10.0;
        first.green_goes_on = true;
        first.is_used = false;
        HcmInterval rest = whole;
        rest.cycle = first.cycle + 1;
        rest.from_s = rest.green_from_s = first.to_s;
        intervals.push_back(first);
        intervals.push_back(rest);
    }
    record.intervals = intervals;
    record.last_cycle = 20;
    const HcmRow row = rows_of({record}).front();
    EXPECT_EQ(row.cycles, 20);
    EXPECT_NEAR(row.green_s, 0.5 * kGreen_s, 1e-9);
    EXPECT_NEAR(row.greens_per_cycle, 0.5, 1e-9);
    EXPECT_FALSE(row.has_several_greens);
    EXPECT_NEAR(row.effective_green_s, 0.5 * 28.0, 1e-9);
    EXPECT_NEAR(row.capacity_veh_h, 14.0 * 3600.0 / kCycle_s, 1e-9);
}

TEST(Hcm, ALaneThatIsAlwaysSkippedHasNoRow) {
    HcmRecord record = saturated_lane(10);
    for (HcmInterval& interval : record.intervals) interval.green_to_s = interval.green_from_s;
    EXPECT_TRUE(rows_of({record}).empty());
}

TEST(Hcm, GrowingQueueIsOversaturatedAndHasLevelF) {
    HcmRecord record = saturated_lane(10);
    for (int k = 0; k < 10; ++k) {
        record.intervals[static_cast<std::size_t>(k)].present_before_veh = 2 * k;
        record.intervals[static_cast<std::size_t>(k)].present_veh = 2 * (k + 1);
    }
    const HcmRow row = rows_of({record}, {60.0, 600.0}).front();
    EXPECT_NEAR(row.volume_veh_h - row.passed_veh_h, 120.0, 1e-9);  // two vehicles more in each minute
    EXPECT_NEAR(row.saturation, 16.0 / 14.0, 1e-9);
    EXPECT_EQ(row.state, HcmState::oversaturated);
    EXPECT_EQ(row.level, 'F');  // although the measured delay is 20 s
}

// 14 vehicles pass in each of 10 cycles. Of the vehicles before the stop line, 30 are teleported in the first cycle.
TEST(Hcm, TeleportedVehiclesHaveArrived) {
    HcmRecord record = saturated_lane(10);
    record.intervals.front().present_before_veh = 40;
    record.intervals.back().present_veh = 10;
    record.intervals.front().teleported_veh = 30;
    EXPECT_NEAR(rows_of({record}).front().volume_veh_h, 14.0 * 3600.0 / kCycle_s, 1e-9);
}

// 200 vehicles leave the lane by changing to another one, so more vehicles leave than arrive.
TEST(Hcm, VolumeIsNotNegative) {
    HcmRecord record = saturated_lane(10);
    record.intervals.front().present_before_veh = 200;
    const HcmRow row = rows_of({record}).front();
    EXPECT_EQ(row.volume_veh_h, 0.0);
    EXPECT_EQ(row.saturation, 0.0);
    EXPECT_EQ(row.incremental_delay_s, 0.0);
    EXPECT_GT(row.initial_queue_delay_s, 0.0);
    EXPECT_TRUE(std::isfinite(row.formula_delay_s()));
}

TEST(Hcm, ResidualQueuesAreSaturatedAndEndlessDemandIsOversaturated) {
    HcmRecord record = saturated_lane(10);
    EXPECT_EQ(rows_of({record}).front().state, HcmState::saturated);
    EXPECT_EQ(rows_of({record}).front().level, 'B');  // 20 s
    record.has_endless_demand = true;
    EXPECT_EQ(rows_of({record}).front().state, HcmState::oversaturated);
    for (HcmInterval& interval : record.intervals) interval.residual_veh = 0;
    EXPECT_EQ(rows_of({record}).front().state, HcmState::free);
}

TEST(Hcm, LanesWithoutSaturatedGreenUseTheOthers) {
    HcmRecord other = saturated_lane(10);
    other.approach = "other";
    for (HcmPassage& passage : other.passages) passage = {passage.time_s, 8.0, 0, false};
    for (HcmInterval& interval : other.intervals) interval.is_used = false;
    const std::vector<HcmRow> rows = rows_of({saturated_lane(10), other});
    ASSERT_EQ(rows.size(), 5U);  // two lanes, two approaches, one intersection
    EXPECT_EQ(rows[1].discharge.saturated_greens, 0);
    EXPECT_NEAR(rows[1].saturation_flow_veh_h, 1800.0, 1e-9);
    EXPECT_NEAR(rows[1].startup_lost_time_s, kLost_s, 1e-9);
    EXPECT_NEAR(rows[1].end_gain_s, 0.5, 1e-9);
    EXPECT_EQ(rows[2].scope, HcmRow::Scope::approach);
    EXPECT_EQ(rows[4].scope, HcmRow::Scope::intersection);
    EXPECT_NEAR(rows[4].control_delay_s, 14.0, 1e-9);  // equal flows
    EXPECT_NEAR(rows[4].passed_veh_h, rows[0].passed_veh_h + rows[1].passed_veh_h, 1e-9);
    EXPECT_NEAR(rows[4].stops, 0.5, 1e-9);
}

// Vehicles arrive evenly and wait in a queue without length. With many vehicles, their delay is the closed form d1.
TEST(Hcm, PointQueueOfEvenArrivalsHasTheUniformDelay) {
    constexpr double kShort_s = 0.05;   // headway of the queue
    constexpr double kArrival_s = 0.2;  // headway of the arrivals
    HcmRecord record;
    record.lane = 0;
    for (int k = 0; k < 5; ++k) {
        const double from_s = k * kCycle_s;
        const double green_s = from_s + 30.0;
        // Green ends 2 s, the end gain, before the last vehicle passes.
        record.intervals.push_back({from_s, from_s + kCycle_s, green_s, from_s + 58.0});
        record.green_starts_s.push_back(green_s);
        double last_s = green_s;
        for (int n = 0; n < 300; ++n) {
            const double arrival_s = from_s + (n + 0.5) * kArrival_s;
            const bool queues = arrival_s < last_s + kShort_s;
            last_s = queues ? last_s + kShort_s : arrival_s;
            record.passages.push_back({last_s, last_s - arrival_s, queues ? 1 : 0, queues});
        }
    }
    const HcmRow row = rows_of({record}).front();
    EXPECT_NEAR(row.saturation_flow_veh_h, 3600.0 / kShort_s, 1e-3);
    EXPECT_NEAR(row.startup_lost_time_s, 0.0, 1e-6);
    EXPECT_NEAR(row.effective_green_s, 30.0, 1e-6);
    EXPECT_NEAR(row.saturation, 0.5, 1e-6);
    EXPECT_NEAR(row.uniform_delay_s, 10.0, 1e-5);  // 0.5 x 60 x 0.5^2 / (1 - 0.5 x 0.5)
    EXPECT_NEAR(row.control_delay_s, row.uniform_delay_s, 0.01 * row.uniform_delay_s);
}

// A vehicle that waits for oncoming traffic until the end of green does not shorten the effective green.
TEST(Hcm, QueuesThatSomethingElseHoldsGiveNoEndGain) {
    HcmRecord record = saturated_lane(10);
    for (HcmPassage& passage : record.passages) passage.time_s -= 5.0;
    for (double& green_s : record.green_starts_s) green_s -= 5.0;
    const HcmRow row = rows_of({record}).front();
    EXPECT_EQ(row.used_greens, 0);
    EXPECT_NEAR(row.end_gain_s, kEndGain_s, 1e-9);
}

TEST(Hcm, PercentileInterpolates) {
    EXPECT_TRUE(std::isnan(percentile({}, 0.5)));
    EXPECT_NEAR(percentile({7.0}, 0.95), 7.0, 1e-12);
    EXPECT_NEAR(percentile({3.0, 1.0, 2.0}, 0.5), 2.0, 1e-12);
    std::vector<double> hundred_and_one;
    for (int k = 100; k >= 0; --k) hundred_and_one.push_back(k);
    EXPECT_NEAR(percentile(hundred_and_one, 0.95), 95.0, 1e-9);
    EXPECT_NEAR(percentile({0.0, 10.0}, 0.95), 9.5, 1e-12);
}

TEST(Hcm, BackOfQueueOfHandMadeCycles) {
    HcmRecord record = saturated_lane(11);
    for (int k = 0; k < 11; ++k) {
        record.intervals[static_cast<std::size_t>(k)].back_veh = k;
        record.intervals[static_cast<std::size_t>(k)].back_m = 7.0 * k;
    }
    const HcmRow row = rows_of({record}).front();
    EXPECT_NEAR(row.back_50_veh, 5.0, 1e-9);
    EXPECT_NEAR(row.back_95_veh, 9.5, 1e-9);
    EXPECT_NEAR(row.back_50_m, 35.0, 1e-9);
    EXPECT_NEAR(row.back_95_m, 66.5, 1e-9);
}

// Vehicles that arrive one by one at a constant rate stop if they arrive in the red or before the queue has cleared.
TEST(HcmEquations, BackOfQueueIsTheNumberOfStopsOfEvenArrivals) {
    const double green_s = 28.0;
    for (const double volume_veh_h : {200.0, 400.0, 700.0}) {
        const double saturation_1ps = 0.5;
        const double arrivals_1ps = volume_veh_h / 3600.0;
        const double clears_s = arrivals_1ps * (kCycle_s - green_s) / (saturation_1ps - arrivals_1ps);
        const BackOfQueue back{volume_veh_h, 1800.0 * green_s / kCycle_s, kCycle_s, green_s, 0.0, 0.0};
        EXPECT_NEAR(back.first_term_veh(), arrivals_1ps * (kCycle_s - green_s + clears_s), 1e-9);
        EXPECT_NEAR(back.percentile_veh(0.0), back.first_term_veh(), 1e-12);
        // Below saturation the factor is 1 + z / sqrt(Q), and at most 1.8.
        const double mean_veh = back.first_term_veh();
        EXPECT_NEAR(back.percentile_veh(1.64), std::min(1.8 * mean_veh, mean_veh + 1.64 * std::sqrt(mean_veh)), 1e-9);
    }
}

// A queue of 10 vehicles that clears at 100 veh/h takes 0.1 h, and its area is a triangle.
TEST(HcmEquations, InitialQueueDelayIsTheAreaOfTheQueue) {
    EXPECT_DOUBLE_EQ(initial_queue_delay_s(0.0, 500.0, 600.0, 1.0), 0.0);
    const double triangle_veh_h = 0.5 * 0.1 * 10.0;
    const double correction_veh_h = 10.0 * 10.0 / (2.0 * 600.0);
    EXPECT_NEAR(initial_queue_delay_s(10.0, 500.0, 600.0, 1.0), 3600.0 * (triangle_veh_h - correction_veh_h) / 500.0,
                1e-9);
    // At volume = capacity the queue stays, and every vehicle waits for the same 10 vehicles.
    EXPECT_NEAR(initial_queue_delay_s(10.0, 600.0, 600.0, 1.0), 3600.0 * 10.0 / 600.0, 1e-9);
    // Above capacity, the queue of the excess volume is no part of this delay.
    EXPECT_NEAR(initial_queue_delay_s(10.0, 700.0, 600.0, 1.0), 3600.0 * 10.0 / 600.0, 1e-9);
    // A queue of 100 vehicles still has 50 vehicles at the end of a period of 0.5 h: arrivals wait for 75 on average.
    EXPECT_NEAR(initial_queue_delay_s(100.0, 500.0, 600.0, 0.5), 3600.0 * 75.0 / 600.0, 1e-9);
}

// Without volume, a queue of 10 vehicles clears in 1/60 h. Until then, an arrival would wait for 5 vehicles on average.
TEST(HcmEquations, InitialQueueDelayIsDefinedWithoutVolume) {
    EXPECT_NEAR(initial_queue_delay_s(10.0, 0.0, 600.0, 1.0), 3600.0 * 5.0 / 600.0 / 60.0, 1e-9);
    EXPECT_NEAR(initial_queue_delay_s(10.0, 1e-6, 600.0, 1.0), initial_queue_delay_s(10.0, 0.0, 600.0, 1.0), 1e-6);
}

}  // namespace
}  // namespace stopline
