// Right of way in imported networks: priority by phase, all-way stops, zippers, right before left, minor roads,
// roundabouts and full exits. Each case runs in both fidelities, with a constant distance gap and with a constant time
// gap.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "base/containers/index.h"
#include "base/io/output.h"
#include "base/speed_thresholds.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/junction/arrivals.h"
#include "sim/step/simulation.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::SumoFiles;

struct Input {
    std::string net;  // name of a file in tests/data/right_of_way
    std::string routes;
    std::string additional = {};
    double duration_s = 300.0;
    std::string keep_clear = "off";
};

constexpr double kEarly_s = 120.0;

// The vehicles of one approach lane.
struct LaneCounts {
    std::set<int> present;
    std::set<int> stopped;             // vehicles that have been slower than kCrawlingSpeed_mps on the lane
    std::set<int> yielded;             // vehicles that have yielded on the lane
    std::map<int, double> stopped_at;  // [vehicle] start of its present stop, s
    int passed = 0;                    // number of vehicles that have left the lane
};

// The events of one run.
struct Observed {
    std::map<std::string, LaneCounts> lanes;
    std::size_t most_standing = 0;  // largest number of lanes whose first vehicles were stopped at the same time
    double longest_stop_s = 0.0;    // longest stop of any vehicle while it was the first vehicle of its lane
    std::int64_t exited_early = 0;  // number of vehicles that exited in the first 120 s
    std::int64_t exited = 0;
    Violations violations;

    int passed(const std::string& lane) const { return lanes.at(lane).passed; }
    int stopped(const std::string& lane) const { return static_cast<int>(lanes.at(lane).stopped.size()); }
    int yielded(const std::string& lane) const { return static_cast<int>(lanes.at(lane).yielded.size()); }
};

struct Setting {
    const char* fidelity;
    const char* population;
};

class ImportedRightOfWay : public ::testing::TestWithParam<Setting> {
protected:
    static Model model_of(const Input& input) {
        const SumoFiles files;
        const std::filesystem::path data = std::filesystem::path(STOPLINE_TEST_DATA_DIR) / "right_of_way";
        files.write("my.net.xml", read_file(data / (input.net + ".net.xml")));
        files.write("my.rou.xml", "<routes>\n" + input.routes + "</routes>\n");
        files.write("my.add.xml", "<additional>" + input.additional + "</additional>\n");
        const std::string text =
            std::string("fidelity: ") + GetParam().fidelity + "\nduration: " + std::to_string(input.duration_s) +
            " s\nnetwork: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml], additional: [./my.add.xml]}\n"
            "populations: [" +
            GetParam().population + "]\nrules: {keep_clear: " + input.keep_clear + "}\nmeasure: {window: 60 s}\n";
        return build_model(parse_scenario(text, "my.yaml", {}, files.folder()), 0);
    }

    // Runs the input and looks at all approach lanes in each step.
    static Observed run(const Input& input) {
        const Model model = model_of(input);
        Simulation simulation(model);
        Observed seen;
        while (simulation.time_s() < input.duration_s) {
            simulation.step();
            if (simulation.time_s() <= kEarly_s) seen.exited_early = simulation.state().records.exited;
            std::size_t standing = 0;
            for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
                if (model.graph.lanes[at(lane)].origin >= 0) continue;
                LaneCounts& counts = seen.lanes[model.graph.lanes[at(lane)].name];
                look_at_lane(simulation, lane, counts);
                const LaneBlock& block = simulation.state().blocks[at(lane)];
                if (block.count == 0) continue;
                const auto first = counts.stopped_at.find(simulation.state().vehicles.id[at(block.first)]);
                if (first == counts.stopped_at.end()) continue;
                ++standing;
                seen.longest_stop_s = std::max(seen.longest_stop_s, simulation.time_s() - first->second);
            }
            seen.most_standing = std::max(seen.most_standing, standing);
        }
        seen.exited = simulation.state().records.exited;
        seen.violations = simulation.state().records.violations;
        return seen;
    }

    static void look_at_lane(const Simulation& simulation, int lane, LaneCounts& counts) {
        const State& state = simulation.state();
        const LaneBlock& block = state.blocks[at(lane)];
        std::set<int> now;
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const int id = state.vehicles.id[at(slot)];
            now.insert(id);
            if (had_to_wait(state, slot)) counts.yielded.insert(id);
            if (state.vehicles.speed_mps[at(slot)] < kCrawlingSpeed_mps) {
                counts.stopped.insert(id);
                counts.stopped_at.try_emplace(id, simulation.time_s());
            } else {
                counts.stopped_at.erase(id);
            }
        }
        for (const int id : counts.present) counts.passed += now.contains(id) ? 0 : 1;
        counts.present = std::move(now);
    }

    static std::string flow(const std::string& from, const std::string& to, const std::string& rate,
                            const std::string& more = "") {
        return "<flow id=\"" + from + to + "\" from=\"" + from + "\" to=\"" + to + R"(" begin="0" end="1000" )" + rate +
               " departSpeed=\"max\" " + more + "/>\n";
    }
};

