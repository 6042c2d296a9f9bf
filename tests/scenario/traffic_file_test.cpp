// Tests of the messages for traffic files: detector counts and origin-destination matrices.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

constexpr const char* kCountsHeader = "begin,end,approach,vehicles,left,straight,right\n";
constexpr const char* kMatrixHeader = "begin,end,origin,destination,vehicles\n";

// Returns the message for a traffic file, or "" if it is accepted. The left lane allows no right turn, and the other
// way round.
std::string traffic_error(const std::string& kind, const std::string& text, const std::string& more = "",
                          const std::string& lanes = "[{movements: straight}, {movements: straight+right}]") {
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "traffic.csv") << text;
    const std::string scenario = "network: {kind: grid, intersection: {lanes: " + lanes +
                                 "}, grid: {columns: 2, rows: 1}}\nduration: 600 s\n"
                                 "demand: {kind: " +
                                 kind + ", " + kind + ": traffic.csv" + more + "}\n";
    return input_error_of([&] { parse_scenario(scenario, "test.yaml", {}, folder.path()); });
}

std::string counts_error(const std::string& rows) { return traffic_error("counts", kCountsHeader + rows); }
std::string matrix_error(const std::string& rows) { return traffic_error("od", kMatrixHeader + rows); }

TEST(TrafficFile, IsAcceptedWithoutProblems) {
    EXPECT_EQ(counts_error("0,60,c0r0_west,9,0,6,3\n60,120,c0r0_west,0,0,0,0\n"), "");
    EXPECT_EQ(traffic_error("counts", "begin,end,approach,vehicles\r\n0,60,c0r0_west,9\r\n"), "");
    EXPECT_EQ(matrix_error("0,60,c0r0_west,c1r0_east,9\n0,60,c0r0_west,c1r0_south,3\n"), "");
}

TEST(TrafficFile, MustExist) {
    const std::string error =
        error_of("network: {kind: grid}\nduration: 600 s\ndemand: {kind: counts, counts: no.csv}\n");
    EXPECT_TRUE(contains(error, "test.yaml:3"));
    EXPECT_TRUE(contains(error, "field 'demand.counts': "));
    EXPECT_TRUE(contains(error, "no.csv: the file does not exist or cannot be read"));
    EXPECT_TRUE(contains(error_of("network: {kind: grid}\nduration: 600 s\ndemand: {kind: od}\n"), "od"));
}

TEST(TrafficFile, MustNotBeEmpty) {
    EXPECT_TRUE(contains(traffic_error("counts", ""), "traffic.csv: the file is empty"));
}

TEST(TrafficFile, NamesPlaceColumnAndValue) {
    EXPECT_TRUE(contains(counts_error("0,60,c0r0_west,9,0,6,3\n60,12o,c0r0_west,0,0,0,0\n"),
                         "traffic.csv:3:4: end: value '12o' is not a time: a number from 0 to 1e+06"));
    EXPECT_TRUE(
        contains(counts_error("0,60,c0r0_west,9.5,0,6,3\n"),
                 "traffic.csv:2:16: vehicles: value '9.5' is not a number of vehicles: a whole number from 0 to"));
    EXPECT_TRUE(contains(counts_error("0,60,c0r0_west,-1,0,6,3\n"), "value '-1' is not a number of vehicles"));
    EXPECT_TRUE(
        contains(counts_error("60,60,c0r0_west,9,0,6,3\n"), "traffic.csv:2:4: end: value 60 must be above begin"));
    EXPECT_TRUE(contains(counts_error("0,60,c0r0_wset,9,0,6,3\n"),
                         "traffic.csv:2:6: approach: vehicles do not enter the network at 'c0r0_wset'; did you mean "
                         "'c0r0_west'?"));
    EXPECT_TRUE(contains(counts_error("0,60,c0r0_east,9,0,6,3\n"), "do not enter the network at 'c0r0_east'"));
    EXPECT_TRUE(contains(counts_error("0,60,c0r0_west,9,0,6\n"), "traffic.csv:2: the number of fields is 6"));
    EXPECT_TRUE(contains(counts_error(""), "traffic.csv:1: the file has no row below its header"));
}

TEST(TrafficFile, NeedsItsColumns) {
    EXPECT_TRUE(contains(traffic_error("counts", "begin,end,aproach,vehicles\n"),
                         "unknown column 'aproach'; did you mean 'approach'?"));
    EXPECT_TRUE(contains(traffic_error("counts", "begin,end,approach\n"), "there is no column 'vehicles'"));
    EXPECT_TRUE(contains(traffic_error("counts", "begin,end,approach,vehicles,left\n"),
                         "there is no column 'straight' (left, straight and right belong together)"));
    EXPECT_TRUE(contains(traffic_error("counts", "begin,end,approach,vehicles,end\n"), "column 'end' appears twice"));
    EXPECT_TRUE(contains(traffic_error("od", kCountsHeader), "unknown column 'approach'"));
}

TEST(TrafficFile, NeedsCommas) {
    EXPECT_TRUE(contains(traffic_error("counts", "begin;end;approach;vehicles\n0;60;c0r0_west;9\n"),
                         "traffic.csv:1: semicolons separate the columns: use commas instead"));
    EXPECT_TRUE(contains(traffic_error("counts", "begin;end;approach;vehicles\n0,0;60;c0r0_west;9\n"), "use commas"));
}

TEST(TrafficFile, NeedsTurnsThatExistAndSumUp) {
    EXPECT_TRUE(contains(counts_error("0,60,c0r0_west,9,0,6,2\n"),
                         "traffic.csv:2:16: vehicles: value 9 is not left + straight + right = 8"));
    EXPECT_TRUE(contains(counts_error("0,60,c0r0_west,9,1,6,2\n"),
                         "left: value 1: no lane of 'c0r0_west' allows this movement"));
}

