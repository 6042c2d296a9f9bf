// An intersection looks the same from every side: turned, mirrored, or with its arms renamed, it gives the same numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "network/conflicts.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

constexpr double kUntil_s = 1.0 + 4 * 46.0;

Scenario busy() {
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml", {"demand.left=15 %", "demand.right=10 %"});
}

// P50, so that policies and turns are both drawn.
Model busy_model() { return build_model(busy(), 4); }

using Transform = std::function<Point(Point)>;

struct Symmetry {
    const char* name;
    Transform transform;
};

class SeenFromElsewhere : public testing::TestWithParam<Symmetry> {};
INSTANTIATE_TEST_SUITE_P(Symmetries, SeenFromElsewhere,
                         testing::Values(Symmetry{"quarter_turn",
                                                  [](Point p) {
                                                      return Point{-p.y_m, p.x_m};
                                                  }},
                                         Symmetry{"half_turn",
                                                  [](Point p) {
                                                      return Point{-p.x_m, -p.y_m};
                                                  }},
                                         Symmetry{"mirrored",
                                                  [](Point p) {
                                                      return Point{-p.x_m, p.y_m};
                                                  }},
                                         Symmetry{"mirrored_on_the_diagonal",
                                                  [](Point p) {
                                                      return Point{p.y_m, p.x_m};
                                                  }}),
                         [](const testing::TestParamInfo<Symmetry>& symmetry) { return symmetry.param.name; });

// Conflict areas come from the lines alone, and so must be found again wherever these lie: a mirrored intersection is one with
// left-hand traffic.
TEST_P(SeenFromElsewhere, TheSameVehiclesPassAtTheSameTimes) {
    const Model here = busy_model();
    Model there = here;
    for (Lane& lane : there.graph.lanes) {
        std::transform(lane.shape.begin(), lane.shape.end(), lane.shape.begin(), GetParam().transform);
    }
    const std::vector<Lane>& lanes = there.graph.lanes;
    const auto inside = std::find_if(lanes.begin(), lanes.end(), [](const Lane& lane) { return lane.origin >= 0; });
    there.graph.conflicts.assign(lanes.size(), {});
    find_conflicts(there.graph, busy().network.intersection.clearance_m, static_cast<int>(inside - lanes.begin()),
                   static_cast<int>(lanes.size()));
    Simulation one(here);
    Simulation two(there);
    one.run_until(kUntil_s);
    two.run_until(kUntil_s);
    EXPECT_GT(one.state().records.gaps_accepted.size(), 5u);
    EXPECT_EQ(one.state_hash(), two.state_hash());
}

// The demand of each arm moves on to the next, and so do the lights: each arm then passes what the one before it passed.
TEST(Symmetry, ArmsAreAlike) {
    const Model here = busy_model();
    Model there = here;
    const std::map<std::string, std::string> next{
        {"west", "south"}, {"south", "east"}, {"east", "north"}, {"north", "west"}};
    const auto turned = [&](int lane) {
        const std::string& name = here.graph.lanes[at(lane)].name;
        const std::size_t cut = name.find('_');
        const std::string wanted = next.at(name.substr(0, cut)) + name.substr(cut);
        const auto found = std::find_if(here.graph.lanes.begin(), here.graph.lanes.end(),
                                        [&](const Lane& other) { return other.name == wanted; });
        return static_cast<int>(found - here.graph.lanes.begin());
    };
    const auto turned_route = [&](int route) {
        for (int k = 0; k < static_cast<int>(here.graph.routes.size()); ++k) {
            if (here.graph.routes[at(k)].lanes[1] == turned(here.graph.routes[at(route)].lanes[1])) return k;
        }
        return -1;
    };
    std::swap(there.signals[0], there.signals[1]);
    for (DemandPlan::Inlet& inlet : there.demand.inlets) {
        inlet.lane = turned(inlet.lane);
        for (int& route : inlet.routes) route = turned_route(route);
    }
    Simulation one(here);
    Simulation two(there);
    one.run_until(kUntil_s);
    two.run_until(kUntil_s);
    using Times = std::map<int, std::vector<double>>;  // by detector
    Times first;
    Times second;
    const auto detector_on = [&](int lane, double position_m) {
        for (int k = 0; k < static_cast<int>(here.detectors.size()); ++k) {
            const Detector& d = here.detectors[at(k)];
            if (d.lane == lane && d.position_m == position_m) return k;
        }
        return -1;
    };
    for (const Crossing& c : one.state().records.crossings) {
        const Detector& d = here.detectors[at(c.detector)];
        first[detector_on(turned(d.lane), d.position_m)].push_back(c.time_s);
    }
    for (const Crossing& c : two.state().records.crossings) {
        const Detector& d = here.detectors[at(c.detector)];
        second[detector_on(d.lane, d.position_m)].push_back(c.time_s);
    }
    EXPECT_GT(first.size(), 16u);
    EXPECT_EQ(first, second);
}

}  // namespace
}  // namespace stopline
