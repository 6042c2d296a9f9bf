// Tests of imported SUMO networks: the lane graph, right of way, signals, warnings and errors.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sumo_import/sumo_graph.h"
#include "sumo_import/sumo_net.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::crossing_net;
using testing::fork_net;
using testing::refusal;
using testing::replaced;
using testing::signal_net;
using testing::SumoFiles;
using testing::turnaround_net;
using testing::two_phases;

constexpr double kClearance_m = 2.0;

SumoNetwork network_of(const std::string& text, const std::string& additional = "") {
    const SumoFiles files;
    SumoNet net = read_sumo_net(files.write("my.net.xml", text));
    if (!additional.empty()) read_sumo_additional(files.write("my.add.xml", additional), net);
    return make_sumo_network(std::move(net), kClearance_m);
}

int lane_of(const LaneGraph& graph, const std::string& name) {
    const auto found =
        std::find_if(graph.lanes.begin(), graph.lanes.end(), [&](auto& lane) { return lane.name == name; });
    return found == graph.lanes.end() ? -1 : static_cast<int>(found - graph.lanes.begin());
}

const Lane& lane(const LaneGraph& graph, const std::string& name) {
    return graph.lanes.at(static_cast<std::size_t>(lane_of(graph, name)));
}

const Conflict* conflict(const LaneGraph& graph, const std::string& lane_name, const std::string& other_name) {
    const int other = lane_of(graph, other_name);
    for (const Conflict& c : graph.conflicts_of(lane_of(graph, lane_name))) {
        if (c.other == other) return &c;
    }
    return nullptr;
}

TEST(SumoNetwork, GreenTimesSpanSeveralPhases) {
    SumoNetwork network;
    // The second link is green over three phases and across the end of the cycle. The third link is always green.
    network.net.signals.push_back(
        {"one", "0", 0.0, {{30.0, "GgG"}, {30.0, "rGG"}, {4.0, "ryG"}, {20.0, "rrg"}, {5.0, "rGG"}}, "", true});
    EXPECT_DOUBLE_EQ(network.longest_cycle_s(), 89.0);
    EXPECT_DOUBLE_EQ(network.longest_green_s(), 65.0);
    network.net.signals[0].phases = {{30.0, "G"}};
    EXPECT_DOUBLE_EQ(network.longest_green_s(), 40.0) << "the green never ends";
}

TEST(SumoNetwork, HasCarLanesAndTheirNeighbours) {
    const SumoNetwork network = network_of(crossing_net());
    check(network.graph);
    EXPECT_EQ(network.graph.lanes.size(), 6U + 4U);  // without the lane for bicycles
    EXPECT_EQ(lane_of(network.graph, "n_out_0"), -1);
    const Lane& left = lane(network.graph, "w_in_1");
    EXPECT_EQ(left.right, lane_of(network.graph, "w_in_0"));
    EXPECT_EQ(left.left, -1);
    EXPECT_DOUBLE_EQ(left.stop_line_m, 190.0);
    EXPECT_DOUBLE_EQ(left.limit_mps, 13.89);
    EXPECT_EQ(left.next.size(), 2U);
    EXPECT_EQ(lane(network.graph, "e_out_0").signal_group, -1);
    EXPECT_EQ(left.signal_group, 0);  // always green
}

TEST(SumoNetwork, JoinsViaLanesIntoOneConnection) {
    const SumoNetwork network = network_of(crossing_net());
    const Lane& turning = lane(network.graph, ":J_3_0");
    EXPECT_EQ(turning.turn, Turn::left);
    EXPECT_EQ(lane_of(network.graph, ":J_4_0"), -1);
    EXPECT_EQ(turning.shape.size(), 5U);
    EXPECT_NEAR(turning.length_m + turning.shape_start_m, length_m(turning.shape), 1e-9);
    EXPECT_GT(turning.shape_start_m, 1.0);  // the stretch shared with the straight connection
    EXPECT_DOUBLE_EQ(turning.shape_start_m, lane(network.graph, ":J_1_1").shape_start_m);
    EXPECT_DOUBLE_EQ(turning.limit_mps, 7.0);
}