INSTANTIATE_TEST_SUITE_P(Settings, ImportedRightOfWay,
                         ::testing::Values(Setting{"meso", "CTG-Ref"}, Setting{"meso", "CDG"},
                                           Setting{"full", "CTG-Ref"}, Setting{"full", "CDG"}),
                         [](const auto& setting) {
                             return std::string(setting.param.fidelity) +
                                    (std::string(setting.param.population) == "CDG" ? "_CDG" : "_CTG");
                         });

// Two streets merge at a signal. For 30 s the first street has priority (letter G) and the second street yields (letter
// g). Then they swap for 30 s, and so on. 43 vehicles enter each street. Those that still drive at the end of the run
// have not passed yet. In SUMO, 39 vehicles of each street pass.
TEST_P(ImportedRightOfWay, PriorityFollowsThePhase) {
    const std::string rate = "period=\"7\"";
    const Observed seen = run({"merge_signal", flow("ac", "cd", rate) + flow("bc", "cd", rate),
                               R"(<tlLogic id="c" type="static" programID="p" offset="0">)"
                               R"(<phase duration="30" state="Gg"/><phase duration="30" state="gG"/></tlLogic>)"});
    for (const char* const lane : {"ac_0", "bc_0"}) {
        EXPECT_GE(seen.passed(lane), 37) << lane;
        EXPECT_GE(seen.yielded(lane), 3) << lane;
    }
    EXPECT_LT(seen.longest_stop_s, 30.0);
    EXPECT_TRUE(seen.violations.none());
}

// Four streets with 300 veh/h each meet at an all-way stop. Every vehicle stops at its line, and the first vehicle
// of each lane waits for a few other vehicles at most.
TEST_P(ImportedRightOfWay, AllWayStopServesVehiclesInTheirOrder) {
    std::string flows;
    for (const std::string trip : {"nieo", "eiso", "siwo", "wino", "niso", "eiwo", "sino", "wieo"})
        flows += flow(trip.substr(0, 2), trip.substr(2), "vehsPerHour=\"150\"");
    const Observed seen = run({"all_way_stop", flows});
    for (const char* const lane : {"ni_0", "ei_0", "si_0", "wi_0"}) {
        EXPECT_GE(seen.passed(lane), 19) << lane;
        EXPECT_GE(seen.stopped(lane), seen.passed(lane)) << lane;
    }
    EXPECT_LT(seen.longest_stop_s, 15.0);
    EXPECT_TRUE(seen.violations.none());
}

// Two lanes become one. At 1200 veh/h no vehicle stops. Above capacity the first vehicles of both lanes go in turn, so
// none of them is stopped for long. In SUMO, 57 vehicles of this dense traffic arrive in 200 s.
TEST_P(ImportedRightOfWay, ZipperMergesInTurn) {
    const Observed light =
        run({"zipper", flow("ab", "bc", "vehsPerHour=\"1200\"", "departLane=\"random\""), "", 200.0});
    EXPECT_LT(light.longest_stop_s, 1.0);
    EXPECT_TRUE(light.violations.none());
    const Observed dense = run({"zipper", flow("ab", "bc", "vehsPerHour=\"3600\"", "departLane=\"free\""), "", 200.0});
    EXPECT_GT(dense.exited, 45);
    EXPECT_GE(dense.stopped("ab_0") + dense.stopped("ab_1"), 40);
    EXPECT_LT(dense.longest_stop_s, 5.0);
    EXPECT_TRUE(dense.violations.none());
}

// The front of a lorry is on the exit lane while its rear is still on its connection.
TEST_P(ImportedRightOfWay, ZipperLeavesRoomForTheRearsOfLorries) {
    const Observed seen = run({"zipper",
                               "<vType id=\"lorry\" length=\"16.5\"/>\n" +
                                   flow("ab", "bc", "vehsPerHour=\"3600\" type=\"lorry\"", "departLane=\"free\""),
                               "", 200.0});
    EXPECT_GT(seen.exited, 15);
    EXPECT_TRUE(seen.violations.none());
}

