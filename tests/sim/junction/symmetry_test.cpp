// The reference intersection gives the same numbers when it is rotated or mirrored, or when its legs swap roles.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/containers/index.h"
#include "network/conflicts.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

constexpr double kUntil_s = 1.0 + 4 * 46.0;

Scenario turning_scenario() {
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml", {"demand.left=15 %", "demand.right=10 %"});
}

// Uses the population P50, so that both the policies and the turns of vehicles are drawn at random.
Model turning_model() { return build_model(turning_scenario(), 4); }

using Transform = std::function<Point(Point)>;

struct Symmetry {
    const char* name;
    Transform transform;
};

class TransformedIntersection : public testing::TestWithParam<Symmetry> {};
INSTANTIATE_TEST_SUITE_P(Symmetries, TransformedIntersection,
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

// Conflict areas follow from the shapes of the lanes alone, so they must not depend on the orientation. The mirrored
// intersection has left-hand traffic.
TEST_P(TransformedIntersection, GivesTheSameRun) {
    const Model original = turning_model();
    Model transformed = original;
    for (Lane& lane : transformed.graph.lanes) {
        std::transform(lane.shape.begin(), lane.shape.end(), lane.shape.begin(), GetParam().transform);
    }
    const std::vector<Lane>& lanes = transformed.graph.lanes;
    const auto first_connection =
        std::find_if(lanes.begin(), lanes.end(), [](const Lane& lane) { return lane.origin >= 0; });
    transformed.graph.conflicts.assign(lanes.size(), {});
    find_conflicts(transformed.graph, turning_scenario().network.intersection.clearance_m,
                   static_cast<int>(first_connection - lanes.begin()), static_cast<int>(lanes.size()));
    Simulation first(original);
    Simulation second(transformed);
    first.run_until(kUntil_s);
    second.run_until(kUntil_s);
    EXPECT_GT(first.state().records.gaps_accepted.size(), 5u);
    EXPECT_EQ(first.state_hash(), second.state_hash());
}

// Each leg hands its demand and its signal over to the next leg. The next leg must then discharge exactly the same
// traffic.
TEST(Symmetry, LegsAreAlike) {
    const Model original = turning_model();
    Model rotated = original;
    const std::map<std::string, std::string> next{
        {"west", "south"}, {"south", "east"}, {"east", "north"}, {"north", "west"}};
    const auto next_lane = [&](int lane) {
        const std::string& name = original.graph.lanes[at(lane)].name;
        const std::size_t cut = name.find('_');
        const std::string next_name = next.at(name.substr(0, cut)) + name.substr(cut);
        const auto found = std::find_if(original.graph.lanes.begin(), original.graph.lanes.end(),
                                        [&](const Lane& other) { return other.name == next_name; });
        return static_cast<int>(found - original.graph.lanes.begin());
    };
    const auto next_route = [&](int route) {
        for (int k = 0; k < static_cast<int>(original.graph.routes.size()); ++k) {
            if (original.graph.routes[at(k)].lanes[1] == next_lane(original.graph.routes[at(route)].lanes[1])) return k;
        }
        return -1;
    };
    rotated.signals = {};
    rotated.signals.add(fixed_time_plan(0, {original.signals.programme(1), original.signals.programme(0)}));
    for (DemandPlan::Inlet& inlet : rotated.demand.inlets) {
        inlet.lane = next_lane(inlet.lane);
        for (int& route : inlet.routes) route = next_route(route);
    }
    Simulation first(original);
    Simulation second(rotated);
    first.run_until(kUntil_s);
    second.run_until(kUntil_s);
    using Times = std::map<int, std::vector<double>>;  // [detector]
    Times first_s;
    Times second_s;
    const auto detector_on = [&](int lane, double position_m) {
        for (int k = 0; k < static_cast<int>(original.detectors.size()); ++k) {
            const Detector& d = original.detectors[at(k)];
            if (d.lane == lane && d.position_m == position_m) return k;
        }
        return -1;
    };
    for (const Crossing& c : first.state().records.crossings) {
        const Detector& d = original.detectors[at(c.detector)];
        first_s[detector_on(next_lane(d.lane), d.position_m)].push_back(c.time_s);
    }
    for (const Crossing& c : second.state().records.crossings) {
        const Detector& d = original.detectors[at(c.detector)];
        second_s[detector_on(d.lane, d.position_m)].push_back(c.time_s);
    }
    EXPECT_GT(first_s.size(), 16u);
    EXPECT_EQ(first_s, second_s);
}

}  // namespace
}  // namespace stopline
