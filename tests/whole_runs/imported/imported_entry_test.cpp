// Tests of imported traffic at places where vehicles can fail to enter or to leave: full entries, signals near the
// entry, short exit lanes, crawling queues, blockages and lane drops. Each case runs in both fidelities.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/io/output.h"
#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::replaced;
using testing::SumoFiles;

std::string read_data(const std::string& name) {
    return read_file(std::filesystem::path(STOPLINE_TEST_DATA_DIR) / (name + ".net.xml"));
}

class ImportedEntry : public ::testing::TestWithParam<const char*> {
protected:
    static bool is_full() { return std::string(GetParam()) == "full"; }

    NetworkResult run(const std::string& net, const std::string& routes, int duration_s,
                      const std::string& population = "CTG-Ref") const {
        const SumoFiles files;
        files.write("my.net.xml", net);
        files.write("my.rou.xml", routes);
        const std::string text =
            std::string("fidelity: ") + GetParam() + "\nduration: " + std::to_string(duration_s) +
            " s\nnetwork: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml]}\npopulations: [" + population +
            "]\nmeasure: {window: " + std::to_string(duration_s) + " s}\n";
        return run_network(parse_scenario(text, "my.yaml", {}, files.folder()), 0);
    }
};

std::string routes_of(const std::string& body, const std::string& comment = "") {
    return comment + "<routes>\n" + body + "</routes>\n";
}

// One vehicle a second wants to enter an edge with three lanes. With SUMO's defaults since version 1.27, all of them
// enter without delay. With the older defaults, all of them start from rest on the right lane. Each enters when its
// leader has moved by its length and the standstill gap. These 7.95 m take 3.06 s at 1.7 m/s2, so 39 vehicles can enter
// in 120 s. In SUMO, 37 vehicles with the same driver enter (stopline-compare).
TEST_P(ImportedEntry, DefaultsOfDepartureDecideTheInflow) {
    const std::string flow = R"(<flow id="f" from="ab" to="bc" begin="0" end="120" vehsPerHour="3600"/>)";
    const NetworkResult present = run(read_data("three_lanes"), routes_of(flow), 120);
    EXPECT_EQ(present.entered, 120);
    EXPECT_EQ(present.backlog, 0);
    EXPECT_TRUE(present.violations.none());
    const NetworkResult old =
        run(read_data("three_lanes"),
            routes_of(flow, "<!-- generated on 2023-01-31 by Eclipse SUMO duarouter Version 1.18.0 -->\n"), 120);
    EXPECT_NEAR(static_cast<double>(old.entered), 39.0, 4.0);
    EXPECT_EQ(old.entered + old.backlog, 120);
    EXPECT_TRUE(old.violations.none());
}

// Only right turns are possible from lane 0. A truck of 16.5 m turns right and still covers the end of this lane when a
// car that turns left wants to enter there.
TEST_P(ImportedEntry, KeepsAGapToARearOnALaneWithoutTheTurn) {
    const NetworkResult result =
        run(read_data("turn_per_lane"), routes_of(R"(<vType id="truck" length="16.5" vClass="truck"/>
<trip id="first" type="truck" depart="0" from="ab" to="bc" departLane="0" departPos="last" departSpeed="0"/>
<trip id="second" depart="4" from="ab" to="bd" departLane="0" departPos="last" departSpeed="0"/>
)"),
            60);
    EXPECT_EQ(result.entered, 2);
    EXPECT_EQ(result.violations.overlaps, 0);
}

// Vehicles enter 2 to 60 m before a signal, at all times of its cycle. Each enters at a speed from which it can
// still stop at the signal.
TEST_P(ImportedEntry, NearASignalIsPossibleAtAllTimes) {
    std::string flows;
    for (const char* const position : {"-2", "-5", "-10", "-30", "-60", "last"}) {
        for (const char* const speed : {"max", "avg", "13.89"}) {
            flows += std::string("<flow id=\"") + position + speed + R"(" from="w_in" to="e_out" departPos=")" +
                     position + "\" departSpeed=\"" + speed +
                     R"(" departLane="random" begin="0" end="200" period="37"/>)" + "\n";
        }
    }
    const NetworkResult result = run(testing::signal_net(testing::two_phases()), routes_of(flows), 400);
    EXPECT_EQ(result.entered, 18 * 6);
    EXPECT_EQ(result.exited, result.entered);
    EXPECT_EQ(result.backlog, 0);
    EXPECT_TRUE(result.violations.none());
    EXPECT_EQ(result.violations.forced_red_entries, 0);
}

// A signal is red for two minutes, and the queue reaches back beyond the entry. Afterwards the flow recovers: the
// entries carry more than the demand, so that the backlog dissolves.
TEST_P(ImportedEntry, FlowRecoversAfterABlockage) {
    for (const std::string speed : {"max", "avg", "last"}) {
        const std::string flow = R"(<flow id="f" from="w_in" to="e_out" begin="0" end="420" vehsPerHour="2800" )"
                                 R"(departLane="free" departSpeed=")" +
                                 speed + "\"/>\n";
        const std::string phases = R"(<phase duration="40" state="rGGG"/><phase duration="3" state="ryyy"/>
<phase duration="117" state="Grrr"/><phase duration="900" state="rGGG"/>
)";
        const int demand = 2800 * 420 / 3600 + 1;
        const NetworkResult blocked = run(testing::signal_net(phases), routes_of(flow), 160);
        EXPECT_GT(blocked.backlog, 20) << speed;  // the queue has kept vehicles from entering
        const NetworkResult result = run(testing::signal_net(phases), routes_of(flow), 430);
        EXPECT_EQ(result.backlog, 0) << speed;
        EXPECT_EQ(result.entered, demand) << speed;
        EXPECT_TRUE(result.violations.none()) << speed;
    }
}