TEST(SumoNetwork, ConnectionsOfALaneShareAStretchUntilTheyDiverge) {
    const SumoNetwork network = network_of(turnaround_net());
    const std::vector<int>& connections = lane(network.graph, "a_0").next;
    ASSERT_EQ(connections.size(), 3U);
    for (const int index : connections) {
        const Lane& connection = network.graph.lanes[static_cast<std::size_t>(index)];
        EXPECT_NEAR(connection.length_m + connection.shape_start_m, length_m(connection.shape), 1e-9)
            << connection.name;
        EXPECT_NEAR(connection.shape_start_m, lane(network.graph, "a_0").length_m - 100.0, 1e-9);
        EXPECT_LT(connection.diverge_end_m, 0.5) << "the connections begin before the movements diverge";
        for (const int other_index : connections) {
            if (index == other_index) continue;
            const Lane& other = network.graph.lanes[static_cast<std::size_t>(other_index)];
            for (double m = connection.shape_start_m + connection.diverge_end_m; m <= length_m(connection.shape);
                 m += 0.1) {
                EXPECT_GE(distance_m(other.shape, pose_along(connection, m).point), kClearance_m - 0.05)
                    << connection.name << m;
            }
        }
    }
    EXPECT_LT(length_m(lane(network.graph, ":J_2_0").shape), 4.5 + 8.0)
        << "the U-turn reaches too far into the junction";
}

TEST(SumoNetwork, EachPairOfConnectionsDivergesAtItsOwnPosition) {
    const SumoNetwork network = network_of(fork_net());
    const std::vector<int>& connections = lane(network.graph, "a_0").next;
    ASSERT_EQ(connections.size(), 3U);
    // The distance from the stop line at which a connection has diverged from another one of the list.
    const auto diverge_m = [&](std::size_t one, std::size_t other) {
        const Lane& connection = network.graph.lanes[static_cast<std::size_t>(connections[one])];
        return connection.shape_start_m + connection.diverge_ends_m.at(other);
    };
    const Lane& straight = lane(network.graph, ":J_1_0");
    EXPECT_LT(diverge_m(1, 0), 6.0);   // of the connections to c and d
    EXPECT_LT(diverge_m(2, 0), 6.0);   // to b and d
    EXPECT_GT(diverge_m(1, 2), 25.0);  // to c and b
    EXPECT_DOUBLE_EQ(diverge_m(1, 2), diverge_m(2, 1));
    EXPECT_DOUBLE_EQ(straight.diverge_ends_m[2], straight.diverge_end_m) << "the last pair diverges here";
    const SumoNetwork crossing = network_of(crossing_net());
    for (const Lane& other : crossing.graph.lanes) {
        EXPECT_TRUE(other.diverge_ends_m.empty()) << "two connections diverge at one position";
    }
}

TEST(SumoNetwork, ScalesShapesToTheStatedLengths) {
    const std::string longer = replaced(turnaround_net(), "id=\"d_0\" index=\"0\" speed=\"13.89\" length=\"100\"",
                                        "id=\"d_0\" index=\"0\" speed=\"13.89\" length=\"125\"");
    const SumoNetwork network = network_of(longer);
    EXPECT_DOUBLE_EQ(lane(network.graph, "d_0").length_m, 125.0);
    EXPECT_NEAR(pose_along(lane(network.graph, "d_0"), 125.0).point.y_m, -108.0, 1e-9);
    EXPECT_NEAR(pose_along(lane(network.graph, "c_0"), 25.0).point.x_m, 39.0, 1e-9);
}

