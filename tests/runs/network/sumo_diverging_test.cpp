// Distances between vehicles on diverging connections of an imported network. They are computed from positions in the
// plane, independent of the conflicts that the simulation counts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/containers/index.h"
#include "runs/network/network.h"
#include "scenario/import_sumo.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::fork_net;
using testing::replaced;
using testing::SumoFiles;
using testing::turnaround_net;

// The body of a vehicle on a connection or its approach. Positions are along the connection, from the stop line.
struct Body {
    int connection;
    double front_m;
    double rear_m;
};

std::vector<Body> bodies(const Model& model, const State& state) {
    std::vector<Body> all;
    for (std::size_t k = 0; k < state.blocks.size(); ++k) {
        const LaneBlock& block = state.blocks[k];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const VehicleRecord& record = state.vehicles.record[at(slot)];
            const Lane& lane = model.graph.lanes[k];
            const int next = state.vehicles.next_lane[at(slot)];
            const bool before = lane.origin < 0 && next >= 0;
            const int connection = before ? next : lane.origin >= 0 ? static_cast<int>(k) : record.previous_lane;
            if (connection < 0) continue;
            const Lane& path = model.graph.lanes[at(connection)];
            double start_m = before ? -lane.stop_line_m : path.shape_start_m;
            if (!before && lane.origin < 0) start_m += path.length_m;
            const double front_m = start_m + state.vehicles.position_m[at(slot)];
            all.push_back({connection, front_m, front_m - static_cast<double>(state.vehicles.length_m[at(slot)])});
        }
    }
    return all;
}

// Returns the point at a position along a connection. It may lie on the approach or on the exit lane.
Point point_of(const Model& model, int connection, double position_m) {
    const Lane& path = model.graph.lanes[at(connection)];
    const Lane& origin = model.graph.lanes[at(path.origin)];
    const double end_m = path.shape_start_m + path.length_m;
    if (position_m < 0.0) return pose_along(origin, origin.stop_line_m + position_m).point;
    if (position_m > end_m) return pose_along(model.graph.lanes[at(path.next[0])], position_m - end_m).point;
    return pose_along(path, position_m).point;
}

double distance_m(const Model& model, const Body& one, const Body& two) {
    constexpr double kSample_m = 0.5;
    double smallest_m = 1e9;
    for (double a = one.rear_m; a <= one.front_m; a += kSample_m) {
        const Point p = point_of(model, one.connection, a);
        for (double b = two.rear_m; b <= two.front_m; b += kSample_m) {
            const Point q = point_of(model, two.connection, b);
            smallest_m = std::min(smallest_m, std::hypot(p.x_m - q.x_m, p.y_m - q.y_m));
        }
    }
    return smallest_m;
}

struct Case {
    const char* fidelity;
    std::size_t population;
    const char* slow_exit;  // exit edge with a low speed limit; the queue on this edge holds up the other connections
    bool is_fork = false;   // fork_net() instead of turnaround_net()
};

// Shortens the straight connection to 3 m, less than a vehicle.
std::string with_short_connection(const std::string& net) {
    std::string text = replaced(net, "length=\"14\" shape=\"0,-1.6 14,-1.6\"", "length=\"3\" shape=\"0,-1.6 3,-1.6\"");
    return replaced(text, "shape=\"14,-1.6 114,-1.6\"", "shape=\"3,-1.6 103,-1.6\"");
}

class Diverging : public ::testing::TestWithParam<Case> {};

