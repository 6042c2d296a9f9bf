// The time-space diagram of a street: its stop lines where they are, red as long as the programme says, vehicles that do not drive
// backwards, and those of one platoon all the way through a green wave.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "experiment/network_run.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

StreetTrace trace_of(const std::vector<std::string>& overrides) {
    std::vector<std::string> all{"duration=400 s", "measure.steady=200 s", "measure.time_space=184 s"};
    all.insert(all.end(), overrides.begin(), overrides.end());
    return run_network(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/arterial.yaml", all), 2).street;
}

TEST(TimeSpace, LinesAreWhereTheIntersectionsAreAndRedAsProgrammed) {
    const StreetTrace trace = trace_of({"signal.green=20 s", "signal.cross_green=10 s"});  // cycle 46 s: 23 s red
    std::map<double, double> red_s;
    for (const RedTime& red : trace.reds) red_s[red.line_m] += red.to_s - red.from_s;
    ASSERT_EQ(red_s.size(), 5u);
    double line_m = 155.0;
    for (const auto& [at_m, sum_s] : red_s) {
        EXPECT_NEAR(at_m, line_m, 5.0);  // across an intersection a lane is nearly as long as the straight line
        EXPECT_NEAR(sum_s, 4 * 23.0, 4.0);
        line_m = at_m + 192.5;
    }
}

TEST(TimeSpace, VehiclesDriveForwardAndAGreenWaveCarriesThemThrough) {
    const StreetTrace trace = trace_of({"signal.green=10 s", "signal.cross_green=10 s", "signal.offset=15 s",
                                        "demand.cross_left=0 %", "demand.cross_right=0 %"});
    std::map<int, const StreetPoint*> before;
    std::map<int, double> first_s;
    std::set<int> through;
    for (const StreetPoint& point : trace.points) {
        const StreetPoint*& last = before[point.vehicle];
        if (last != nullptr) {
            ASSERT_GE(point.front_m, last->front_m);
            ASSERT_LE(point.front_m, last->front_m + 15.0 * (point.time_s - last->time_s));
        }
        last = &point;
        if (point.front_m > 160.0) first_s.try_emplace(point.vehicle, point.time_s);
        // Four blocks at 15 s each, without a stop.
        if (point.front_m > 930.0 && first_s.contains(point.vehicle) && first_s[point.vehicle] > 217.0) {
            EXPECT_LT(point.time_s - first_s[point.vehicle], 75.0);
            through.insert(point.vehicle);
        }
    }
    EXPECT_GT(through.size(), 20u);
}

}  // namespace
}  // namespace stopline
