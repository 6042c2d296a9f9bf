// Tests of merge_short_edges(): short edges become part of the edge upstream.
#include "sumo_import/sumo_short_edges.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace stopline {
namespace {

SumoEdge edge(const std::string& id, double from_m, double length_m) {
    SumoEdge result{id, id[0] == ':'};
    for (int lane = 0; lane < 2; ++lane) {
        const double y_m = 3.2 * lane;
        result.lanes.push_back({length_m, 13.89, true, {{from_m, y_m}, {from_m + length_m, y_m}}});
    }
    return result;
}

// Returns a network in which edge a (100 m) leads over an internal edge of 3 m to s (5 m), and s over a junction to b.
// All these edges have two lanes, connected lane by lane.
SumoNet chain() {
    SumoNet net;
    net.edges = {edge("a", 0.0, 100.0), edge(":v", 100.0, 3.0), edge("s", 103.0, 5.0), edge(":x", 108.0, 10.0),
                 edge("b", 118.0, 50.0)};
    for (int lane = 0; lane < 2; ++lane) {
        net.connections.push_back({0, lane, 2, lane, 1, lane});
        net.connections.push_back({1, lane, 2, lane});
        net.connections.push_back({2, lane, 4, lane, 3, lane});
        net.connections.push_back({3, lane, 4, lane});
    }
    net.loops = {{"on s", 2, 1, 2.0}, {"on a", 0, 1, 20.0}, {"on b", 4, 0, 7.0}};
    return net;
}

TEST(SumoShortEdges, ExtendTheEdgeUpstream) {
    SumoNet net = chain();
    merge_short_edges(net);
    EXPECT_EQ(net.edges[2].merged_into, 0);
    int connections_to_b = 0;
    for (const SumoConnection& c : net.connections) {
        if (net.edges[static_cast<std::size_t>(c.from)].internal) continue;
        EXPECT_FALSE(c.from == 2 || c.to == 2) << c.from << " to " << c.to;
        connections_to_b += c.from == 0 && c.to == 4 && c.from_lane == c.to_lane && c.via == 3 ? 1 : 0;
    }
    EXPECT_EQ(connections_to_b, 2);
    for (const SumoLane& lane : net.edges[0].lanes) {
        EXPECT_DOUBLE_EQ(lane.length_m, 108.0);
        EXPECT_DOUBLE_EQ(lane.shape.back().x_m, 108.0);
    }
}

TEST(SumoShortEdges, KeepTheirDetectors) {
    SumoNet net = chain();
    merge_short_edges(net);
    EXPECT_EQ(net.loops[0].edge, 0);
    EXPECT_EQ(net.loops[0].lane, 1);
    EXPECT_DOUBLE_EQ(net.loops[0].position_m, 105.0);
    EXPECT_DOUBLE_EQ(net.loops[1].position_m, 20.0);
    EXPECT_EQ(net.loops[2].edge, 4);
}

TEST(SumoShortEdges, StayBehindASignalOrIfLongEnough) {
    SumoNet with_light = chain();
    with_light.connections[0].tl = 0;
    merge_short_edges(with_light);
    EXPECT_EQ(with_light.edges[2].merged_into, -1);
    SumoNet long_enough = chain();
    for (SumoLane& lane : long_enough.edges[2].lanes) lane.length_m = kShortEdge_m;
    merge_short_edges(long_enough);
    EXPECT_EQ(long_enough.edges[2].merged_into, -1);
    EXPECT_DOUBLE_EQ(long_enough.loops[0].position_m, 2.0);
}

// Link 2 of the junction between a and s conflicts with links 0 and 1, which begin on a. It is a street, which prevents
// merging, or a pedestrian crossing, which does not, because pedestrians are not simulated.
TEST(SumoShortEdges, StayBehindACrossingStreet) {
    for (const bool is_street : {false, true}) {
        SumoNet net = chain();
        net.edges.push_back(edge("p", 0.0, 50.0));
        net.edges.push_back(edge(":w", 50.0, 10.0));
        net.edges.push_back(edge("q", 60.0, 50.0));
        if (is_street) {
            net.connections.push_back({5, 0, 7, 0, 6, 0});
            net.connections.push_back({6, 0, 7, 0});
        }
        SumoJunction junction;
        junction.foes = {{false, false, true}, {false, false, true}, {true, true, false}};
        net.junctions = {junction};
        net.link_of = {{":v_0", {0, 0}}, {":v_1", {0, 1}}, {":w_0", {0, 2}}};
        merge_short_edges(net);
        EXPECT_EQ(net.edges[2].merged_into, is_street ? -1 : 0);
    }
}

TEST(SumoShortEdges, StayBehindATurnaround) {
    for (const char dir : {'t', 'T'}) {
        SumoNet net = chain();
        for (SumoConnection& c : net.connections) c.dir = c.to == 2 ? dir : 's';
        merge_short_edges(net);
        EXPECT_EQ(net.edges[2].merged_into, -1) << dir;
        EXPECT_EQ(net.connections.size(), 8U) << dir;
    }
}

TEST(SumoShortEdges, KeepConnectionsOfLanesWithoutPredecessor) {
    SumoNet net = chain();
    net.connections.erase(net.connections.begin() + 4);  // from lane 1 of a to lane 1 of s
    merge_short_edges(net);
    EXPECT_EQ(net.edges[2].merged_into, -1);
    EXPECT_EQ(net.connections.size(), 7U);
}

// Lane 0 of s leads to e and lane 1 to the short edge b, but a leads only to lane 0. If the connection from s to b were
// dropped, b would keep a predecessor that does not exist.
TEST(SumoShortEdges, KeepThePredecessorsOfShortEdgesDownstream) {
    SumoNet net = chain();
    net.edges.push_back(edge(":y", 168.0, 2.0));
    net.edges.push_back(edge("f", 170.0, 50.0));
    net.edges.push_back(edge("e", 118.0, 50.0));
    for (SumoLane& lane : net.edges[4].lanes) lane.length_m = 5.0;
    net.connections[2].to = net.connections[3].to = 7;
    net.connections.erase(net.connections.begin() + 4);  // from lane 1 of a to lane 1 of s
    for (int lane = 0; lane < 2; ++lane) net.connections.push_back({4, lane, 6, lane, 5, lane});
    merge_short_edges(net);
    EXPECT_EQ(net.edges[2].merged_into, -1);
    EXPECT_EQ(net.edges[4].merged_into, -1);
    EXPECT_EQ(net.connections.size(), 9U);
    for (const SumoConnection& c : net.connections) EXPECT_GE(c.from, 0);
}

}  // namespace
}  // namespace stopline