TEST(SumoNetwork, YieldsByTheRequestMatrix) {
    const LaneGraph graph = network_of(crossing_net()).graph;
    const Conflict* const minor = conflict(graph, ":J_0_0", ":J_1_0");
    ASSERT_NE(minor, nullptr);
    EXPECT_TRUE(minor->yields);
    EXPECT_FALSE(minor->other_yields);
    EXPECT_NEAR(minor->from_m, 10.0 - 4.8 - kClearance_m, 0.3);
    EXPECT_NEAR(minor->to_m, 10.0 - 4.8 + kClearance_m, 0.3);
    const Conflict* const major = conflict(graph, ":J_1_0", ":J_0_0");
    ASSERT_NE(major, nullptr);
    EXPECT_FALSE(major->yields);
    EXPECT_TRUE(major->other_yields);
    EXPECT_NE(conflict(graph, ":J_0_0", ":J_3_0"), nullptr);  // they merge into one lane
    EXPECT_EQ(conflict(graph, ":J_1_0", ":J_1_1"), nullptr);
}

TEST(SumoNetwork, BothLinksYieldIfTheMatrixSaysSo) {
    const std::string text = replaced(crossing_net(), "index=\"1\" response=\"0000\"", "index=\"1\" response=\"0001\"");
    const LaneGraph graph = network_of(text).graph;
    EXPECT_TRUE(conflict(graph, ":J_0_0", ":J_1_0")->yields);
    EXPECT_TRUE(conflict(graph, ":J_1_0", ":J_0_0")->yields);
    EXPECT_TRUE(conflict(graph, ":J_0_0", ":J_1_1")->yields);
}

TEST(SumoNetwork, TheLeftLaneYieldsAtALaneDrop) {
    const LaneGraph graph = network_of(testing::lane_drop_net()).graph;
    int yielding = 0;
    for (std::size_t k = 0; k < graph.lanes.size(); ++k) {
        for (const Conflict& conflict : graph.conflicts_of(static_cast<int>(k))) {
            EXPECT_NE(conflict.yields, conflict.other_yields);
            if (!conflict.yields) continue;
            ++yielding;
            EXPECT_EQ(graph.lanes[static_cast<std::size_t>(graph.lanes[k].origin)].name, "a_1");
        }
    }
    EXPECT_EQ(yielding, 1);
}

TEST(SumoNetwork, LinksThatAreNeverGreenTogetherDoNotYield) {
    const LaneGraph apart = network_of(signal_net(two_phases())).graph;
    EXPECT_FALSE(conflict(apart, ":J_0_0", ":J_1_0")->yields);
    EXPECT_FALSE(conflict(apart, ":J_1_0", ":J_0_0")->yields);
    const LaneGraph together = network_of(signal_net("<phase duration=\"30\" state=\"gGGG\"/>")).graph;
    EXPECT_TRUE(conflict(together, ":J_0_0", ":J_1_0")->yields);
    // The signal letters G (priority) and g (yields) override SUMO's request matrix, the `response` attributes.
    const std::string text = replaced(signal_net("<phase duration=\"30\" state=\"GggG\"/>"),
                                      "index=\"0\" response=\"1110\"", "index=\"0\" response=\"0000\"");
    const LaneGraph letters = network_of(text).graph;
    EXPECT_TRUE(conflict(letters, ":J_1_0", ":J_0_0")->yields);
    EXPECT_FALSE(conflict(letters, ":J_0_0", ":J_1_0")->yields);
}

TEST(SumoNetwork, MovementsOfALaneCanHaveTheirOwnSignals) {
    const LaneGraph common = network_of(signal_net(two_phases())).graph;
    EXPECT_EQ(lane(common, ":J_3_0").movement_signal_group, -1);
    EXPECT_EQ(lane(common, "w_in_0").signal_group, lane(common, "w_in_1").signal_group);
    const LaneGraph separate =
        network_of(signal_net("<phase duration=\"20\" state=\"rGGr\"/><phase duration=\"9\" state=\"rrrG\"/>")).graph;
    EXPECT_GE(lane(separate, ":J_3_0").movement_signal_group, 1);
    EXPECT_GE(lane(separate, ":J_1_1").movement_signal_group, 1);
    EXPECT_NE(lane(separate, ":J_3_0").movement_signal_group, lane(separate, ":J_1_1").movement_signal_group);
}

