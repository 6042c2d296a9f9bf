// Tests of make_grid(): the lanes, and the links between intersections. Each intersection must have as many conflicts
// as an isolated intersection of make_intersection().
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/containers/index.h"
#include "network/lane_graph.h"

namespace stopline {
namespace {

IntersectionSettings layout() {
    IntersectionSettings s;
    s.lanes = {{"straight+left"}, {"straight+right"}};
    return s;
}

// Returns the grid of Fig. 10 in the paper.
GridSettings plus() {
    GridSettings grid;
    grid.columns = grid.rows = 3;
    grid.shape = "without_corners";
    return grid;
}

LaneGraph plus_graph() { return make_grid(plus(), layout()); }

TEST(Grid, HasTheExpectedLanesEntriesAndLinks) {
    const LaneGraph graph = plus_graph();
    check(graph);
    EXPECT_EQ(graph.signal_groups, 10);
    EXPECT_EQ(graph.links.size(), 4u * 2 * 2);  // four streets, two directions, two lanes each
    EXPECT_EQ(graph.entries.size(), 12u * 2);   // three outer legs at each of four intersections
    EXPECT_EQ(graph.routes.size(), 5u * 4 * 2 * 2);
    EXPECT_EQ(graph.lanes.size(), 16u + 2 * 24 + 80);
}

TEST(Grid, LinksSpanTheRoadBetweenIntersections) {
    const LaneGraph graph = plus_graph();
    for (const int link : graph.links) {
        const Lane& lane = graph.lanes[at(link)];
        const bool along_x = std::abs(lane.shape.front().y_m - lane.shape.back().y_m) < 1e-9;
        EXPECT_NEAR(lane.stop_line_m, (along_x ? 276.5 : 192.5) - 40.0, 1e-9) << lane.name;
        EXPECT_NEAR(length_m(lane.shape), lane.stop_line_m, 1e-9) << lane.name;
    }
}

TEST(Grid, SuccessiveLanesJoin) {
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

TEST(Grid, EveryIntersectionHasTheConflictsOfASingleIntersection) {
    const LaneGraph single = make_intersection(layout());
    std::size_t single_count = 0;
    for (const auto& conflicts : single.conflicts) single_count += conflicts.size();
    const LaneGraph graph = plus_graph();
    std::size_t grid_count = 0;
    for (std::size_t k = 0; k < graph.conflicts.size(); ++k) {
        grid_count += graph.conflicts[k].size();
        for (const Conflict& conflict : graph.conflicts[k]) {
            const int own_group = graph.lanes[at(graph.lanes[k].origin)].signal_group;
            const int other_group = graph.lanes[at(graph.lanes[at(conflict.other)].origin)].signal_group;
            EXPECT_EQ(own_group / 2, other_group / 2);
        }
    }
    EXPECT_EQ(grid_count, 5 * single_count);
}

TEST(Grid, EveryEntryReachesAtLeastTwoExits) {
    const LaneGraph graph = plus_graph();
    for (const int entry : graph.entries) {
        std::set<int> reached{entry};
        std::vector<int> unvisited{entry};
        while (!unvisited.empty()) {
            const int lane = unvisited.back();
            unvisited.pop_back();
            for (const int next : graph.lanes[at(lane)].next) {
                if (reached.insert(next).second) unvisited.push_back(next);
            }
        }
        const auto exits =
            std::count_if(reached.begin(), reached.end(), [&](int lane) { return graph.lanes[at(lane)].next.empty(); });
        EXPECT_GE(exits, 2) << graph.lanes[at(entry)].name;
    }
}

}  // namespace
}  // namespace stopline