TEST_P(Diverging, VehiclesOnDifferentConnectionsDoNotTouch) {
    const SumoFiles files;
    const std::string slow = std::string("id=\"") + GetParam().slow_exit + "_0\" index=\"0\" speed=\"";
    const bool is_fork = GetParam().is_fork;
    const std::string net = replaced(is_fork ? fork_net() : turnaround_net(), slow + "13.89", slow + "1.5");
    files.write("my.net.xml", !is_fork && *GetParam().slow_exit == 'c' ? with_short_connection(net) : net);
    files.write("my.rou.xml", R"(<routes>
<flow id="r" from="a" to="d" vehsPerHour="500" end="200" departSpeed="max"/>
<flow id="s" from="a" to="c" vehsPerHour="500" end="200" departSpeed="max"/>
<flow id="t" from="a" to="b" vehsPerHour="300" end="200" departSpeed="max"/></routes>)");
    const Scenario scenario =
        parse_scenario(std::string(GetParam().fidelity) +
                           "duration: 240 s\nnetwork: {kind: sumo, net: ./my.net.xml, routes: [./my.rou.xml]}\n"
                           "populations: [CDG, CTG-Ref]\nmeasure: {window: 200 s}\n",
                       "my.yaml", {}, files.folder());
    const Model model = network_model(scenario, GetParam().population);
    Simulation simulation(model);
    double smallest_m = 1e9;
    int pairs = 0;
    while (simulation.time_s() < 240.0) {
        simulation.run_until(simulation.time_s() + 0.2);
        const std::vector<Body> all = bodies(model, simulation.state());
        for (std::size_t k = 0; k < all.size(); ++k) {
            for (std::size_t l = 0; l < k; ++l) {
                const bool overlap_along = all[k].rear_m <= all[l].front_m && all[l].rear_m <= all[k].front_m;
                if (all[k].connection == all[l].connection || !overlap_along) continue;
                smallest_m = std::min(smallest_m, distance_m(model, all[k], all[l]));
                ++pairs;
            }
        }
    }
    EXPECT_GT(pairs, 100);
    EXPECT_GT(smallest_m, 1.0) << "vehicles of 1 m width touch";
    EXPECT_GT(simulation.state().records.exited, is_fork ? 20 : 30);
    EXPECT_TRUE(simulation.state().records.violations.none());
}

constexpr const char* kMeso = "fidelity: meso\n";
constexpr const char* kFull = "fidelity: full\nstep: 10 ms\n";

// A slow vehicle drives to c. Its path diverges from the path to b after more than 30 m, but from the path to d after a
// few metres. Its follower drives to d and does not wait until the slow vehicle is clear of the path to b. A long
// follower overtakes the slow vehicle while its own rear is still on the stretch that the paths share.
TEST(DivergingFollower, PassesAVehicleThatHasDiverged) {
    for (const auto& [fidelity, length_m] :
         {std::pair<std::string, std::string>{kMeso, "5"}, {kFull, "5"}, {kMeso, "14"}, {kFull, "14"}}) {
        const SumoFiles files;
        const std::string c_0 = R"("c_0" index="0" speed=")";
        files.write("my.net.xml", replaced(fork_net(), c_0 + "13.89", c_0 + "1.5"));
        files.write("my.rou.xml", "<routes><vType id=\"follower\" length=\"" + length_m + R"("/>
<trip id="slow" depart="0" from="a" to="c" departSpeed="max"/>
<trip id="follower" type="follower" depart="4" from="a" to="d" departSpeed="max"/></routes>)");
        const Scenario scenario = parse_scenario(fidelity +
                                                     "duration: 60 s\nnetwork: {kind: sumo, net: ./my.net.xml, routes: "
                                                     "[./my.rou.xml]}\npopulations: [CDG]\nmeasure: {window: 40 s}\n",
                                                 "my.yaml", {}, files.folder());
        const Model model = network_model(scenario, 0);
        Simulation simulation(model);
        simulation.run_until(40.0);
        EXPECT_EQ(simulation.state().records.exited, 1) << fidelity << length_m;
        simulation.run_until(60.0);
        EXPECT_TRUE(simulation.state().records.violations.none()) << fidelity << length_m;
    }
}

INSTANTIATE_TEST_SUITE_P(Cases, Diverging,
                         ::testing::Values(Case{kMeso, 0, "b"}, Case{kMeso, 1, "b"}, Case{kFull, 0, "b"},
                                           Case{kFull, 1, "b"}, Case{kMeso, 0, "c"}, Case{kMeso, 1, "c"},
                                           Case{kFull, 0, "c"}, Case{kFull, 1, "c"}, Case{kMeso, 0, "c", true},
                                           Case{kMeso, 1, "c", true}, Case{kFull, 0, "c", true},
                                           Case{kFull, 1, "c", true}, Case{kMeso, 0, "d", true},
                                           Case{kFull, 1, "d", true}, Case{kFull, 0, "b", true}));

}  // namespace
}  // namespace stopline
