// Tests of make_intersection(): lanes, connections, conflict areas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "network/conflicts.h"

namespace stopline {
namespace {

IntersectionSettings reference_intersection() {
    IntersectionSettings s;
    s.lanes = {{"straight+left"}, {"straight+right"}};
    return s;
}

const Lane& lane_named(const LaneGraph& graph, const std::string& name) {
    return *std::find_if(graph.lanes.begin(), graph.lanes.end(), [&](const Lane& lane) { return lane.name == name; });
}

int index_of(const LaneGraph& graph, const std::string& name) {
    return static_cast<int>(&lane_named(graph, name) - graph.lanes.data());
}

const Conflict* conflict(const LaneGraph& graph, const std::string& lane, const std::string& other) {
    for (const Conflict& c : graph.conflicts_of(index_of(graph, lane))) {
        if (c.other == index_of(graph, other)) return &c;
    }
    return nullptr;
}

TEST(Intersection, HasTheLanesAndRoutesOfFigure7) {
    const LaneGraph graph = make_intersection(reference_intersection());
    check(graph);
    EXPECT_EQ(graph.entries.size(), 8u);
    EXPECT_EQ(graph.routes.size(), 16u);
    EXPECT_EQ(graph.lanes.size(), 8u + 8u + 16u);
    EXPECT_EQ(lane_named(graph, "west_in_0").signal_group, lane_named(graph, "east_in_1").signal_group);
    EXPECT_NE(lane_named(graph, "west_in_0").signal_group, lane_named(graph, "south_in_0").signal_group);
}

TEST(Intersection, ConnectionsRunFromTheStopLineToTheExitLane) {
    const LaneGraph graph = make_intersection(reference_intersection());
    for (const Lane& lane : graph.lanes) {
        if (lane.origin < 0) continue;
        const Lane& origin = graph.lanes[static_cast<std::size_t>(lane.origin)];
        const Lane& exit = graph.lanes[static_cast<std::size_t>(lane.next[0])];
        EXPECT_NEAR(std::hypot(lane.shape.front().x_m - origin.shape.back().x_m,
                               lane.shape.front().y_m - origin.shape.back().y_m),
                    0.0, 1e-9)
            << lane.name;
        EXPECT_NEAR(
            std::hypot(lane.shape.back().x_m - exit.shape.front().x_m, lane.shape.back().y_m - exit.shape.front().y_m),
            0.0, 1e-9)
            << lane.name;
        // The shape of a connection begins at the stop line. It covers the stretch that all movements of the approach
        // lane share, and then the connection itself.
        EXPECT_NEAR(origin.length_m - origin.stop_line_m, lane.shape_start_m, 1e-9) << lane.name;
        EXPECT_NEAR(lane.shape_start_m + lane.length_m, length_m(lane.shape), 1e-9) << lane.name;
    }
    // The turns are quarter circles, approximated by 24 chords.
    EXPECT_NEAR(length_m(lane_named(graph, "west_0_left").shape), 0.5 * std::numbers::pi * 21.75, 0.02);
    EXPECT_NEAR(length_m(lane_named(graph, "west_1_right").shape), 0.5 * std::numbers::pi * 14.75, 0.02);
    EXPECT_NEAR(length_m(lane_named(graph, "west_0_straight").shape), 40.0, 1e-9);
}

TEST(Intersection, HasTheExpectedConflicts) {
    const LaneGraph graph = make_intersection(reference_intersection());
    for (const char* other : {"east_0_straight", "east_1_straight", "south_0_straight", "north_0_straight"}) {
        EXPECT_NE(conflict(graph, "west_0_left", other), nullptr) << other;
    }
    EXPECT_EQ(conflict(graph, "west_0_left", "east_0_left"), nullptr) << "opposite left turns pass each other";
    EXPECT_EQ(conflict(graph, "west_0_left", "west_0_straight"), nullptr) << "the same approach lane";
    EXPECT_EQ(conflict(graph, "west_0_straight", "east_0_straight"), nullptr) << "opposite directions";
    EXPECT_EQ(conflict(graph, "west_1_right", "east_1_straight"), nullptr);
    ASSERT_NE(conflict(graph, "west_1_right", "north_1_straight"), nullptr) << "they merge";
    const auto yields_to = [&](const char* lane, const char* other) { return conflict(graph, lane, other)->yields; };
    EXPECT_TRUE(yields_to("west_0_left", "east_0_straight"));
    EXPECT_FALSE(yields_to("east_0_straight", "west_0_left"));
    EXPECT_FALSE(yields_to("west_0_left", "south_0_straight")) << "the signal separates them";
}

TEST(Intersection, ConflictsAreMutualAndCoverAllNearbyStretches) {
    const IntersectionSettings settings = reference_intersection();
    const LaneGraph graph = make_intersection(settings);
    int areas = 0;
    for (int k = 0; k < static_cast<int>(graph.lanes.size()); ++k) {
        const Lane& lane = graph.lanes[static_cast<std::size_t>(k)];
        for (const Conflict& c : graph.conflicts_of(k)) {
            ++areas;
            const Lane& other = graph.lanes[static_cast<std::size_t>(c.other)];
            const Conflict* const reverse = conflict(graph, other.name, lane.name);
            ASSERT_NE(reverse, nullptr);
            EXPECT_EQ(reverse->from_m, c.other_from_m);
            EXPECT_EQ(reverse->other_to_m, c.to_m);
            EXPECT_EQ(reverse->yields, c.other_yields);
            EXPECT_FALSE(c.yields && c.other_yields);
            for (double s = 0.05; s < lane.length_m; s += 0.1) {
                const Point p = pose_at(lane.shape, lane.shape_start_m + s).point;
                const bool near = distance_m(other.shape, p) < settings.clearance_m - 0.3;
                const bool within = s >= c.from_m - 1e-9 && s <= c.to_m + 1e-9;
                EXPECT_TRUE(!near || within) << lane.name << " and " << other.name << " at " << s;
            }
        }
    }
    EXPECT_GT(areas, 60);
}

// A rotation by 90 degrees maps each lane onto the same lane of the next leg. The conflicts must agree.
TEST(Intersection, IsTheSameFromEveryLeg) {
    const LaneGraph graph = make_intersection(reference_intersection());
    const std::map<std::string, std::string> next{
        {"west", "south"}, {"south", "east"}, {"east", "north"}, {"north", "west"}};
    const auto rotated = [&](const std::string& name) {
        const std::size_t cut = name.find('_');
        return next.at(name.substr(0, cut)) + name.substr(cut);
    };
    for (int k = 0; k < static_cast<int>(graph.lanes.size()); ++k) {
        const Lane& lane = graph.lanes[static_cast<std::size_t>(k)];
        if (lane.origin < 0) continue;
        for (const Conflict& c : graph.conflicts_of(k)) {
            const Conflict* const counterpart =
                conflict(graph, rotated(lane.name), rotated(graph.lanes[static_cast<std::size_t>(c.other)].name));
            ASSERT_NE(counterpart, nullptr) << lane.name;
            EXPECT_NEAR(counterpart->from_m, c.from_m, 0.26);
            EXPECT_NEAR(counterpart->to_m, c.to_m, 0.26);
            EXPECT_EQ(counterpart->yields, c.yields);
        }
    }
}

TEST(Intersection, AcceptsManyLaneLayouts) {
    for (const std::vector<std::string>& lanes :
         std::vector<std::vector<std::string>>{{"straight"},
                                               {"straight+left+right"},
                                               {"left", "straight", "right"},
                                               {"left", "left", "straight", "right"}}) {
        IntersectionSettings settings;
        settings.lanes.clear();
        for (const std::string& movements : lanes) settings.lanes.push_back({movements});
        const LaneGraph graph = make_intersection(settings);
        check(graph);
        std::set<int> exits;
        for (const Route& route : graph.routes) exits.insert(route.lanes.back());
        EXPECT_EQ(graph.entries.size(), 4 * lanes.size());
        // Each leg has at least one exit lane in use; more if two lanes of an approach have the same turn.
        EXPECT_GE(exits.size(), 4u);
    }
}

}  // namespace
}  // namespace stopline
