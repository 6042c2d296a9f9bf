// Figures of an area from made-up crossings.
#include "measure/area.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace stopline {
namespace {

// Detector 0: into the area from the west; 1: out of it to the east; 2: a stop line, which does not count.
std::vector<Detector> detectors() {
    return {{0, 10.0, Detector::Kind::zone, 0, false},
            {1, 10.0, Detector::Kind::zone, 0, true},
            {0, 20.0, Detector::Kind::stop_line}};
}

Crossing crossing(double time_s, int vehicle, int detector, float length_m = 5.0F) {
    return {time_s, vehicle, 0, detector, 10.0F, length_m};
}

TEST(AreaSeries, FollowsFromCrossingsByArithmetic) {
    const std::vector<Crossing> crossings{crossing(5.0, 1, 0),  crossing(8.0, 1, 2),        crossing(10.0, 2, 0, 4.0F),
                                          crossing(25.0, 1, 1), crossing(30.0, 2, 1, 4.0F), crossing(35.0, 9, 1)};
    const std::vector<AreaFigures> series = area_series(detectors(), crossings, 20.0, 45.0, 100.0);
    ASSERT_EQ(series.size(), 2u) << "windows are whole";
    EXPECT_EQ(series[0].left, 0);
    EXPECT_TRUE(std::isnan(series[0].travel_time_s));
    EXPECT_NEAR(series[0].vehicles, (15.0 + 10.0) / 20.0, 1e-12);
    EXPECT_NEAR(series[0].occupied, (15.0 * 5.0 + 10.0 * 4.0) / 20.0 / 100.0, 1e-12);
    EXPECT_EQ(series[1].left, 2) << "who never came in does not leave";
    EXPECT_NEAR(series[1].travel_time_s, (20.0 + 20.0) / 2.0, 1e-12);
    EXPECT_NEAR(series[1].throughput_veh_h(), 2.0 * 3600.0 / 20.0, 1e-9);
    EXPECT_NEAR(series[1].vehicles, (5.0 + 10.0) / 20.0, 1e-12);
}

// Detector 3: where others enter on the way of those from the west.
TEST(AreaSeries, WhoIsInsideDoesNotComeInAgain) {
    std::vector<Detector> all = detectors();
    all.push_back({2, 0.0, Detector::Kind::zone, 0, false});
    const std::vector<Crossing> crossings{crossing(5.0, 1, 0), crossing(10.0, 1, 3), crossing(12.0, 2, 3),
                                          crossing(15.0, 1, 1), crossing(18.0, 2, 1)};
    const std::vector<AreaFigures> series = area_series(all, crossings, 20.0, 20.0, 100.0);
    ASSERT_EQ(series.size(), 1u);
    EXPECT_EQ(series[0].left, 2);
    EXPECT_NEAR(series[0].travel_time_s, (10.0 + 6.0) / 2.0, 1e-12);
    EXPECT_NEAR(series[0].vehicles, (10.0 + 6.0) / 20.0, 1e-12);

    Model model;
    model.graph.lanes = {{.shape = {{0.0, 0.0}, {50.0, 0.0}}},
                         {.shape = {{50.0, 0.0}, {90.0, 0.0}}},
                         {.shape = {{50.0, -30.0}, {50.0, 0.0}}}};
    model.detectors = all;
    EXPECT_EQ(inflow_series(model, crossings, 20.0, 20.0)[0], (std::array<int, 4>{1, 1, 0, 0}));
    for (const WayFigures& way : way_figures(model, crossings, {0.0, 20.0})) {
        const bool expected = way.to == Side::east && (way.from == Side::west || way.from == Side::south);
        EXPECT_EQ(way.left, expected ? 1 : 0);
    }
}

TEST(WayFigures, AreBySideOfEntryAndExit) {
    Model model;
    model.graph.lanes = {{.shape = {{0.0, 0.0}, {50.0, 0.0}}},
                         {.shape = {{50.0, 0.0}, {90.0, 0.0}}},
                         {.shape = {{50.0, 0.0}, {50.0, -30.0}}}};
    model.detectors = {{0, 10.0, Detector::Kind::zone, 0, false},
                       {1, 10.0, Detector::Kind::zone, 0, true},
                       {2, 10.0, Detector::Kind::zone, 0, true}};
    const std::vector<Crossing> crossings{crossing(1.0, 1, 0),  crossing(2.0, 2, 0),  crossing(3.0, 3, 0),
                                          crossing(11.0, 1, 1), crossing(14.0, 2, 2), crossing(90.0, 3, 1)};
    int found = 0;
    for (const WayFigures& way : way_figures(model, crossings, {0.0, 50.0})) {
        if (way.left == 0) continue;
        ++found;
        EXPECT_EQ(way.from, Side::west);
        EXPECT_EQ(way.left, 1);
        EXPECT_NEAR(way.travel_time_s, way.to == Side::east ? 10.0 : 12.0, 1e-12);
        EXPECT_TRUE(way.to == Side::east || way.to == Side::south);
    }
    EXPECT_EQ(found, 2);
}

}  // namespace
}  // namespace stopline