// Between two signals lies an exit lane of 6, 9, 12 or 16 m. A queued lorry needs about 15 m, so that it fits into the
// longest lane only. The shortest lanes hold one queued car.
TEST_P(ImportedEntry, ShortExitsLetAllVehiclesPass) {
    const std::string routes = routes_of(R"(<vType id="lorry" length="12"/>
<flow id="f" from="wc" to="de" begin="0" end="300" vehsPerHour="250" departSpeed="max"/>
<flow id="t" type="lorry" from="wc" to="de" begin="0" end="300" vehsPerHour="60" departSpeed="max"/>
<flow id="g" from="nc" to="cs" begin="0" end="300" vehsPerHour="300" departSpeed="max"/>
<flow id="h" from="sd" to="dn" begin="0" end="300" vehsPerHour="300" departSpeed="max"/>
)");
    for (const std::string length_m : {"6.00", "9.00", "12.00", "16.00"}) {
        const std::string net = replaced(read_data("short_exit"), R"(length="10.00")", "length=\"" + length_m + "\"");
        for (const char* const population : {"CTG-Ref", "CDG"}) {
            const NetworkResult result = run(net, routes, 560, population);
            EXPECT_EQ(result.entered, 21 + 5 + 25 + 25) << length_m << " m, " << population;
            EXPECT_EQ(result.exited, result.entered) << length_m << " m, " << population;
            EXPECT_EQ(result.delays.teleported, 0) << length_m << " m, " << population;
            EXPECT_TRUE(result.violations.none()) << length_m << " m, " << population;
        }
    }
}

// The queue in the exit of a junction crawls at 1.5 m/s, so its vehicles never count as stopped. Vehicles that enter
// the junction behind this queue must not keep the crossing street closed.
TEST_P(ImportedEntry, CrawlingQueueLeavesTheJunctionToOthers) {
    const NetworkResult result = run(read_data("crawling_exit"), routes_of(R"(
<flow id="we" from="wc" to="me" begin="0" end="360" vehsPerHour="900" departSpeed="max"/>
<flow id="ns" from="nc" to="cs" begin="0" end="360" vehsPerHour="300" departSpeed="max"/>
<flow id="sn" from="sc" to="cn" begin="0" end="360" vehsPerHour="300" departSpeed="max"/>
)"),
                                     450);
    const std::int64_t crossing = 2 * 30;
    EXPECT_GT(result.entered - result.exited, 30);  // there is a queue at the end of the run
    EXPECT_GT(result.exited, crossing + 15);
    EXPECT_EQ(result.delays.teleported, 0);
    EXPECT_LT(result.longest_in_junction_s, 20.0);
    EXPECT_TRUE(result.violations.none());
}

// Three lanes become two and then one, at 144 km/h and with more traffic than one lane can carry.
TEST_P(ImportedEntry, DenseFlowThroughAFastLaneDropHasNoViolation) {
    const std::string flow = R"(<flow id="f" from="ab" to="cd" begin="0" end="300" vehsPerHour="5000" )"
                             R"(departSpeed="max" departLane="free"/>)";
    for (const char* const population : {"CTG-Ref", "CDG"}) {
        const NetworkResult result = run(read_data("fast_lane_drop"), routes_of(flow), 400, population);
        EXPECT_TRUE(result.violations.none()) << population;
        EXPECT_GT(result.exited, 100) << population;
        EXPECT_GT(result.mandatory_lane_changes, 10) << population;
    }
}

// Half of the vehicles must change lanes on an edge of 16 m, which they reach at 50 km/h. They must brake before this
// edge, because they cannot stop on it from 50 km/h. Otherwise they miss their turn.
TEST_P(ImportedEntry, VehiclesBrakeBeforeAShortEdgeWithALaneChange) {
    const std::string routes = routes_of(R"(<flow id="f" from="in" to="straight" begin="0" end="300" vehsPerHour="300"
      departSpeed="max"/>
<flow id="g" from="in" to="right" begin="0" end="300" vehsPerHour="300" departSpeed="max"/>
)");
    for (const std::string population : {"CTG-Ref", "CDG"}) {
        const NetworkResult result = run(read_data("short_weave"), routes, 400, population);
        EXPECT_EQ(result.entered, 25 + 25) << population;
        EXPECT_EQ(result.exited, result.entered) << population;
        EXPECT_EQ(result.missed_turns, 0) << population;
        EXPECT_TRUE(result.violations.none()) << population;
    }
}

INSTANTIATE_TEST_SUITE_P(BothFidelities, ImportedEntry, ::testing::Values("meso", "full"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace stopline
