// check() refuses every graph that the engine could not run on, and names what is wrong.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "base/input_error.h"
#include "network/lane_graph.h"

namespace stopline {
namespace {

struct Damage {
    const char* what;
    std::function<void(LaneGraph&)> apply;
    const char* named;  // what the message must name
};

const Damage kDamages[] = {
    {"zero length", [](LaneGraph& g) { g.lanes[1].length_m = 0.0; }, "exit_0"},
    {"negative length", [](LaneGraph& g) { g.lanes[0].length_m = -5.0; }, "approach_0"},
    {"length not a number", [](LaneGraph& g) { g.lanes[0].length_m = std::numeric_limits<double>::quiet_NaN(); },
     "approach_0"},
    {"zero limit", [](LaneGraph& g) { g.lanes[3].limit_mps = 0.0; }, "exit_1"},
    {"signal group beyond the last", [](LaneGraph& g) { g.lanes[2].signal_group = 1; }, "approach_1"},
    {"next lane beyond the last", [](LaneGraph& g) { g.lanes[2].next.push_back(4); }, "approach_1"},
    {"negative next lane", [](LaneGraph& g) { g.lanes[2].next = {-1}; }, "approach_1"},
    {"empty route", [](LaneGraph& g) { g.routes[1].lanes.clear(); }, "straight_1"},
    {"route over an unknown lane",
     [](LaneGraph& g) {
         g.routes[0].lanes = {0, 17};
     },
     "straight_0"},
    {"route over a negative lane",
     [](LaneGraph& g) {
         g.routes[0].lanes = {-1, 1};
     },
     "straight_0"},
    {"route that jumps",
     [](LaneGraph& g) {
         g.routes[0].lanes = {0, 3};
     },
     "straight_0"},
    {"route against the direction",
     [](LaneGraph& g) {
         g.routes[1].lanes = {3, 2};
     },
     "straight_1"},
};

class BrokenGraph : public testing::TestWithParam<Damage> {};
INSTANTIATE_TEST_SUITE_P(Check, BrokenGraph, testing::ValuesIn(kDamages));

TEST_P(BrokenGraph, IsRefusedByName) {
    ApproachSettings settings;
    settings.lanes = 2;
    LaneGraph graph = make_approach(settings);
    GetParam().apply(graph);
    try {
        check(graph);
        ADD_FAILURE() << GetParam().what << " was accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(GetParam().named), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace stopline
