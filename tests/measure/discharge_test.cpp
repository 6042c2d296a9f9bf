// Tests of queue discharge with synthetic passages, by the arithmetic of the Highway Capacity Manual.
#include "measure/discharge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/state/model.h"

namespace stopline {
namespace {

constexpr double kGreen_s = 10.0;  // start of the first green
constexpr double kCycle_s = 60.0;

// Returns a model with two lanes. Green starts at 10 s, 70 s, 130 s ... and lasts 15 s; 3 s of yellow follow.
Model two_lanes() {
    Model model;
    ApproachSettings approach;
    approach.lanes = 2;
    model.graph = make_approach(approach);
    model.signals.add(fixed_time_plan(
        0, {make_single_light({.first_green_s = kGreen_s, .green_s = 15.0, .cycle_s = kCycle_s}, model.step_s)}));
    for (const int lane : {0, 2}) {
        model.detectors.push_back({lane, model.graph.lanes[0].stop_line_m, Detector::Kind::stop_line});
        model.detectors.push_back({lane, 1.0, Detector::Kind::zone, 0, false});
    }
    return model;
}

Discharge discharge_in(
    const Model& model, const std::vector<Crossing>& crossings, const TimeWindow& window,
    const HasQueued& has_queued = [](int) { return true; }) {
    const auto latest_green_start_s = [&](int signal_group, double time_s) {
        const auto tick = static_cast<std::int64_t>(time_s / model.step_s);
        return model.time_s(model.signals.programme(signal_group).last_green_start_tick(tick));
    };
    return discharge(model.graph, model.detectors, crossings, window, latest_green_start_s, kCycle_s, has_queued);
}

// Adds passages at one detector during one green, given by their headways.
void add_passages(std::vector<Crossing>& crossings, double green_s, int detector,
                  const std::vector<double>& headways_s) {
    double time_s = green_s;
    for (const double headway_s : headways_s) {
        time_s += headway_s;
        crossings.push_back({time_s, static_cast<int>(crossings.size()), 0, detector, 10.0F, 5.0F});
    }
}

std::vector<Crossing> sorted_by_time(std::vector<Crossing> crossings) {
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.time_s < b.time_s; });
    return crossings;
}

TEST(Discharge, MatchesHandCalculation) {
    const Model model = two_lanes();
    std::vector<Crossing> crossings;
    add_passages(crossings, kGreen_s - kCycle_s, 0, {59.0});                    // before the first green
    add_passages(crossings, kGreen_s, 0, {3.0, 2.5, 2.3, 2.2, 2.0, 2.0, 1.7});  // the last passage is on yellow
    add_passages(crossings, kGreen_s, 2, {3.4, 2.7, 2.5, 2.0, 1.8});
    add_passages(crossings, kGreen_s, 1, {0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5});  // a zone boundary is not a stop line
    add_passages(crossings, kGreen_s + kCycle_s, 0, {3.2, 2.6, 2.4, 2.1, 1.9, 2.0});
    add_passages(crossings, kGreen_s + 2.0 * kCycle_s, 2, {1.0, 1.0, 1.0, 1.0, 1.0, 1.0});  // after the window
    const Discharge d = discharge_in(model, sorted_by_time(crossings), {kGreen_s, kGreen_s + 2.0 * kCycle_s});

    ASSERT_EQ(d.lanes.size(), 2U);
    const std::vector<double> first_s{3.1, 2.55, 2.35, 2.15, 1.95, 2.0, 1.7};
    const std::vector<double> second_s{3.4, 2.7, 2.5, 2.0, 1.8};
    ASSERT_EQ(d.lanes[0].headway_s.size(), first_s.size());
    ASSERT_EQ(d.lanes[1].headway_s.size(), second_s.size());
    for (std::size_t k = 0; k < first_s.size(); ++k) EXPECT_NEAR(d.lanes[0].headway_s[k], first_s[k], 1e-9) << k;
    for (std::size_t k = 0; k < second_s.size(); ++k) EXPECT_NEAR(d.lanes[1].headway_s[k], second_s[k], 1e-9) << k;
    EXPECT_EQ(d.lanes[0].samples, (std::vector{2, 2, 2, 2, 2, 2, 1}));
    EXPECT_EQ(d.lanes[1].samples, std::vector(5, 1));
    EXPECT_EQ(d.lanes[0].lane, model.graph.lanes[0].name);
    EXPECT_EQ(d.saturated_greens, 3);
    // From the fifth vehicle on, all headways have equal weight: (2.0 + 2.0 + 1.7 + 1.8 + 1.9 + 2.0) / 6.
    EXPECT_NEAR(d.saturation_headway_s, 1.9, 1e-9);
    EXPECT_NEAR(d.saturation_flow_veh_h, 3600.0 / 1.9, 1e-6);
    // The lost time of a lane refers to the saturation headway of the same lane. The first lane discharges in two
    // greens, the second lane in one green.
    const double first_lost_s = 3.1 + 2.55 + 2.35 + 2.15 - 4.0 * (2.0 + 2.0 + 1.7 + 1.9 + 2.0) / 5.0;
    const double second_lost_s = 3.4 + 2.7 + 2.5 + 2.0 - 4.0 * 1.8;
    EXPECT_NEAR(d.lanes[0].startup_lost_time_s, first_lost_s, 1e-9);
    EXPECT_NEAR(d.lanes[1].startup_lost_time_s, second_lost_s, 1e-9);
    EXPECT_NEAR(d.startup_lost_time_s, (2.0 * first_lost_s + second_lost_s) / 3.0, 1e-9);
    EXPECT_EQ(d.greens, 2);
    EXPECT_DOUBLE_EQ(d.vehicles_per_green, 18.0 / 2.0 / 2.0) << "two lanes, two greens, one of them empty";
}

