// Bodies of vehicles that go different ways from one lane of an imported network, from their places in the plane: whatever the simulation counts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "runs/network/network.h"
#include "scenario/import_sumo.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::replaced;
using testing::SumoFiles;
using testing::turnaround_net;

// A vehicle past the stop line, or not yet: along its way, from the line.
struct Body {
    int way;
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
            const int way = before ? next : lane.origin >= 0 ? static_cast<int>(k) : record.previous_lane;
            if (way < 0) continue;
            const Lane& inside = model.graph.lanes[at(way)];
            double start_m = before ? -lane.stop_line_m : inside.shape_start_m;
            if (!before && lane.origin < 0) start_m += inside.length_m;
            const double front_m = start_m + state.vehicles.position_m[at(slot)];
            all.push_back({way, front_m, front_m - static_cast<double>(state.vehicles.length_m[at(slot)])});
        }
    }
    return all;
}

Point point_of(const Model& model, int way, double along_m) {
    const Lane& inside = model.graph.lanes[at(way)];
    const Lane& origin = model.graph.lanes[at(inside.origin)];
    const double whole_m = inside.shape_start_m + inside.length_m;
    if (along_m < 0.0) return pose_along(origin, origin.stop_line_m + along_m).point;
    if (along_m > whole_m) return pose_along(model.graph.lanes[at(inside.next[0])], along_m - whole_m).point;
    return pose_along(inside, along_m).point;
}

double apart_m(const Model& model, const Body& one, const Body& two) {
    constexpr double kSample_m = 0.5;
    double least_m = 1e9;
    for (double a = one.rear_m; a <= one.front_m; a += kSample_m) {
        const Point p = point_of(model, one.way, a);
        for (double b = two.rear_m; b <= two.front_m; b += kSample_m) {
            const Point q = point_of(model, two.way, b);
            least_m = std::min(least_m, std::hypot(p.x_m - q.x_m, p.y_m - q.y_m));
        }
    }
    return least_m;
}

struct Mode {
    const char* fidelity;
    std::size_t population;
    const char* slow;  // where it goes on slowly: the others wait for rears
};

// Straight on over 3 m, less than a vehicle.
std::string short_net(const std::string& net) {
    std::string text = replaced(net, "length=\"14\" shape=\"0,-1.6 14,-1.6\"", "length=\"3\" shape=\"0,-1.6 3,-1.6\"");
    return replaced(text, "shape=\"14,-1.6 114,-1.6\"", "shape=\"3,-1.6 103,-1.6\"");
}

class Parting : public ::testing::TestWithParam<Mode> {};

TEST_P(Parting, VehiclesOnDifferentWaysDoNotTouch) {
    const SumoFiles files;
    const std::string slow = std::string("id=\"") + GetParam().slow + "_0\" index=\"0\" speed=\"";
    const std::string net = replaced(turnaround_net(), slow + "13.89", slow + "1.5");
    files.write("my.net.xml", *GetParam().slow == 'c' ? short_net(net) : net);
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
    double least_m = 1e9;
    int together = 0;
    while (simulation.time_s() < 240.0) {
        simulation.run_until(simulation.time_s() + 0.2);
        const std::vector<Body> all = bodies(model, simulation.state());
        for (std::size_t k = 0; k < all.size(); ++k) {
            for (std::size_t l = 0; l < k; ++l) {
                const bool follows =
                    all[k].rear_m > all[l].front_m || all[l].rear_m > all[k].front_m;  // one behind the other
                if (all[k].way == all[l].way || follows) continue;
                least_m = std::min(least_m, apart_m(model, all[k], all[l]));
                ++together;
            }
        }
    }
    EXPECT_GT(together, 100);
    EXPECT_GT(least_m, 1.0) << "bodies 1 m wide touch";
    EXPECT_GT(simulation.state().records.exited, 30);
    EXPECT_TRUE(simulation.state().records.violations.none());
}

constexpr const char* kMeso = "fidelity: meso\n";
constexpr const char* kFull = "fidelity: full\nstep: 10 ms\n";
INSTANTIATE_TEST_SUITE_P(Modes, Parting,
                         ::testing::Values(Mode{kMeso, 0, "b"}, Mode{kMeso, 1, "b"}, Mode{kFull, 0, "b"},
                                           Mode{kFull, 1, "b"}, Mode{kMeso, 0, "c"}, Mode{kMeso, 1, "c"},
                                           Mode{kFull, 0, "c"}, Mode{kFull, 1, "c"}));

}  // namespace
}  // namespace stopline
