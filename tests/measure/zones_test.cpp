// Travel time and density of zones from hand-made crossings; discharge from hand-made greens.
#include "measure/zones.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace stopline {
namespace {

const std::vector<Detector> kDetectors{{0, 10.0, Detector::Kind::zone, 0, false},
                                       {1, 10.0, Detector::Kind::zone, 0, true},
                                       {0, 50.0, Detector::Kind::stop_line, -1, false}};

Crossing at(double time_s, int vehicle, int detector) { return {time_s, vehicle, 0, detector, 10.0F, 5.0F}; }

TEST(Zone, MeansOfThoseThatLeaveWithinTheWindow) {
    const std::vector<Crossing> crossings{at(1.0, 1, 0),  at(2.0, 2, 0),  at(6.0, 1, 2),
                                          at(11.0, 1, 1), at(12.0, 3, 0), at(32.0, 2, 1)};
    const ZoneFigures zone = zone_figures(kDetectors, crossings, 0, {10.0, 40.0}, 100.0);
    EXPECT_EQ(zone.left, 2);
    EXPECT_DOUBLE_EQ(zone.travel_time_s, 0.5 * (10.0 + 30.0));
    // In the zone within the window: 1 for 1 s, 2 for 22 s, 3 for 28 s.
    EXPECT_DOUBLE_EQ(zone.vehicles, (1.0 + 22.0 + 28.0) / 30.0);
    EXPECT_DOUBLE_EQ(zone.occupied, 5.0 * zone.vehicles / 100.0);
}

TEST(Zone, NobodyLeavesGivesNoTime) {
    const ZoneFigures zone = zone_figures(kDetectors, std::vector{at(1.0, 1, 0)}, 0, {0.0, 10.0}, 100.0);
    EXPECT_TRUE(std::isnan(zone.travel_time_s));
    EXPECT_DOUBLE_EQ(zone.vehicles, 0.9);
}

}  // namespace
}  // namespace stopline
