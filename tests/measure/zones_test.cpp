// Tests of travel time and density of zones with synthetic detector crossings.
#include "measure/zones.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace stopline {
namespace {

const std::vector<Detector> kDetectors{{0, 10.0, Detector::Kind::zone, 0, false},
                                       {1, 10.0, Detector::Kind::zone, 0, true},
                                       {0, 50.0, Detector::Kind::stop_line, -1, false}};

Crossing crossing_at(double time_s, int vehicle, int detector) { return {time_s, vehicle, 0, detector, 10.0F, 5.0F}; }

TEST(Zone, AveragesVehiclesThatExitWithinTheWindow) {
    const std::vector<Crossing> crossings{crossing_at(1.0, 1, 0),  crossing_at(2.0, 2, 0),  crossing_at(6.0, 1, 2),
                                          crossing_at(11.0, 1, 1), crossing_at(12.0, 3, 0), crossing_at(32.0, 2, 1)};
    const ZoneResult zone = measure_zone(kDetectors, crossings, 0, {10.0, 40.0}, 100.0);
    EXPECT_EQ(zone.exited, 2);
    EXPECT_DOUBLE_EQ(zone.travel_time_s, 0.5 * (10.0 + 30.0));
    // Time in the zone within the window: vehicle 1 for 1 s, vehicle 2 for 22 s, vehicle 3 for 28 s.
    EXPECT_DOUBLE_EQ(zone.vehicles, (1.0 + 22.0 + 28.0) / 30.0);
    EXPECT_DOUBLE_EQ(zone.occupied, 5.0 * zone.vehicles / 100.0);
}

TEST(Zone, HasNoTravelTimeWithoutExits) {
    const ZoneResult zone = measure_zone(kDetectors, std::vector{crossing_at(1.0, 1, 0)}, 0, {0.0, 10.0}, 100.0);
    EXPECT_TRUE(std::isnan(zone.travel_time_s));
    EXPECT_DOUBLE_EQ(zone.vehicles, 0.9);
}

}  // namespace
}  // namespace stopline
