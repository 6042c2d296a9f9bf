// Tests of check(): it refuses every lane graph that the engine cannot run, and names the faulty lane or route.
#include <gtest/gtest.h>

#include <cctype>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "base/input_error.h"
#include "network/lane_graph.h"
#include "support/streets.h"

namespace stopline {
namespace {

struct Damage {
    const char* name;
    std::function<void(LaneGraph&)> apply;
    const char* expected_text;  // expected part of the error message
};

// Returns the name of the damage as a valid test name.
std::string name_of(const testing::TestParamInfo<Damage>& info) {
    std::string name = info.param.name;
    for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    return name;
}

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
    {"route over lanes that are not connected",
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
INSTANTIATE_TEST_SUITE_P(Check, BrokenGraph, testing::ValuesIn(kDamages), name_of);

TEST_P(BrokenGraph, IsRefusedAndNamed) {
    ApproachSettings settings;
    settings.lanes = 2;
    LaneGraph graph = make_approach(settings);
    GetParam().apply(graph);
    try {
        check(graph);
        ADD_FAILURE() << GetParam().name << " was accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(GetParam().expected_text), std::string::npos) << error.what();
    }
}

// Invalid changes to neighbouring lanes. Lane 0 is a turn pocket of the approach first_west; lanes 1 to 3 lie to the
// right of the pocket.
const Damage kNeighbourDamages[] = {
    {"neighbour without the link back", [](LaneGraph& g) { g.lanes[1].left = -1; }, "first_west_in_1"},
    {"neighbour of another approach", [](LaneGraph& g) { g.lanes[3].right = 7; }, "first_west_in_3"},
    {"neighbours in the wrong order",
     [](LaneGraph& g) { std::swap(g.approaches[0].lanes[1], g.approaches[0].lanes[2]); }, "first_west"},
    {"stop line that is not aligned with the neighbours", [](LaneGraph& g) { g.lanes[0].start_offset_m += 1.0; },
     "is not beside"},
    {"lane that begins too early", [](LaneGraph& g) { g.lanes[0].start_offset_m = -1.0; }, "first_west_in_0"},
    {"approach that does not have the lane", [](LaneGraph& g) { g.lanes[0].approach = 1; }, "first_west_in_0"},
    {"lane of two approaches", [](LaneGraph& g) { g.approaches.push_back(g.approaches[1]); }, "first_south_in_0"},
    {"unknown approach", [](LaneGraph& g) { g.lanes.back().approach = 99; }, "second"},
    {"lane without approach beside another", [](LaneGraph& g) { g.lanes.back().left = 3; }, "second"},
    {"approach with an unknown lane", [](LaneGraph& g) { g.approaches[2].lanes[0] = 9999; }, "does not exist"},
    {"turn shares above 100 %", [](LaneGraph& g) { g.approaches[0].right_share = 0.95; }, "first_west"},
    {"signal group without a stage", [](LaneGraph& g) { g.stage_of.pop_back(); }, "has a stage"},
};

class BrokenApproach : public testing::TestWithParam<Damage> {};
INSTANTIATE_TEST_SUITE_P(Check, BrokenApproach, testing::ValuesIn(kNeighbourDamages), name_of);

TEST_P(BrokenApproach, IsRefusedAndNamed) {
    LaneGraph graph = make_streets(streets_with_pockets());
    check(graph);
    GetParam().apply(graph);
    try {
        check(graph);
        ADD_FAILURE() << GetParam().name << " was accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(GetParam().expected_text), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace stopline
