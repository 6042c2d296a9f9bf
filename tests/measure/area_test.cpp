// Tests of area metrics with synthetic detector crossings.
#include "measure/area.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace stopline {
namespace {

// Detector 0 is an entry from the west, detector 1 an exit to the east. Detector 2 is a stop line and does not count.
std::vector<Detector> detectors() {
    return {{0, 10.0, Detector::Kind::zone, 0, false},
            {1, 10.0, Detector::Kind::zone, 0, true},
            {0, 20.0, Detector::Kind::stop_line}};
}

Crossing crossing(double time_s, int vehicle, int detector, float length_m = 5.0F) {
    return {time_s, vehicle, 0, detector, 10.0F, length_m};
}

TEST(AreaSeries, MatchesHandCalculation) {
    const std::vector<Crossing> crossings{crossing(5.0, 1, 0),  crossing(8.0, 1, 2),        crossing(10.0, 2, 0, 4.0F),
                                          crossing(25.0, 1, 1), crossing(30.0, 2, 1, 4.0F), crossing(35.0, 9, 1)};
    const std::vector<AreaResult> series = area_series(detectors(), crossings, 20.0, 45.0, 100.0);
    ASSERT_EQ(series.size(), 2u) << "only whole windows count";
    EXPECT_EQ(series[0].exited, 0);
    EXPECT_TRUE(std::isnan(series[0].travel_time_s));
    EXPECT_NEAR(series[0].vehicles, (15.0 + 10.0) / 20.0, 1e-12);
    EXPECT_NEAR(series[0].occupied, (15.0 * 5.0 + 10.0 * 4.0) / 20.0 / 100.0, 1e-12);
    EXPECT_EQ(series[1].exited, 2) << "a vehicle that never entered does not count";
    EXPECT_NEAR(series[1].travel_time_s, (20.0 + 20.0) / 2.0, 1e-12);
    EXPECT_NEAR(series[1].throughput_veh_h(), 2.0 * 3600.0 / 20.0, 1e-9);
    EXPECT_NEAR(series[1].vehicles, (5.0 + 10.0) / 20.0, 1e-12);
}

// Detector 3 is a second entry from the west. Vehicle 1 passes both entries, vehicle 2 only the second one.
TEST(AreaSeries, CountsOnlyTheFirstEntryOfAVehicle) {
    std::vector<Detector> all = detectors();
    all.push_back({2, 0.0, Detector::Kind::zone, 0, false});
    const std::vector<Crossing> crossings{crossing(5.0, 1, 0), crossing(10.0, 1, 3), crossing(12.0, 2, 3),
                                          crossing(15.0, 1, 1), crossing(18.0, 2, 1)};
    const std::vector<AreaResult> series = area_series(all, crossings, 20.0, 20.0, 100.0);
    ASSERT_EQ(series.size(), 1u);
    EXPECT_EQ(series[0].exited, 2);
    EXPECT_NEAR(series[0].travel_time_s, (10.0 + 6.0) / 2.0, 1e-12);
    EXPECT_NEAR(series[0].vehicles, (10.0 + 6.0) / 20.0, 1e-12);

    LaneGraph graph;
    graph.lanes = {{.shape = {{0.0, 0.0}, {50.0, 0.0}}},
                   {.shape = {{50.0, 0.0}, {90.0, 0.0}}},
                   {.shape = {{50.0, -30.0}, {50.0, 0.0}}}};
    EXPECT_EQ(inflow_series(graph, all, crossings, 20.0, 20.0)[0], (std::array<int, 4>{1, 1, 0, 0}));
    for (const OriginDestinationResult& relation : origin_destination_results(graph, all, crossings, {0.0, 20.0})) {
        const bool expected =
            relation.to == Side::east && (relation.from == Side::west || relation.from == Side::south);
        EXPECT_EQ(relation.exited, expected ? 1 : 0);
    }
}

TEST(OriginDestination, DistinguishesSidesOfEntryAndExit) {
    LaneGraph graph;
    graph.lanes = {{.shape = {{0.0, 0.0}, {50.0, 0.0}}},
                   {.shape = {{50.0, 0.0}, {90.0, 0.0}}},
                   {.shape = {{50.0, 0.0}, {50.0, -30.0}}}};
    const std::vector<Detector> detectors{{0, 10.0, Detector::Kind::zone, 0, false},
                                          {1, 10.0, Detector::Kind::zone, 0, true},
                                          {2, 10.0, Detector::Kind::zone, 0, true}};
    const std::vector<Crossing> crossings{crossing(1.0, 1, 0),  crossing(2.0, 2, 0),  crossing(3.0, 3, 0),
                                          crossing(11.0, 1, 1), crossing(14.0, 2, 2), crossing(90.0, 3, 1)};
    int relations_with_traffic = 0;
    for (const OriginDestinationResult& relation :
         origin_destination_results(graph, detectors, crossings, {0.0, 50.0})) {
        if (relation.exited == 0) continue;
        ++relations_with_traffic;
        EXPECT_EQ(relation.from, Side::west);
        EXPECT_EQ(relation.exited, 1);
        EXPECT_NEAR(relation.travel_time_s, relation.to == Side::east ? 10.0 : 12.0, 1e-12);
        EXPECT_TRUE(relation.to == Side::east || relation.to == Side::south);
    }
    EXPECT_EQ(relations_with_traffic, 2);
}

}  // namespace
}  // namespace stopline