TEST(TrafficFile, NeedsIntervalsWithoutGapAndOverlap) {
    EXPECT_TRUE(contains(counts_error("0,60,c0r0_west,9,0,6,3\n50,120,c0r0_west,0,0,0,0\n"),
                         "traffic.csv:3: the interval 50 to 120 s of approach 'c0r0_west' overlaps another one"));
    EXPECT_TRUE(contains(counts_error("0,60,c0r0_west,9,0,6,3\n90,120,c0r0_west,0,0,0,0\n"),
                         "traffic.csv:3: the interval 60 to 90 s of approach 'c0r0_west' is missing before this line"));
    EXPECT_TRUE(contains(counts_error("0,60,c0r0_west,9,0,6,3\n0,120,c1r0_east,0,0,0,0\n"),
                         "traffic.csv:2: the interval 60 to 120 s of approach 'c0r0_west' is missing after this line"));
    EXPECT_TRUE(contains(matrix_error("0,60,c0r0_west,c1r0_east,9\n60,120,c0r0_west,c1r0_east,9\n"
                                      "0,120,c0r0_west,c1r0_south,9\n"),
                         "rows with the same origin must have the same intervals"));
}

TEST(TrafficFile, NeedsVehiclesWithinTheRun) {
    EXPECT_TRUE(contains(counts_error("25200,26100,c0r0_west,9,0,6,3\n"),
                         "traffic.csv:2:1: begin: value 25200: all rows begin at or after the end of the run, 600 s"));
    EXPECT_EQ(counts_error("0,600,c0r0_west,9,0,6,3\n600,1200,c0r0_west,9,0,6,3\n"), "");
}

TEST(TrafficFile, NeedsDestinationsThatCanBeReached) {
    EXPECT_TRUE(contains(matrix_error("0,60,c0r0_west,c1r0_north,9\n"),
                         "traffic.csv:2:16: destination: no path leads from 'c0r0_west' to 'c1r0_north'"));
    EXPECT_TRUE(contains(matrix_error("0,60,c0r0_west,c1r0_est,9\n"),
                         "destination: vehicles do not leave the network at 'c1r0_est'; did you mean 'c1r0_east'?"));
}

TEST(TrafficFile, ReplacesTurnSharesAndInitialQueues) {
    const std::string rows = std::string(kMatrixHeader) + "0,60,c0r0_west,c1r0_east,9\n";
    EXPECT_TRUE(
        contains(traffic_error("od", rows, ", right: 10 %"), "field 'demand.right': has no effect with kind od"));
    EXPECT_TRUE(contains(traffic_error("od", rows, ", start: queued"), "value 'queued' is not possible with kind od"));
}

TEST(TrafficFile, ChangesTheHashOfTheScenario) {
    const auto hash_with = [](const std::string& vehicles) {
        const TemporaryFolder folder;
        std::ofstream(folder.path() / "traffic.csv") << "begin,end,approach,vehicles\n0,60,west," + vehicles + "\n";
        return parse_scenario("{network: {kind: grid}, duration: 600 s, demand: {kind: counts, counts: traffic.csv}}",
                              "test.yaml", {}, folder.path())
            .hash;
    };
    EXPECT_EQ(hash_with("5"), hash_with("5"));
    EXPECT_NE(hash_with("5"), hash_with("6"));
}

TEST(DemandProfile, MustBeginAtZeroAndRise) {
    const auto profile_error = [](const std::string& profile) {
        return error_of("{network: {kind: grid}, duration: 600 s, demand: {kind: rate, profile: " + profile + "}}");
    };
    EXPECT_EQ(profile_error("[{from: 0 min, inflow: 60 %}, {from: 5 min, inflow: 100 %}]"), "");
    EXPECT_TRUE(contains(profile_error("[{from: 1 min, inflow: 60 %}]"),
                         "field 'demand.profile[0].from': the profile must begin at 0 min, not at 1 min"));
    EXPECT_TRUE(contains(profile_error("[{from: 0 min, inflow: 60 %}, {from: 0 min, inflow: 100 %}]"),
                         "field 'demand.profile[1].from': value 0 min must be above the time before, 0 min"));
}

TEST(DemandArrivals, PlatoonsMustFitIntoTheTime) {
    const std::string rate = error_of(
        "network: {kind: intersection}\n"
        "demand: {kind: rate, arrivals: platooned, inflow: 1800 veh/h, platoon_headway: 50 s}\n");
    EXPECT_TRUE(contains(rate, "test.yaml:2:")) << rate;
    EXPECT_TRUE(contains(rate, "field 'demand.platoon_headway': 50 s is too long for up to 900 veh/h per lane"))
        << rate;
    const std::string counts = traffic_error("counts", std::string(kCountsHeader) + "0,60,c0r0_west,9,0,6,3\n",
                                             ", arrivals: platooned, platoon_headway: 50 s");
    EXPECT_TRUE(contains(counts, "field 'demand.platoon_headway': 50 s is too long for the ")) << counts;
    EXPECT_TRUE(contains(rate, "give at most 3.96 s, or a lower demand.inflow")) << rate;
}

TEST(DemandArrivals, AreForDemandWithArrivals) {
    const std::string error =
        error_of("{network: {kind: grid}, duration: 600 s, demand: {kind: saturated, arrivals: poisson}}");
    EXPECT_TRUE(contains(error, "demand.arrivals"));
    EXPECT_TRUE(contains(error_of("{network: {kind: grid}, duration: 600 s, demand: {kind: rate, platoon_size: 3}}"),
                         "demand.platoon_size"));
}

}  // namespace
}  // namespace stopline