TEST(Discharge, CountsAFirstVehicleOnYellowTowardsItsGreen) {
    const Model model = two_lanes();
    std::vector<Crossing> crossings;
    add_passages(crossings, kGreen_s, 0, {3.0, 2.5});
    add_passages(crossings, kGreen_s + kCycle_s, 0, {15.5});
    const Discharge d = discharge_in(model, sorted_by_time(crossings), {kGreen_s, kGreen_s + 2.0 * kCycle_s});
    EXPECT_EQ(d.lanes[0].samples, (std::vector{2, 1}));
    EXPECT_NEAR(d.lanes[0].headway_s.at(0), (3.0 + 15.5) / 2.0, 1e-9);
}

TEST(Discharge, IgnoresAGreenThatStartsBeforeTheWindow) {
    const Model model = two_lanes();
    std::vector<Crossing> crossings;
    add_passages(crossings, kGreen_s, 0, {3.0, 2.0, 2.0, 2.0, 2.0, 1.0});
    add_passages(crossings, kGreen_s + kCycle_s, 0, {4.0, 3.0, 3.0, 3.0, 2.5});
    const Discharge d = discharge_in(model, crossings, {kGreen_s + 6.0, kGreen_s + 6.0 + kCycle_s * 2.0});
    ASSERT_EQ(d.lanes[0].samples, std::vector(5, 1));
    EXPECT_NEAR(d.lanes[0].headway_s[0], 4.0, 1e-9);
    EXPECT_NEAR(d.saturation_headway_s, 2.5, 1e-9);
}

TEST(Discharge, HasNoSaturationFlowWithoutAFifthVehicle) {
    const Model model = two_lanes();
    std::vector<Crossing> crossings;
    add_passages(crossings, kGreen_s, 0, {3.0, 2.0, 2.0, 2.0});
    const Discharge d = discharge_in(model, crossings, {kGreen_s, kGreen_s + kCycle_s});
    EXPECT_TRUE(std::isnan(d.saturation_headway_s));
    EXPECT_TRUE(std::isnan(d.saturation_flow_veh_h));
    EXPECT_DOUBLE_EQ(d.vehicles_per_green, 2.0);
}

// The sixth vehicle has not stopped, so the queue consists of the five vehicles ahead. The seventh vehicle has stopped,
// but does not belong to the queue either.
TEST(Discharge, CountsOnlyVehiclesOfTheQueue) {
    const Model model = two_lanes();
    std::vector<Crossing> crossings;
    add_passages(crossings, kGreen_s, 0, {3.0, 2.5, 2.3, 2.2, 2.0, 4.0, 1.0});
    const auto has_queued = [](int vehicle) { return vehicle != 5; };
    const Discharge d = discharge_in(model, crossings, {kGreen_s, kGreen_s + kCycle_s}, has_queued);
    EXPECT_EQ(d.lanes[0].samples, std::vector(5, 1));
    EXPECT_EQ(d.saturated_greens, 1);
    EXPECT_NEAR(d.saturation_headway_s, 2.0, 1e-9);
    EXPECT_DOUBLE_EQ(d.vehicles_per_green, 3.5) << "all seven vehicles, on two lanes";
}

TEST(Discharge, VehiclesThatNeverQueuedGiveNoSaturationFlow) {
    const Model model = two_lanes();
    std::vector<Crossing> crossings;
    add_passages(crossings, kGreen_s, 0, {1.0, 4.0, 4.0, 4.0, 4.0, 4.0});
    const Discharge d =
        discharge_in(model, crossings, {kGreen_s, kGreen_s + kCycle_s}, [](int /*vehicle*/) { return false; });
    EXPECT_EQ(d.saturated_greens, 0);
    EXPECT_TRUE(std::isnan(d.saturation_headway_s));
    EXPECT_TRUE(std::isnan(d.startup_lost_time_s));
    EXPECT_TRUE(d.lanes[0].headway_s.empty());
}

}  // namespace
}  // namespace stopline