TEST(SumoNetwork, ShortLanesBeforeASignalHaveALowerEntrySpeed) {
    // Lane n_out ends at a signal after 12 m. With a margin of 2 m, vehicles must be able to stop in 10 m at 3 m/s2.
    std::string text = signal_net(two_phases());
    text = replaced(text, "length=\"190.00\" shape=\"1.60,10.00 1.60,200.00\"",
                    "length=\"12.00\" shape=\"1.60,10.00 1.60,22.00\"");
    text = replaced(
        text, "    <junction id=\"J\"",
        "    <edge id=\"far\" from=\"N\" to=\"S\"><lane id=\"far_0\" index=\"0\" speed=\"13.89\" length=\"100\" "
        "shape=\"1.6,30 1.6,130\"/></edge>\n    <junction id=\"J\"");
    text = replaced(text, "</net>",
                    "<connection from=\"n_out\" to=\"far\" fromLane=\"1\" toLane=\"0\" tl=\"J\" "
                    "linkIndex=\"0\" dir=\"s\" state=\"o\"/></net>");
    EXPECT_NEAR(lane(network_of(text).graph, ":J_0_0").limit_mps, std::sqrt(2.0 * 3.0 * 10.0), 1e-9);
}

TEST(SumoNetwork, AdditionalFilesReplaceProgrammesAndOffsets) {
    const SumoNetwork offset = network_of(signal_net(two_phases()),
                                          "<additional><tlLogic id=\"J\" programID=\"0\" "
                                          "offset=\"7.5\"/></additional>");
    EXPECT_DOUBLE_EQ(offset.net.signals[0].offset_s, 7.5);
    EXPECT_EQ(offset.net.signals[0].phases.size(), 4U);
    const SumoNetwork other =
        network_of(signal_net(two_phases()),
                   "<additional><tlLogic id=\"J\" programID=\"b\" offset=\"1\"><phase duration=\"50\" state=\"GGrr\"/>"
                   "</tlLogic><e1Detector id=\"d\" lane=\"w_in_0\" pos=\"-10\" file=\"x\"/></additional>");
    EXPECT_EQ(other.net.signals[0].phases.size(), 1U);
    ASSERT_EQ(other.net.loops.size(), 1U);
    EXPECT_DOUBLE_EQ(other.net.loops[0].position_m, 180.0);
}

// Returns signal_net() without its signal programme.
std::string without_programme() {
    std::string text = signal_net(two_phases());
    const std::size_t from = text.find("<tlLogic");
    return text.erase(from, text.find("</tlLogic>") + 10 - from);
}

TEST(SumoNetwork, ProgrammesMayComeFromAdditionalFilesOnly) {
    const std::string offset = "<tlLogic id=\"J\" programID=\"a\" offset=\"7\"/>";
    const std::string programme = "<tlLogic id=\"J\" programID=\"a\" offset=\"3\">" + two_phases() + "</tlLogic>";
    const SumoNetwork network = network_of(without_programme(), "<additional>" + programme + "</additional>");
    const SumoNetwork usual = network_of(signal_net(two_phases()));
    ASSERT_EQ(network.net.signals.size(), 1U);
    EXPECT_EQ(network.net.signals[0].phases.size(), 4U);
    EXPECT_DOUBLE_EQ(network.net.signals[0].offset_s, 3.0);
    EXPECT_EQ(network.lights.size(), usual.lights.size());
    EXPECT_EQ(lane(network.graph, "s_in_0").signal_group, lane(usual.graph, "s_in_0").signal_group);
    EXPECT_FALSE(conflict(network.graph, ":J_0_0", ":J_1_0")->yields);  // the two are never green together
    EXPECT_DOUBLE_EQ(
        network_of(without_programme(), "<additional>" + programme + offset + "</additional>").net.signals[0].offset_s,
        7.0);
}

