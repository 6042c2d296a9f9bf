// Tests of exported streets: approaches with turn pockets become several edges of SUMO, one behind the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "network/lane_graph.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"
#include "sim/step/simulation.h"
#include "sumo_export/edges.h"
#include "sumo_export/inputs.h"
#include "sumo_import/sumo_xml.h"
#include "support/streets.h"

namespace stopline {
namespace {

constexpr double kSplit_m = 0.1;  // length of the connection between two edges of one approach

// Returns streets whose first intersection has pockets of different lengths on both sides of the approach from west.
LaneGraph pockets_on_both_sides() {
    StreetSettings streets = two_streets();
    streets.median_m = 8.0;
    streets.intersections[0].radius_m = 25.0;
    streets.intersections[0].legs[0].lanes = {{"left", 40.0}, {"left", 80.0},     {"straight"},
                                              {"straight"},   {"straight+right"}, {"right", 60.0}};
    streets.intersections[0].legs[3].exits = 2;  // north
    streets.intersections[0].legs[2].exits = 2;  // south
    return make_streets(streets);
}

int lane_named(const LaneGraph& graph, const std::string& name) {
    const auto found =
        std::find_if(graph.lanes.begin(), graph.lanes.end(), [&](const Lane& lane) { return lane.name == name; });
    EXPECT_NE(found, graph.lanes.end()) << name;
    return static_cast<int>(found - graph.lanes.begin());
}

class ExportedStreets : public ::testing::TestWithParam<LaneGraph (*)()> {};

// The parts of a lane and the connections between them cover the lane from its start to its stop line or end.
TEST_P(ExportedStreets, PartsCoverEachLane) {
    const LaneGraph graph = GetParam()();
    const PlainNetwork network = plain_network(graph);
    int pockets = 0;
    for (int k = 0; k < static_cast<int>(graph.lanes.size()); ++k) {
        const Lane& lane = graph.lanes[at(k)];
        if (lane.origin >= 0) {
            EXPECT_TRUE(network.parts_of[at(k)].empty());
            continue;
        }
        pockets += lane.start_offset_m > 0.0 ? 1 : 0;
        double end_m = -kSplit_m;
        for (const EdgePart& part : network.parts_of[at(k)]) {
            EXPECT_NEAR(part.from_m, end_m + kSplit_m, 1e-9) << lane.name;
            end_m = part.from_m + network.edges[at(part.edge)].length_m;
            EXPECT_EQ(network.edges[at(part.edge)].lanes.at(at(part.index)), k);
            EXPECT_EQ(&network.part_at(k, part.from_m), &part);
            EXPECT_EQ(&network.part_at(k, end_m), &part);
            EXPECT_EQ(&network.part_on(k, part.edge), &part);
        }
        EXPECT_NEAR(end_m, lane.signal_group >= 0 ? lane.stop_line_m : lane.length_m, 1e-9) << lane.name;
    }
    EXPECT_GT(pockets, 0);
}

// The test leaves connections through junctions aside. Each later part of a lane is reached from the previous part of
// the same lane only. The first part of a pocket is reached from exactly one other lane of its approach. The first part
// of any other lane is not reached from any lane.
TEST_P(ExportedStreets, EachPartHasOneConnectionToIt) {
    const LaneGraph graph = GetParam()();
    const PlainNetwork network = plain_network(graph);
    std::map<std::pair<int, int>, std::vector<int>> reached_from;  // [edge, lane index] lanes that lead there
    for (const PlainConnection& c : network.connections) {
        EXPECT_EQ(network.edges[at(c.begin.edge)].to, c.node);
        EXPECT_EQ(network.edges[at(c.end.edge)].from, c.node);
        if (c.connection_lane >= 0) {
            EXPECT_EQ(c.link >= 0, network.nodes[at(c.node)].has_signal);
            continue;
        }
        EXPECT_EQ(c.length_m, kSplit_m);
        EXPECT_EQ(c.link, -1);
        EXPECT_FALSE(network.nodes[at(c.node)].has_signal);
        reached_from[{c.end.edge, c.end.index}].push_back(c.from);
    }
    for (int k = 0; k < static_cast<int>(graph.lanes.size()); ++k) {
        const Lane& lane = graph.lanes[at(k)];
        const std::vector<EdgePart>& parts = network.parts_of[at(k)];
        for (std::size_t part = 0; part < parts.size(); ++part) {
            const std::vector<int> from = reached_from[{parts[part].edge, parts[part].index}];
            if (part > 0) {
                EXPECT_EQ(from, std::vector<int>{k}) << lane.name;
            } else if (lane.start_offset_m > 0.0) {
                ASSERT_EQ(from.size(), 1U) << lane.name;
                EXPECT_EQ(graph.lanes[at(from[0])].approach, lane.approach);
            } else {
                EXPECT_TRUE(from.empty()) << lane.name;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Layouts, ExportedStreets,
                         ::testing::Values([] { return make_streets(streets_with_pockets()); },
                                           &pockets_on_both_sides));

TEST(ExportedPockets, BeginWhereTheirEdgeBegins) {
    const LaneGraph graph = pockets_on_both_sides();
    const PlainNetwork network = plain_network(graph);
    // The approach is 300 m long. Its three through lanes begin at its start, the long left pocket at 220 m, the right
    // pocket at 240 m, and the short left pocket at 260 m.
    const std::vector<EdgePart>& middle = network.parts_of[at(lane_named(graph, "first_west_in_3"))];
    ASSERT_EQ(middle.size(), 4U);
    const std::vector<std::pair<std::size_t, double>> lanes_and_lengths{
        {3, 220.0 - kSplit_m}, {4, 20.0 - kSplit_m}, {5, 20.0 - kSplit_m}, {6, 40.0}};
    for (std::size_t k = 0; k < middle.size(); ++k) {
        const PlainEdge& edge = network.edges[at(middle[k].edge)];
        EXPECT_EQ(edge.lanes.size(), lanes_and_lengths[k].first);
        EXPECT_NEAR(edge.length_m, lanes_and_lengths[k].second, 1e-9);
        EXPECT_EQ(edge.ends_at_stop_line, k == 3);
        EXPECT_EQ(edge.id, k == 3 ? "first_west_in" : "first_west_in." + std::to_string(k + 1));
    }
    std::map<std::string, std::string> pocket_from;
    for (const PlainConnection& c : network.connections) {
        if (c.connection_lane < 0 && c.from != c.to)
            pocket_from[graph.lanes[at(c.to)].name] = graph.lanes[at(c.from)].name;
    }
    EXPECT_EQ(pocket_from.at("first_west_in_1"), "first_west_in_2");  // long left pocket
    EXPECT_EQ(pocket_from.at("first_west_in_0"), "first_west_in_1");  // short left pocket, beside the long one
    EXPECT_EQ(pocket_from.at("first_west_in_5"), "first_west_in_4");  // right pocket
    EXPECT_EQ(network.lane_id(lane_named(graph, "first_west_in_0")), "first_west_in_5");
    EXPECT_EQ(network.lane_id(lane_named(graph, "first_west_in_5")), "first_west_in_0");
}

TEST(ExportedPockets, ShareAnEdgeIfTheyBeginTogether) {
    StreetSettings streets = streets_with_pockets();
    streets.median_m = 8.0;
    streets.intersections[0].legs[0].lanes.insert(streets.intersections[0].legs[0].lanes.begin() + 1, {"left", 60.5});
    streets.intersections[0].legs[3].exits = 2;
    const LaneGraph graph = make_streets(streets);
    const PlainNetwork network = plain_network(graph);
    EXPECT_EQ(network.parts_of[at(lane_named(graph, "first_west_in_2"))].size(), 2U);
    EXPECT_EQ(network.parts_of[at(lane_named(graph, "first_west_in_0"))].size(), 1U);
    EXPECT_EQ(network.parts_of[at(lane_named(graph, "first_west_in_1"))].size(), 1U);
}

TEST(ExportedPockets, RefuseLanesThatEndApart) {
    LaneGraph graph = make_streets(streets_with_pockets());
    graph.lanes[at(lane_named(graph, "first_west_in_0"))].stop_line_m -= 1.0;
    EXPECT_THROW(plain_network(graph), InputError);
}

Model berlin(std::vector<std::string> overrides) {
    overrides.insert(overrides.end(), {"fidelity=meso", "populations=[CTG-Ref]"});
    return build_model(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/berlin.yaml", overrides), 0);
}

struct ExportedVehicle {
    std::vector<std::string> edges;
    int lane = 0;
    double position_m = 0.0;
};

std::vector<ExportedVehicle> vehicles_of(const Model& model, const PlainNetwork& network, double until_s) {
    const TemporaryFolder folder;
    const auto writer = make_sumo_route_writer(folder.path() / "v.rou.xml", model, network);
    Simulation simulation(model);
    while (simulation.time_s() < until_s) {
        writer->observe(simulation.state());
        simulation.step();
    }
    writer->observe(simulation.state());
    writer->finish();
    const SumoXml xml(folder.path() / "v.rou.xml", {"routes"});
    std::vector<ExportedVehicle> vehicles;
    for (const pugi::xml_node vehicle : xml.root().children("vehicle")) {
        ExportedVehicle one{{}, xml.whole_number(vehicle, "departLane"), xml.number(vehicle, "departPos")};
        std::istringstream edges(xml.text(vehicle.child("route"), "edges"));
        for (std::string edge; edges >> edge;) one.edges.push_back(edge);
        vehicles.push_back(std::move(one));
    }
    return vehicles;
}

TEST(ExportedPockets, RoutesLeadOverAllEdges) {
    const Model model = berlin({"network.streets=four_lanes_pockets"});
    const PlainNetwork network = plain_network(model.graph);
    std::set<std::pair<std::string, std::string>> connected;
    for (const PlainConnection& c : network.connections) {
        connected.emplace(network.edges[at(c.begin.edge)].id, network.edges[at(c.end.edge)].id);
    }
    int over_splits = 0;
    for (const ExportedVehicle& vehicle : vehicles_of(model, network, 300.0)) {
        for (std::size_t k = 1; k < vehicle.edges.size(); ++k) {
            EXPECT_TRUE(connected.count({vehicle.edges[k - 1], vehicle.edges[k]}))
                << vehicle.edges[k - 1] << " " << vehicle.edges[k];
            over_splits += vehicle.edges[k - 1] == vehicle.edges[k] + ".1" ? 1 : 0;
        }
    }
    EXPECT_GT(over_splits, 500);
}

// The vehicles of the initial queues stand on the edge at their position, not on the first edge of their approach.
TEST(ExportedPockets, QueuesDepartFromTheirEdges) {
    const Model model = berlin({"demand.start=queued"});
    const PlainNetwork network = plain_network(model.graph);
    std::map<std::string, const PlainEdge*> edges;
    for (const PlainEdge& edge : network.edges) edges[edge.id] = &edge;
    int on_first = 0;
    int on_last = 0;
    for (const ExportedVehicle& vehicle : vehicles_of(model, network, 0.0)) {
        const PlainEdge& edge = *edges.at(vehicle.edges.at(0));
        EXPECT_GE(vehicle.position_m, 0.0);
        EXPECT_LE(vehicle.position_m, edge.length_m);
        EXPECT_LT(at(vehicle.lane), edge.lanes.size());
        on_first += edge.id == "koenigin_elisabeth_str_west_in.1" ? 1 : 0;
        on_last += edge.id == "koenigin_elisabeth_str_west_in" ? 1 : 0;
    }
    EXPECT_GT(on_first, 60);
    EXPECT_GT(on_last, 15);
}

}  // namespace
}  // namespace stopline
