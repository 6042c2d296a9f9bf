// Tests of street_problems(): it reports each problem with its field.
#include "network/generators/street_checks.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "support/streets.h"

namespace stopline {
namespace {

struct Damage {
    const char* name;
    std::function<void(StreetSettings&)> apply;
    const char* field;
    const char* message;
};

StreetIntersection& first(StreetSettings& s) { return s.intersections[0]; }
StreetIntersection& second(StreetSettings& s) { return s.intersections[1]; }

const Damage kDamages[] = {
    {"two intersections with one name", [](StreetSettings& s) { second(s).name = "first"; },
     "intersections[first].name", "appears twice"},
    {"a second leg on a side", [](StreetSettings& s) { first(s).legs[2].from = "west"; },
     "intersections[first].legs[2].from", "there is already a leg in the west"},
    {"one leg only", [](StreetSettings& s) { first(s).legs.resize(1); }, "intersections[first].legs", "two legs"},
    {"different cycles", [](StreetSettings& s) { second(s).programme.minor_green_s = 20.0; },
     "intersections[second].programme", "sum to a cycle of 68 s, those of 'first' to 60 s"},
    {"no green for the minor street",
     [](StreetSettings& s) {
         for (auto& node : s.intersections) node.programme.minor_green_s = 0.0;
     },
     "intersections[first].programme.minor_green", "need a green"},
    {"the same position", [](StreetSettings& s) { second(s).x_m = 0.0; }, "intersections[second].x",
     "only 0 m from 'first'"},
    {"no road between the intersections", [](StreetSettings& s) { second(s).x_m = 45.0; }, "intersections[second].x",
     "need 50 m"},
    {"a left turn from a lane further right",
     [](StreetSettings& s) {
         first(s).legs[0].lanes = {{"straight"}, {"straight+left"}, {"straight+right"}};
     },
     "intersections[first].legs[0].lanes[1].movements", "'left' is allowed to the right of a lane with 'straight'"},
    {"pockets only", [](StreetSettings& s) { first(s).legs[2].lanes[0].pocket_m = 30.0; },
     "intersections[first].legs[2].lanes", "at least one lane"},
    {"a pocket in the middle", [](StreetSettings& s) { first(s).legs[0].lanes[1].pocket_m = 30.0; },
     "intersections[first].legs[0].lanes[1].pocket", "to the left or to the right"},
    {"a pocket wider than the median",
     [](StreetSettings& s) {
         s.median_m = 3.0;
         s.intersections[0].legs[0].lanes.insert(s.intersections[0].legs[0].lanes.begin(), {"left", 50.0});
     },
     "intersections[first].legs[0].lanes", "their width, 1 x 3.5 m, exceeds median, 3 m; set median to at least 3.5 m"},
    {"vehicles on neighbouring lanes touch", [](StreetSettings& s) { s.clearance_m = 3.2; }, "clearance",
     "value 3.2 m is too large for lanes of 3.5 m: vehicles on neighbouring lanes would touch. The maximum is 3 m"},
    {"lanes as wide as a vehicle", [](StreetSettings& s) { s.lane_width_m = 2.0; }, "clearance",
     "value 2 m is too large for lanes of 2 m: vehicles on neighbouring lanes would touch. The maximum is 1.5 m"},
    {"radius too small for the lanes", [](StreetSettings& s) { second(s).radius_m = 14.0; },
     "intersections[second].radius", "need a radius of at least 14.5 m"},
    {"turn shares above 100 %", [](StreetSettings& s) { first(s).legs[0].right_share = 0.95; },
     "intersections[first].legs[0].left", "exceed 100 %"},
    {"a turn that no lane allows", [](StreetSettings& s) { first(s).legs[0].lanes[0].movements = "straight"; },
     "intersections[first].legs[0].left", "no lane allows 'left', but this is the movement of 8 % of the traffic"},
    {"no lane for straight traffic", [](StreetSettings& s) { first(s).legs[2].lanes[0].movements = "left+right"; },
     "intersections[first].legs[2].lanes", "no lane allows 'straight', but this is the movement of 75 %"},
    {"no exit lane", [](StreetSettings& s) { first(s).legs[3].exits = 0; },
     "intersections[first].legs[0].lanes[0].movements", "there is no exit in the north"},
    {"no leg", [](StreetSettings& s) { first(s).legs.pop_back(); }, "intersections[first].legs[0].lanes[0].movements",
     "there is no exit in the north"},
    {"fewer exits than lanes", [](StreetSettings& s) { first(s).legs[1].exits = 2; },
     "intersections[first].legs[0].lanes[0].movements", "3 lanes lead 'straight', but there are 2 exits in the east"},
    {"exit lanes without continuation", [](StreetSettings& s) { first(s).legs[1].exits = 4; },
     "intersections[second].legs[0].lanes", "4 exits of 'first' lead here, but only 3 lanes continue them"},
    {"no facing leg",
     [](StreetSettings& s) {
         s.intersections[1].legs = {s.intersections[1].legs[2], s.intersections[1].legs[3]};
         for (StreetLeg& leg : s.intersections[1].legs) {
             leg.lanes = {{"straight"}};
             leg.left_share = leg.right_share = 0.0;
         }
     },
     "intersections[first].legs[1].from", "the leg reaches 'second', which has no leg in the west"},
    {"a pocket longer than the road",
     [](StreetSettings& s) {
         s = streets_with_pockets();
         s.intersections[0].legs[1].lanes[0].pocket_m = 160.0;
     },
     "intersections[first].legs[1].lanes[0].pocket", "must be shorter than the approach of 160 m"},
};

TEST(StreetChecks, AcceptValidStreets) {
    EXPECT_TRUE(street_problems(two_streets()).empty());
    EXPECT_TRUE(street_problems(streets_with_pockets()).empty());
    StreetSettings narrow = two_streets();
    narrow.lane_width_m = 2.5;
    EXPECT_TRUE(street_problems(narrow).empty());
}

TEST(StreetChecks, NameTheFieldOfEachProblem) {
    for (const Damage& damage : kDamages) {
        StreetSettings streets = two_streets();
        damage.apply(streets);
        const std::vector<StreetProblem> problems = street_problems(streets);
        ASSERT_FALSE(problems.empty()) << damage.name;
        EXPECT_EQ(problems[0].field, damage.field) << damage.name;
        EXPECT_NE(problems[0].message.find(damage.message), std::string::npos)
            << damage.name << ": " << problems[0].message;
    }
}

}  // namespace
}  // namespace stopline