TEST(SumoNetwork, SignalsWithoutAProgrammeAreRefused) {
    const auto message_of = [](const std::string& additional) {
        return refusal([&] { network_of(without_programme(), "<additional>\n" + additional + "\n</additional>"); });
    };
    EXPECT_NE(message_of("").find("tl=\"J\": neither the network nor the additional files have a tlLogic with this id"),
              std::string::npos)
        << message_of("");
    EXPECT_EQ(message_of(R"(<tlLogic id="J" programID="a" offset="1"/>)"),
              "my.add.xml:2: tlLogic 'J' has no phase; it needs at least one");
    EXPECT_EQ(message_of(R"(<tlLogic id="K"><phase duration="9" state="G"/></tlLogic>)"),
              "my.add.xml:2: tlLogic 'K': the network has no signal with this id");
    const std::string few = message_of(R"(<tlLogic id="J"><phase duration="9" state="Grr"/></tlLogic>)");
    EXPECT_NE(few.find("linkIndex=\"3\" must be below 3, the number of letters in the phases of tlLogic 'J'"),
              std::string::npos)
        << few;
}

TEST(SumoNetwork, WarnsAboutUnsupportedSignalTypes) {
    const std::string text = replaced(signal_net(two_phases()), "type=\"static\"", "type=\"actuated\"");
    const std::vector<std::string> lines = network_of(text).net.warnings.lines();
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NE(lines[0].find("/my.net.xml:32: signals of type 'actuated' run as fixed-time signals"), std::string::npos)
        << lines[0];
}

std::vector<std::string> warnings_of(const std::string& text, const std::string& additional = "") {
    std::vector<std::string> lines = network_of(text, additional).net.warnings.lines();
    std::transform(lines.begin(), lines.end(), lines.begin(), testing::without_folder);
    return lines;
}

TEST(SumoNetwork, WarnsAboutIgnoredElementsOfAnyLane) {
    const std::string left =
        replaced(crossing_net(), "-1.60 -10.00,-1.60\"/>", "-1.60 -10.00,-1.60\"><neigh lane=\"s_in_0\"/></lane>");
    EXPECT_EQ(warnings_of(left),
              std::vector<std::string>{
                  "my.net.xml:19: 'neigh' is ignored: vehicles do not use lanes of the opposite direction"});
    const std::string edge =
        replaced(crossing_net(), "<lane id=\"w_in_0\"", "<stopOffset value=\"2\"/><lane id=\"w_in_0\"");
    EXPECT_EQ(warnings_of(edge), std::vector<std::string>{"my.net.xml:18: 'stopOffset' is ignored"});
}

TEST(SumoNetwork, WarnsThatInductionLoopsCountAllVehicles) {
    const auto lines = warnings_of(crossing_net(),
                                   "<additional>\n<e1Detector id=\"d\" lane=\"w_in_0\" pos=\"9\" file=\"x\" "
                                   "vTypes=\"bus\" nextEdges=\"e_out\"/></additional>");
    EXPECT_EQ(lines,
              (std::vector<std::string>{"my.add.xml:2: 'vTypes' is ignored: the detector counts all vehicles",
                                        "my.add.xml:2: 'nextEdges' is ignored: the detector counts all vehicles"}));
}

TEST(SumoNetwork, InductionLoopsBeyondTheLaneAreRefusedUnlessFriendly) {
    const auto loop = [](const std::string& attributes) {
        return network_of(crossing_net(), "<additional><e1Detector id=\"d\" lane=\"w_in_0\" file=\"x\" " + attributes +
                                              "/></additional>")
            .net.loops.at(0)
            .position_m;
    };
    for (const char* const beyond : {"pos=\"200\"", "pos=\"-200\"", "pos=\"200\" friendlyPos=\"false\""}) {
        EXPECT_NE(refusal([&] { loop(beyond); }).find("must lie on the lane, which is 190.00 m long"),
                  std::string::npos);
    }
    EXPECT_DOUBLE_EQ(loop("pos=\"200\" friendlyPos=\"true\""), 190.0);
    EXPECT_DOUBLE_EQ(loop("pos=\"-200\" friendlyPos=\"1\""), 0.0);
}

TEST(SumoNetwork, SignalsThatAreSwitchedOffAreRefused) {
    const std::string message = refusal([] {
        network_of(signal_net(two_phases()), "<additional>\n<tlLogic id=\"J\" programID=\"off\"/>\n</additional>");
    });
    EXPECT_EQ(message.find("my.add.xml:2: tlLogic 'J': programID=\"off\" switches the signal off"), 0U) << message;
}

