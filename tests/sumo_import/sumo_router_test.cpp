// Tests of SumoRouter: routes are fastest, and the same whatever was searched before.
#include "sumo_import/sumo_router.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "base/random.h"
#include "sumo_import/sumo_net.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::SumoFiles;

constexpr int kSide = 9;  // streets in each direction

// Returns a grid of streets with one lane in each direction. The lengths of roads are drawn from a few values, so that
// many routes take the same time. The junction in the corner has only outgoing roads, so that no route leads to it.
std::string grid_net() {
    std::string edges;
    std::string junctions;
    std::vector<std::vector<std::string>> arriving(kSide * kSide);
    std::vector<std::vector<std::string>> leaving(kSide * kSide);
    for (int from = 0; from < kSide * kSide; ++from) {
        const int x = from % kSide;
        const int y = from / kSide;
        junctions += "<junction id=\"" + std::to_string(from) + "\" type=\"unregulated\" x=\"0\" y=\"0\"/>\n";
        for (const auto& [dx, dy] : std::vector<std::pair<int, int>>{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
            if (x + dx < 0 || x + dx >= kSide || y + dy < 0 || y + dy >= kSide) continue;
            const int to = from + dx + dy * kSide;
            if (to == 0) continue;
            const std::string id = std::to_string(from) + "to" + std::to_string(to);
            const auto key = static_cast<std::uint64_t>(from * 100 + to);
            const int length_m = 100 + 50 * static_cast<int>(3.0 * random_uniform(1, key, 0, Purpose::insertion));
            const auto point = [](int px, int py) { return std::to_string(200 * px) + "," + std::to_string(200 * py); };
            edges += "<edge id=\"" + id + "\" from=\"" + std::to_string(from) + "\" to=\"" + std::to_string(to) +
                     "\"><lane id=\"" + id + "_0\" index=\"0\" speed=\"10\" length=\"" + std::to_string(length_m) +
                     "\" shape=\"" + point(x, y) + " " + point(x + dx, y + dy) + "\"/></edge>\n";
            leaving[static_cast<std::size_t>(from)].push_back(id);
            arriving[static_cast<std::size_t>(to)].push_back(id);
        }
    }
    std::string connections;
    for (std::size_t node = 0; node < arriving.size(); ++node) {
        for (const std::string& in : arriving[node]) {
            for (const std::string& out : leaving[node]) {
                connections += "<connection from=\"" + in + "\" to=\"" + out +
                               R"(" fromLane="0" toLane="0" dir="s" state="M"/>)" + "\n";
            }
        }
    }
    return "<net version=\"1.20\">\n" + edges + junctions + connections + "</net>\n";
}

class SumoRouterOnGrid : public ::testing::Test {
protected:
    SumoRouterOnGrid() : network_(make_sumo_network(read_sumo_net(files_.write("my.net.xml", grid_net())), 2.0)) {}

    int edges() const { return static_cast<int>(network_.net.edges.size()); }
    // Returns the time from the end of the first edge of the route to the end of its last one.
    double time_of(const std::vector<int>& route) const {
        double time_s = 0.0;
        for (std::size_t k = 1; k < route.size(); ++k) {
            const double link_s = link_time_s(route[k - 1], route[k]);
            EXPECT_GT(link_s, 0.0) << "edge " << route[k - 1] << " does not lead to edge " << route[k];
            time_s += link_s + edge_time_s(route[k]);
        }
        return time_s;
    }
    double edge_time_s(int edge) const {
        return network_.net.edges[static_cast<std::size_t>(edge)].lanes[0].length_m / 10.0;
    }
    double link_time_s(int from, int to) const {
        const std::vector<Lane>& lanes = network_.graph.lanes;
        const int first = network_.lane_of[static_cast<std::size_t>(from)][0];
        for (const int next : lanes[static_cast<std::size_t>(first)].next) {
            const Lane& link = lanes[static_cast<std::size_t>(next)];
            if (link.next[0] == network_.lane_of[static_cast<std::size_t>(to)][0])
                return link.length_m / link.limit_mps;
        }
        return 0.0;
    }
    // Returns the least times from the end of an edge to the ends of all edges, by the algorithm of Bellman and Ford.
    std::vector<double> least_times_s(int from) const {
        std::vector<double> times_s(static_cast<std::size_t>(edges()), std::numeric_limits<double>::infinity());
        times_s[static_cast<std::size_t>(from)] = 0.0;
        const std::vector<Lane>& lanes = network_.graph.lanes;
        for (bool has_changed = true; has_changed;) {
            has_changed = false;
            for (const Lane& link : lanes) {
                if (link.origin < 0) continue;
                // Every edge has one lane, so lanes of edges are numbered like the edges.
                const auto before = static_cast<std::size_t>(link.origin);
                const auto after = static_cast<std::size_t>(link.next[0]);
                const double time_s = times_s[before] + link.length_m / link.limit_mps + edge_time_s(link.next[0]);
                if (time_s >= times_s[after] - 1e-9) continue;
                times_s[after] = time_s;
                has_changed = true;
            }
        }
        return times_s;
    }

    SumoFiles files_;
    SumoNetwork network_;
};

TEST_F(SumoRouterOnGrid, FindsFastestRoutes) {
    SumoRouter router(network_);
    int unreachable = 0;
    for (int from = 0; from < edges(); from += 3) {
        const std::vector<double> least_s = least_times_s(from);
        for (int to = from % 7; to < edges(); to += 7) {
            const std::optional<std::vector<int>> route = router.fastest_route(from, to);
            ASSERT_EQ(route.has_value(), least_s[static_cast<std::size_t>(to)] < 1e9) << from << " to " << to;
            unreachable += route ? 0 : 1;
            if (!route) continue;
            EXPECT_EQ(route->front(), from);
            EXPECT_EQ(route->back(), to);
            EXPECT_NEAR(time_of(*route), least_s[static_cast<std::size_t>(to)], 1e-6) << from << " to " << to;
        }
    }
    EXPECT_GT(unreachable, 0);
}

// After some searches, the router precomputes travel times from and to a few edges (landmarks) to search faster. After
// many calls with the same destination, it builds a tree of fastest routes to this destination. In all cases, the
// routes must be those of a new router.
TEST_F(SumoRouterOnGrid, GivesTheSameRoutesWhateverWasSearchedBefore) {
    SumoRouter used(network_);
    for (int k = 0; k < 100; ++k) used.fastest_route(k, 200 - k);
    int routes = 0;
    for (int to = 5; to < edges(); to += 29) {
        SumoRouter tree(network_);
        for (int from = 0; from < edges(); from += 11) tree.fastest_route(from, to);
        for (int from = 1; from < edges(); from += 23) {
            SumoRouter fresh(network_);
            const std::optional<std::vector<int>> expected = fresh.fastest_route(from, to);
            EXPECT_EQ(tree.fastest_route(from, to), expected) << from << " to " << to;
            EXPECT_EQ(used.fastest_route(from, to), expected) << from << " to " << to;
            // The other destination prevents `used` from building a tree for `to`.
            used.fastest_route(from, (to + 1) % edges());
            routes += expected ? 1 : 0;
        }
    }
    EXPECT_GT(routes, 100);
}

}  // namespace
}  // namespace stopline