// Four vehicles that go straight on arrive from four sides. Each of them has another one on its right.
TEST_P(ImportedRightOfWay, RightBeforeLeftDoesNotLock) {
    const auto trip = [](const std::string& from, const std::string& to, double depart_s) {
        return "<trip id=\"" + from + "\" depart=\"" + std::to_string(depart_s) + "\" from=\"" + from + "\" to=\"" +
               to + "\" departSpeed=\"max\"/>\n";
    };
    std::size_t most_standing = 0;
    for (int n = 0; n < 16; ++n) {
        const int west = n / 4;
        const int south = 1 + n % 4;
        const Observed seen = run({"right_before_left",
                                   trip("ei", "wo", 0.0) + trip("ni", "so", 0.0) + trip("wi", "eo", 0.5 * west) +
                                       trip("si", "no", 0.5 * south),
                                   "", 60.0});
        most_standing = std::max(most_standing, seen.most_standing);
        EXPECT_EQ(seen.exited, 4) << n;
        EXPECT_LT(seen.longest_stop_s, 15.0) << n;
        EXPECT_TRUE(seen.violations.none()) << n;
    }
    EXPECT_GE(most_standing, 3u);
}

// The vehicles of the major road have equal headways, and vehicles of the minor road enter between them. Headways below
// the critical gap of 5 s admit no vehicle. A headway of 8 s admits one vehicle, and a second one if the follow-up time
// is at most 3 s.
TEST_P(ImportedRightOfWay, MinorRoadUsesGapsAboveTheCriticalGap) {
    const auto entered_per_gap = [](const std::string& period_s) {
        const Observed seen =
            run({"minor_road", flow("ac", "cd", "period=\"" + period_s + "\"") + flow("bc", "cd", "period=\"2.5\"")});
        EXPECT_TRUE(seen.violations.none());
        EXPECT_GE(seen.stopped("bc_0"), 30) << "no queue";
        return static_cast<double>(seen.passed("bc_0")) / seen.passed("ac_0");
    };
    EXPECT_EQ(entered_per_gap("4.5"), 0.0);
    const double of_eight_s = entered_per_gap("8");
    EXPECT_GT(of_eight_s, 1.2);
    EXPECT_LT(of_eight_s, 3.0);
}

// All four entries of the roundabout have one lane and are saturated. With these turn shares, the flow v on the circle
// in front of an entry equals the flow c of the entry. With the critical gap t_c and the follow-up time t_f, an entry
// carries c = v e^(-v t_c) / (1 - e^(-v t_f)) (Highway Capacity Manual, two-way stops). With v = c, t_c = 5 s and t_f =
// 3 s, each entry carries 637 veh/h.
TEST_P(ImportedRightOfWay, RoundaboutReachesItsCapacity) {
    std::string flows;
    for (int k = 0; k < 4; ++k) {
        for (const int exit : {1, 2, 3}) {
            flows += flow("i" + std::to_string(k), "x" + std::to_string((k + exit) % 4),
                          exit == 2 ? "vehsPerHour=\"400\"" : "vehsPerHour=\"300\"");
        }
    }
    const Observed seen = run({"one_lane_roundabout", flows});
    const double flow_veh_h = 3600.0 * static_cast<double>(seen.exited - seen.exited_early) / (300.0 - kEarly_s);
    EXPECT_GT(flow_veh_h, 0.9 * 4.0 * 637.0);
    EXPECT_TRUE(seen.violations.none());
}

// The exit of the major street is full, because it ends at a red light. The keep-clear rule holds the vehicles of the
// major street at their line, and those of the minor street cross ahead of them.
TEST_P(ImportedRightOfWay, HeldVehiclesLetOthersGo) {
    const Observed seen =
        run({"full_exit", flow("wc", "me", "vehsPerHour=\"600\"") + flow("sc", "cn", "vehsPerHour=\"200\""),
             R"(<tlLogic id="m" type="static" programID="p" offset="0"><phase duration="1000" state="r"/></tlLogic>)",
             300.0, "on"});
    EXPECT_GE(seen.stopped("cm_0"), 5) << "the exit is not full";
    EXPECT_LE(seen.passed("wc_0"), 12) << "nobody is held";
    EXPECT_GE(seen.passed("sc_0"), 14);
    EXPECT_TRUE(seen.violations.none());
}

}  // namespace
}  // namespace stopline