std::string without_requests(std::string text) {
    for (std::size_t from = text.find("<request"); from != std::string::npos; from = text.find("<request")) {
        text.erase(from, text.find('\n', from) - from);
    }
    return text;
}

TEST(SumoNetwork, WarnsAboutJunctionsWithoutRequests) {
    const std::string text = without_requests(crossing_net());
    for (const std::string type : {"unregulated", "traffic_light_unregulated"}) {
        const std::string of_type = replaced(text, "type=\"priority\"", "type=\"" + type + "\"");
        EXPECT_EQ(warnings_of(of_type),
                  std::vector<std::string>{"my.net.xml:32: junction 'J' of type '" + type +
                                           "' has no requests: vehicles do not yield there, and drive through "
                                           "each other where their paths cross"});
    }
    const std::string message = refusal([&] { network_of(text); });
    EXPECT_NE(message.find("junction 'J' of type 'priority' has 4 links in 'intLanes' but 0 requests"),
              std::string::npos)
        << message;
}

TEST(SumoNetwork, WithoutRequestsTheLaterOfTwoMergingLinksYields) {
    const std::string text = without_requests(replaced(signal_net("<phase duration=\"30\" state=\"GGGG\"/>"),
                                                       "type=\"traffic_light\"", "type=\"traffic_light_unregulated\""));
    const LaneGraph graph = network_of(text).graph;
    ASSERT_NE(conflict(graph, ":J_3_0", ":J_0_0"), nullptr);
    EXPECT_TRUE(conflict(graph, ":J_3_0", ":J_0_0")->yields);
    EXPECT_FALSE(conflict(graph, ":J_0_0", ":J_3_0")->yields);
    EXPECT_EQ(conflict(graph, ":J_0_0", ":J_1_0"), nullptr);  // only <request> elements say that two links cross
}

TEST(SumoNetwork, ReadsGzippedFiles) {
    const SumoFiles files;
    const std::string text = crossing_net();
    const std::filesystem::path file = files.folder() / "my.net.xml.gz";
    const gzFile out = gzopen(file.c_str(), "wb");
    gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
    gzclose(out);
    EXPECT_EQ(read_sumo_net(file).edges.size(), 8U);
    EXPECT_EQ(read_sumo_net(file).hash, read_sumo_net(files.write("plain.net.xml", text)).hash);
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
    const std::string message = refusal([&] { read_sumo_net(file); });
    EXPECT_EQ(message.find("my.net.xml.gz:"), 0U) << message;
    EXPECT_NE(message.find(": the gzip data are damaged or end too early here"), std::string::npos) << message;
}

TEST(SumoNetwork, ReadsXmlEntitiesAndSkipsComments) {
    const std::string text =
        replaced(signal_net(two_phases()), "<net version",
                 "<!-- &up; a & b < c -->\n<?tool &up;?>\n<net title=\"&amp;&lt;&#65;&#x41;\" version");
    EXPECT_EQ(network_of(text).net.edges.size(), 8U);
    const std::string after = replaced(text, "programID=\"0\"", "programID=\"&up;\"");
    EXPECT_EQ(refusal([&] { network_of(after); }).find("my.net.xml:34: "), 0U);
}

// netconvert writes index 0 for the second of two waiting lanes inside a junction.
TEST(SumoNetwork, InternalLanesAreNumberedByTheirIds) {
    EXPECT_EQ(
        network_of(replaced(crossing_net(), "\":J_1_1\" index=\"1\"", "\":J_1_1\" index=\"0\"")).graph.lanes.size(),
        10U);
}

struct InvalidNet {
    const char* from;
    const char* to;
    const char* expected_text;
};

class SumoNetworkErrors : public ::testing::TestWithParam<InvalidNet> {};

TEST_P(SumoNetworkErrors, NameFileAndLine) {
    const auto& [from, to, expected_text] = GetParam();
    const std::string text = replaced(signal_net(two_phases()), from, to);
    const std::string message = refusal([&] { network_of(text); });
    EXPECT_NE(message.find(expected_text), std::string::npos) << message;
    EXPECT_EQ(message.find("my.net.xml"), 0U) << message;
}

