// Several intersections: what joins them, and that each is like a single one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "network/lane_graph.h"

namespace stopline {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

IntersectionSettings layout() {
    IntersectionSettings s;
    s.lanes = {{"straight+left"}, {"straight+right"}};
    return s;
}

// The setup of Fig. 10.
GridSettings plus() {
    GridSettings grid;
    grid.columns = grid.rows = 3;
    grid.shape = "without_corners";
    return grid;
}

LaneGraph plus_graph() { return make_grid(plus(), layout()); }

TEST(Grid, HasItsLanesEntriesAndLinks) {
    const LaneGraph graph = plus_graph();
    check(graph);
    EXPECT_EQ(graph.signal_groups, 10);
    EXPECT_EQ(graph.links.size(), 4u * 2 * 2);  // four streets, two ways, two lanes
    EXPECT_EQ(graph.entries.size(), 12u * 2);   // three outer arms at each of four
    EXPECT_EQ(graph.routes.size(), 5u * 4 * 2 * 2);
    EXPECT_EQ(graph.lanes.size(), 16u + 2 * 24 + 80);
}

TEST(Grid, LinksAreAsLongAsTheStreetBetweenTwoIntersections) {
    const LaneGraph graph = plus_graph();
    for (const int link : graph.links) {
        const Lane& lane = graph.lanes[at(link)];
        const bool along_x = std::abs(lane.shape.front().y_m - lane.shape.back().y_m) < 1e-9;
        EXPECT_NEAR(lane.stop_line_m, (along_x ? 276.5 : 192.5) - 40.0, 1e-9) << lane.name;
        EXPECT_NEAR(length_m(lane.shape), lane.stop_line_m, 1e-9) << lane.name;
    }
}

TEST(Grid, EveryLaneBeginsWhereTheOneBeforeEnds) {
    const LaneGraph graph = plus_graph();
    for (const Lane& lane : graph.lanes) {
        for (const int next : lane.next) {
            const Point end = lane.shape.back();
            const Point begin = graph.lanes[at(next)].shape.front();
            EXPECT_NEAR(std::hypot(end.x_m - begin.x_m, end.y_m - begin.y_m), 0.0, 1e-9)
                << lane.name << " to " << graph.lanes[at(next)].name;
        }
    }
}

TEST(Grid, EveryIntersectionHasTheConflictsOfASingleOne) {
    const LaneGraph single = make_intersection(layout());
    std::size_t of_one = 0;
    for (const auto& conflicts : single.conflicts) of_one += conflicts.size();
    const LaneGraph graph = plus_graph();
    std::size_t all = 0;
    for (std::size_t k = 0; k < graph.conflicts.size(); ++k) {
        all += graph.conflicts[k].size();
        for (const Conflict& conflict : graph.conflicts[k]) {
            const int here = graph.lanes[at(graph.lanes[k].origin)].signal_group;
            const int there = graph.lanes[at(graph.lanes[at(conflict.other)].origin)].signal_group;
            EXPECT_EQ(here / 2, there / 2);
        }
    }
    EXPECT_EQ(all, 5 * of_one);
}

TEST(Grid, FromEveryEntryAllExitsAheadCanBeReached) {
    const LaneGraph graph = plus_graph();
    for (const int entry : graph.entries) {
        std::set<int> seen{entry};
        std::vector<int> todo{entry};
        while (!todo.empty()) {
            const int lane = todo.back();
            todo.pop_back();
            for (const int next : graph.lanes[at(lane)].next) {
                if (seen.insert(next).second) todo.push_back(next);
            }
        }
        const auto exits =
            std::count_if(seen.begin(), seen.end(), [&](int lane) { return graph.lanes[at(lane)].next.empty(); });
        EXPECT_GE(exits, 2) << graph.lanes[at(entry)].name;
    }
}

}  // namespace
}  // namespace stopline
