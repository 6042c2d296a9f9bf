// Every problem of streets is found, at its field.
#include "network/street_checks.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "support/streets.h"

namespace stopline {
namespace {

struct Damage {
    const char* what;
    std::function<void(StreetSettings&)> apply;
    const char* field;
    const char* message;
};

StreetIntersection& first(StreetSettings& s) { return s.intersections[0]; }
StreetIntersection& second(StreetSettings& s) { return s.intersections[1]; }

const Damage kDamages[] = {
    {"two of one name", [](StreetSettings& s) { second(s).name = "first"; }, "intersections[first].name",
     "appears twice"},
    {"a second arm on a side", [](StreetSettings& s) { first(s).arms[2].from = "west"; },
     "intersections[first].arms[2].from", "a second arm in the west"},
    {"one arm only", [](StreetSettings& s) { first(s).arms.resize(1); }, "intersections[first].arms", "two arms"},
    {"another cycle", [](StreetSettings& s) { second(s).programme.minor_green_s = 20.0; },
     "intersections[second].programme", "sum to a cycle of 68 s, those of 'first' to 60 s"},
    {"no green for the minor street",
     [](StreetSettings& s) {
         for (auto& node : s.intersections) node.programme.minor_green_s = 0.0;
     },
     "intersections[first].programme.minor_green", "need a green"},
    {"the same place", [](StreetSettings& s) { second(s).x_m = 0.0; }, "intersections[second].x",
     "only 0 m from 'first'"},
    {"no road between", [](StreetSettings& s) { second(s).x_m = 45.0; }, "intersections[second].x", "need 50 m"},
    {"a left turn from the right",
     [](StreetSettings& s) {
         first(s).arms[0].lanes = {{"straight"}, {"straight+left"}, {"straight+right"}};
     },
     "intersections[first].arms[0].lanes[1].movements", "'left' from the right of a lane that leads 'straight'"},
    {"pockets alone", [](StreetSettings& s) { first(s).arms[2].lanes[0].pocket_m = 30.0; },
     "intersections[first].arms[2].lanes", "one lane at least"},
    {"a pocket in the middle", [](StreetSettings& s) { first(s).arms[0].lanes[1].pocket_m = 30.0; },
     "intersections[first].arms[0].lanes[1].pocket", "to the left or to the right"},
    {"no room in the median",
     [](StreetSettings& s) {
         s.median_m = 3.0;
         s.intersections[0].arms[0].lanes.insert(s.intersections[0].arms[0].lanes.begin(), {"left", 50.0});
     },
     "intersections[first].arms[0].lanes", "1 of 3.5 m do not fit into its 3 m"},
    {"lanes of which neighbours touch", [](StreetSettings& s) { s.clearance_m = 3.2; }, "clearance",
     "value 3.2 m is too large for lanes of 3.5 m, vehicles on neighbouring lanes would touch: at most 3 m"},
    {"lanes as wide as a vehicle", [](StreetSettings& s) { s.lane_width_m = 2.0; }, "clearance",
     "value 2 m is too large for lanes of 2 m, vehicles on neighbouring lanes would touch: at most 1.5 m"},
    {"too small", [](StreetSettings& s) { second(s).radius_m = 14.0; }, "intersections[second].radius",
     "need at least 14.5 m"},
    {"more than all turn", [](StreetSettings& s) { first(s).arms[0].right = 0.95; },
     "intersections[first].arms[0].left", "exceed 100 %"},
    {"a turn that no lane allows", [](StreetSettings& s) { first(s).arms[0].lanes[0].movements = "straight"; },
     "intersections[first].arms[0].left", "no lane allows the movement 'left' of 8 % of the traffic"},
    {"nobody may go straight on", [](StreetSettings& s) { first(s).arms[2].lanes[0].movements = "left+right"; },
     "intersections[first].arms[2].lanes", "no lane allows the movement 'straight' of 75 %"},
    {"no exit", [](StreetSettings& s) { first(s).arms[3].exits = 0; },
     "intersections[first].arms[0].lanes[0].movements", "there is no exit in the north"},
    {"no arm", [](StreetSettings& s) { first(s).arms.pop_back(); }, "intersections[first].arms[0].lanes[0].movements",
     "there is no exit in the north"},
    {"fewer exits than lanes", [](StreetSettings& s) { first(s).arms[1].exits = 2; },
     "intersections[first].arms[0].lanes[0].movements", "3 lanes lead 'straight', but there are 2 exits in the east"},
    {"exits that end", [](StreetSettings& s) { first(s).arms[1].exits = 4; }, "intersections[second].arms[0].lanes",
     "4 exits of 'first' lead here, but only 3 lanes go on"},
    {"no facing arm",
     [](StreetSettings& s) {
         s.intersections[1].arms = {s.intersections[1].arms[2], s.intersections[1].arms[3]};
         for (StreetArm& arm : s.intersections[1].arms) {
             arm.lanes = {{"straight"}};
             arm.left = arm.right = 0.0;
         }
     },
     "intersections[first].arms[1].from", "runs into 'second', which has no arm in the west"},
    {"a pocket longer than the road",
     [](StreetSettings& s) {
         s = streets_with_pockets();
         s.intersections[0].arms[1].lanes[0].pocket_m = 160.0;
     },
     "intersections[first].arms[1].lanes[0].pocket", "must be shorter than the approach of 160 m"},
};

TEST(StreetChecks, AcceptWhatIsSound) {
    EXPECT_TRUE(street_problems(two_streets()).empty());
    EXPECT_TRUE(street_problems(streets_with_pockets()).empty());
    StreetSettings narrow = two_streets();
    narrow.lane_width_m = 2.5;
    EXPECT_TRUE(street_problems(narrow).empty());
}

TEST(StreetChecks, NameEveryProblem) {
    for (const Damage& damage : kDamages) {
        StreetSettings streets = two_streets();
        damage.apply(streets);
        const std::vector<StreetProblem> problems = street_problems(streets);
        ASSERT_FALSE(problems.empty()) << damage.what;
        EXPECT_EQ(problems[0].field, damage.field) << damage.what;
        EXPECT_NE(problems[0].message.find(damage.message), std::string::npos)
            << damage.what << ": " << problems[0].message;
    }
}

}  // namespace
}  // namespace stopline