INSTANTIATE_TEST_SUITE_P(
    All, SumoNetworkErrors,
    ::testing::Values(
        InvalidNet{"<net version", "<!DOCTYPE net [<!ENTITY a \"b\">]>\n<net version",
                   "my.net.xml:2: the file has a DOCTYPE"},
        InvalidNet{"length=\"190.00\"", "length=\"190.00\" length=\"9\"",
                   ":18: element 'lane': attribute 'length' is given twice"},
        InvalidNet{"programID=\"0\"", "programID=\"&up;\"", ":32: element 'tlLogic': '&up' is not an XML entity"},
        InvalidNet{"programID=\"0\"", "programID=\"a & b\"", ":32: element 'tlLogic': '&' is not an XML entity"},
        InvalidNet{"programID=\"0\"", "programID=\"&#x;\"", ":32: element 'tlLogic': '&#x' is not an XML entity"},
        InvalidNet{"</net>", "", "my.net.xml:58: the file is not well-formed XML"},
        InvalidNet{"<net ", "<sumo ", "my.net.xml:"},
        InvalidNet{"length=\"190.00\"", "length=\"-1\"", ":18: length=\"-1\""},
        InvalidNet{"length=\"190.00\"", "length=\"nan\"", ":18: element 'lane': length=\"nan\" is not a finite number"},
        InvalidNet{"speed=\"13.89\" length=\"190.00\"", "speed=\"inf\" length=\"190.00\"",
                   ":18: element 'lane': speed"},
        InvalidNet{"length=\"190.00\"", "length=\"1e999\"", ":18: element 'lane'"},
        InvalidNet{"-200.00,-4.80", "-200.00,x", ":18: 'shape' has a point"},
        InvalidNet{"-200.00,-4.80 -10.00,-4.80", "1,1", ":18: 'shape' needs at least two different points"},
        InvalidNet{"edge id=\"s_in\"", "edge id=\"w_in\"", ":25: there are two edges 'w_in'"},
        InvalidNet{"<lane id=\"w_in_1\" index=\"1\"", "<lane id=\"w_in_1\" index=\"3\"", ":19: lanes of edge 'w_in'"},
        InvalidNet{"junction id=\"E\"", "junction id=\"W\"", "there are two junctions 'W'"},
        InvalidNet{"junction id=\"E\"", "junction id=\":J_4_0\"", "there are two junctions ':J_4_0'"},
        InvalidNet{"from=\"W\"", "from=\"X\"", ":17: edge 'w_in': from=\"X\": there is no junction with this id"},
        InvalidNet{"to=\"E\"", "to=\"X\"", ":21: edge 'e_out': to=\"X\": there is no junction with this id"},
        InvalidNet{" from=\"W\"", "", ":17: element 'edge' has no attribute 'from'"},
        InvalidNet{"lane id=\"w_in_1\"", "lane id=\"w_in_0\"", ":19: lane id=\"w_in_0\" must be 'w_in_1'"},
        InvalidNet{"lane id=\":J_1_1\" index=\"1\"", "lane id=\":J_1_0\" index=\"0\"",
                   ":9: lane id=\":J_1_0\" must be ':J_1_1'"},
        InvalidNet{"incLanes=\"s_in_0", "incLanes=\"s_in_1",
                   "junction 'J': 'incLanes' names the lane 's_in_1', which does not exist"},
        InvalidNet{"incLanes=\"s_in_0", "incLanes=\"s_in",
                   "junction 'J': 'incLanes' names the lane 's_in', which does not exist"},
        InvalidNet{"intLanes=\":J_0_0 ", "intLanes=\":J_0_9 ",
                   "junction 'J': 'intLanes' names the lane ':J_0_9', which does not exist"},
        InvalidNet{"incLanes=\":J_3_0 ", "incLanes=\":J_3_1 ", "junction ':J_4_0': 'incLanes' names the lane ':J_3_1'"},
        InvalidNet{"to=\"e_out\" fromLane=\"0\"", "to=\"nowhere\" fromLane=\"0\"", ": to: there is no edge 'nowhere'"},
        InvalidNet{"fromLane=\"0\" toLane=\"0\" via=\":J_1_0\"", "fromLane=\"7\" toLane=\"0\" via=\":J_1_0\"",
                   "edge 'w_in' has no lane 7"},
        InvalidNet{"via=\":J_1_0\"", "via=\":J_9_0\"", "via: there is no lane ':J_9_0'"},
        InvalidNet{"<connection from=\":J_3\" to=\"n_out\"", "<connection from=\":J_3\" to=\"e_out\"",
                   "the chain of 'via' lanes does not lead to lane 1 of edge 'n_out'"},
        InvalidNet{"tl=\"J\" linkIndex=\"0\"", "tl=\"K\" linkIndex=\"0\"",
                   "tl=\"K\": neither the network nor the additional files have"},
        InvalidNet{"tl=\"J\" linkIndex=\"0\"", "tl=\"J\" linkIndex=\"4\"",
                   "linkIndex=\"4\" must be below 4, the number of letters"},
        InvalidNet{"state=\"ryyy\"", "state=\"ryy\"", ":34: 'state' has 3 letters"},
        InvalidNet{"state=\"ryyy\"", "state=\"ryXy\"", ":34: 'state' has the unknown letter 'X'"},
        InvalidNet{"duration=\"4\"", "duration=\"-4\"", ":34: duration"},
        InvalidNet{"duration=\"4\"", "duration=\"0\"", ":34: duration=\"0\" must be more than 0"},
        InvalidNet{"duration=\"4\"", "duration=\"-0.0\"", ":34: duration=\"-0.0\" must be more than 0"},
        InvalidNet{"response=\"1110\"", "response=\"110\"", "'response' and 'foes' of request 0 must have 4 bits"},
        InvalidNet{"intLanes=\"", "intLanes=\":J_9_0 ", "has 5 links in 'intLanes' but 4 requests"},
        InvalidNet{"request index=\"1\"", "request index=\"2\"", "requests must be numbered"},
        InvalidNet{"<net version=\"1.20\"", "<net version=\"1.20\" lefthand=\"true\"", "left-hand"}));

TEST(SumoNetwork, MessagesNameTheFileWithItsFolder) {
    const SumoFiles files;
    const std::filesystem::path file = files.write("my.net.xml", "<net/>");
    try {
        read_sumo_net(files.folder() / "." / "my.net.xml");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find(file.string() + ":1: "), 0U) << error.what();
    }
}

TEST(SumoNetwork, RefusesFilesThatAreNotNetworks) {
    const SumoFiles files;
    const auto message_of = [&](const std::string& text) {
        return refusal([&] { read_sumo_net(files.write("my.net.xml", text)); });
    };
    EXPECT_EQ(message_of(""), "my.net.xml:1: the file is empty");
    EXPECT_EQ(message_of(" \n "), "my.net.xml:1: the file is empty");
    EXPECT_NE(message_of(std::string(100'000, 'x')).find("my.net.xml"), std::string::npos);
    EXPECT_NE(message_of(std::string(1000, '\0')).find("my.net.xml"), std::string::npos);
    EXPECT_NE(message_of("<net/>").find("the network has no lane for passenger cars"), std::string::npos);
    std::string deep;
    for (int k = 0; k < 200'000; ++k) deep += "<net>";
    EXPECT_NE(message_of(deep).find("not well-formed"), std::string::npos);
    EXPECT_EQ(refusal([&] { read_sumo_net(files.folder() / "none.net.xml"); }), "none.net.xml: there is no such file");
    EXPECT_NE(refusal([&] { read_sumo_net(files.folder()); }).find("is a folder"), std::string::npos);
    EXPECT_EQ(refusal([&] { read_sumo_net("/dev/zero"); }).find("/dev/zero: this is a device or a pipe"), 0U);
}

}  // namespace
}  // namespace stopline
