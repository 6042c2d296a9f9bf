// Property tests: in random scenarios, core/sim and the reference engine make the same decisions, and their positions
// and speeds agree within rounding. On a difference, the smallest scenario found is printed.
//
// Not covered: teleports, the pass-blocker rule, missed turns of trips, signal controllers that react to traffic,
// vehicle types of SUMO, vehicles that enter between two intersections, and runs on several threads.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <ostream>
#include <string>

#include "reference/comparison.h"
#include "reference/plan_draw.h"
#include "reference/shrink.h"

namespace stopline {
namespace {

using namespace reference_engine;

// Returns in how many of `plans` scenarios rounding may decide: one of 20, plus two standard deviations of that number,
// plus one.
int most_decided_by_rounding(int plans) {
    const double mean = plans / 20.0;
    return 1 + static_cast<int>(mean + 2.0 * std::sqrt(mean));
}

// Compares both engines in the plans that `draw` returns.
template <class Draw>
Situations compare_in_random_plans(int plans, const Tolerance& tolerance, Draw draw) {
    Situations situations;
    int decided_by_rounding = 0;
    int uncovered = 0;
    for (int k = 0; k < plans; ++k) {
        const Plan plan = draw();
        const Comparison comparison = compare_engines(plan, tolerance);
        situations.add(comparison.situations);
        uncovered += comparison.uncovered_event.empty() ? 0 : 1;
        if (!comparison.difference) continue;
        if (is_decided_by_rounding(plan, comparison.difference->step, tolerance)) {
            ++decided_by_rounding;
            continue;
        }
        ADD_FAILURE() << "scenario " << k << ": " << shrunk({plan, *comparison.difference}, tolerance).text();
        return situations;
    }
    EXPECT_LE(decided_by_rounding, most_decided_by_rounding(plans));
    EXPECT_LE(uncovered, 1 + plans / 20);
    return situations;
}

using Draw = Plan (*)(PlanDraw& random);

using LeastEvents = std::vector<std::pair<std::int64_t Situations::*, std::int64_t>>;

// A family of scenarios, with the least number of events of each situation that its tests must contain.
struct Family {
    const char* name;
    bool is_mesoscale;
    Draw draw;
    int plans;       // in the fast test
    int slow_plans;  // in the slow test
    LeastEvents least = {};
    LeastEvents slow_least = {};
};

void PrintTo(const Family& family, std::ostream* out) { *out << family.name; }

using S = Situations;
const std::vector<Family> kFamilies{
    // A straight road with a light.
    {"MesoscaleRoads",
     true,
     [](PlanDraw& random) { return random.mesoscale(); },
     80,
     450,
     {{&S::stopped_at_red, 50},
      {&S::passed_at_yellow, 40},
      {&S::passed_at_red, 15},
      {&S::became_follower, 250},
      {&S::started_in_queue, 1500},
      {&S::start_messages, 150},
      {&S::entered_late, 500},
      {&S::exited, 300},
      {&S::slowed_before_limit, 400}}},
    {"FullRoads",
     false,
     [](PlanDraw& random) { return random.full_dynamics(); },
     25,
     200,
     {{&S::stopped_at_red, 3},
      {&S::passed_at_yellow, 3},
      {&S::became_follower, 40},
      {&S::started_in_queue, 30},
      {&S::entered_late, 60},
      {&S::gear_changes, 150},
      {&S::emergency_brakings, 500}}},
    // The streets of a crossing have green one after the other. Vehicles of one street start while vehicles of the
    // other are still inside, and in some scenarios the exit lanes are jammed.
    {"MesoscaleCrossings",
     true,
     [](PlanDraw& random) { return random.crossing(true); },
     40,
     200,
     {{&S::passed_at_red, 40}, {&S::yielded, 100}, {&S::held_at_green, 700}}},
    {"FullCrossings",
     false,
     [](PlanDraw& random) { return random.crossing(false); },
     8,
     50,
     {{&S::yielded, 5}, {&S::held_at_green, 300}}},
    {"MesoscaleTurns",
     true,
     [](PlanDraw& random) { return random.turns(true); },
     40,
     300,
     {{&S::yielded, 500}, {&S::held_at_green, 4000}, {&S::gaps_accepted, 150}, {&S::gaps_refused, 4000}}},
    {"FullTurns",
     false,
     [](PlanDraw& random) { return random.turns(false); },
     8,
     60,
     {{&S::yielded, 10}, {&S::held_at_green, 800}, {&S::gaps_accepted, 4}, {&S::gaps_refused, 2000}}},
    {"MesoscaleGrids",
     true,
     [](PlanDraw& random) { return random.grid(true); },
     12,
     100,
     {{&S::held_at_green, 1500}, {&S::gaps_accepted, 100}},
     {{&S::deadlocks, 100}}},
    {"FullGrids",
     false,
     [](PlanDraw& random) { return random.grid(false); },
     3,
     30,
     {{&S::held_at_green, 600}, {&S::gaps_accepted, 5}}},
    // Minor roads, right before left, all-way stops, zippers, roundabouts and lights of SUMO networks.
    {"MesoscaleJunctions",
     true,
     [](PlanDraw& random) { return random.imported(true); },
     60,
     400,
     {{&S::gaps_accepted, 250},
      {&S::gaps_refused, 3000},
      {&S::merged, 4000},
      {&S::stop_signs, 80},
      {&S::held_at_green, 50},
      {&S::mandatory_changes, 70},
      {&S::discretionary_changes, 25},
      {&S::alignments, 1000},
      {&S::stops_beyond_lane, 40}}},
    {"FullJunctions",
     false,
     [](PlanDraw& random) { return random.imported(false); },
     12,
     80,
     {{&S::gaps_accepted, 4}, {&S::gaps_refused, 500}, {&S::merged, 100}, {&S::stop_signs, 2}}},
    {"MesoscaleLaneChanges",
     true,
     [](PlanDraw& random) { return random.lane_changes(true); },
     15,
     200,
     {{&S::mandatory_changes, 80},
      {&S::discretionary_changes, 30},
      {&S::alignments, 200},
      {&S::held_at_green, 20},
      {&S::gaps_accepted, 150},
      {&S::let_in_waiting, 2}}},
    {"FullLaneChanges",
     false,
     [](PlanDraw& random) { return random.lane_changes(false); },
     4,
     60,
     {{&S::mandatory_changes, 3}, {&S::alignments, 20}}},
    {"MesoscalePlatoons",
     true,
     [](PlanDraw& random) { return random.mini_platoons(); },
     40,
     300,
     {{&S::time_gap_steps, 10000}, {&S::start_messages, 50}, {&S::held_at_green, 100}, {&S::mandatory_changes, 20}}},
    {"MesoscaleFleets",
     true,
     [](PlanDraw& random) { return random.mixed_fleet(true); },
     30,
     300,
     {{&S::became_follower, 2000}, {&S::gaps_accepted, 30}, {&S::merged, 500}, {&S::mandatory_changes, 10}}},
    {"FullFleets",
     false,
     [](PlanDraw& random) { return random.mixed_fleet(false); },
     8,
     80,
     {{&S::human_steps, 40000}, {&S::held_at_green, 1000}, {&S::gaps_accepted, 5}}},
};

class Reference : public ::testing::TestWithParam<Family> {
protected:
    static Situations compare(std::uint64_t seed, int plans) {
        PlanDraw random(seed);
        const Tolerance& tolerance = GetParam().is_mesoscale ? kMesoTolerance : kFullTolerance;
        return compare_in_random_plans(plans, tolerance, [&] { return GetParam().draw(random); });
    }

    static void expect_situations(const Situations& seen, const LeastEvents& events) {
        for (std::size_t k = 0; k < events.size(); ++k) {
            const auto& [count, least] = events[k];
            EXPECT_GE(seen.*count, least) << "situation " << k;
        }
    }
};

TEST_P(Reference, AgreesInRandomScenarios) {
    const Situations seen = compare(1, GetParam().plans);
    if (!HasFailure()) expect_situations(seen, GetParam().least);
}

INSTANTIATE_TEST_SUITE_P(Families, Reference, ::testing::ValuesIn(kFamilies),
                         [](const auto& family) { return std::string(family.param.name); });

class SlowReference : public Reference {};

TEST_P(SlowReference, AgreesInManyRandomScenarios) {
    const Situations seen = compare(2, GetParam().slow_plans);
    if (!HasFailure()) expect_situations(seen, GetParam().slow_least);
}

INSTANTIATE_TEST_SUITE_P(Families, SlowReference, ::testing::ValuesIn(kFamilies),
                         [](const auto& family) { return std::string(family.param.name); });

// Greens of 1.2 s let vehicles of all four approaches stop inside the crossing, where they wait for each other.
TEST(ReferenceCase, DeadlocksAtACrossingAgree) {
    Plan plan;
    plan.seed = 978650;
    plan.duration_s = 40.0;
    plan.meso = "start_passages";
    plan.step_s = 0.2;
    plan.dawdling = 0.0;
    plan.roads = Plan::Roads::intersection;
    plan.movements = {"straight"};
    plan.keeps_clear = true;
    plan.length_m = 120.0;
    plan.exit_m = 65.0;
    plan.first_green_s = 0.0;
    plan.green_s = 1.2;
    plan.yellow_s = 0.0;
    plan.all_red_s = 0.4;
    plan.demand = "saturated";
    const Comparison comparison = compare_engines(plan, kMesoTolerance);
    EXPECT_FALSE(comparison.difference) << comparison.difference->text();
    EXPECT_GT(comparison.situations.deadlocks, 0);
}

// Where the movements of a lane diverge, a turning leader hides a slow vehicle on the route of its follower.
TEST(ReferenceCase, HiddenLeadersAgree) {
    PlanDraw random(77);
    random.turns(false);
    random.turns(false);
    const Comparison comparison = compare_engines(random.turns(false), kFullTolerance);
    EXPECT_FALSE(comparison.difference) << comparison.difference->text();
    EXPECT_GT(comparison.situations.hidden_leaders, 10);
}

// core/sim keeps the vehicles of a lane in slots. A vehicle that stops at its line can move to another slot before the
// keep-clear rule for a crossing lane asks whether it stops. The rule must still recognise it.
TEST(ReferenceCase, TheKeepClearRuleRecognisesAStopperInAnotherSlot) {
    Plan plan;
    plan.seed = 828343;
    plan.duration_s = 30.0;
    plan.meso = "start_passages";
    plan.step_s = 0.2;
    plan.dawdling = 0.0;
    plan.roads = Plan::Roads::intersection;
    plan.movements = {"straight+left+right"};
    plan.keeps_clear = true;
    plan.length_m = 210.0;
    plan.exit_m = 239.0;
    plan.first_green_s = 11.4;
    plan.green_s = 6.0;
    plan.yellow_s = 1.4;
    plan.all_red_s = 1.0;
    plan.demand = "saturated";
    plan.entry_kmh = 20.0;
    plan.left_percent = 45.0;
    plan.right_percent = 15.0;
    plan.components = {{"CTG-Ref", 100.0}};
    const Comparison comparison = compare_engines(plan, kMesoTolerance);
    EXPECT_FALSE(comparison.difference) << comparison.difference->text();
}

// Returns a plan in which a queue starts at green while further vehicles enter upstream. With this seed, a vehicle
// enters while start messages go through the queue.
Plan queue_with_inflow() {
    Plan plan;
    plan.seed = 23;
    plan.meso = "passages";
    plan.duration_s = 60.0;
    plan.length_m = 250.0;
    plan.first_green_s = 30.0;
    plan.demand = "rate";
    plan.inflow_vehph = 1200.0;
    plan.lanes = 2;
    plan.components = {{"CDG", 70.0}, {"SWITCH-2", 30.0}};
    return plan;
}

// These tests show rules of core/sim that its documents do not state (UndocumentedRules). If a test fails because
// core/sim has given up the rule, remove the rule and the test.
TEST(UndocumentedRule, AnInsertionEndsTheStartMessages) {
    UndocumentedRules rules;
    rules.insertion_ends_start_messages = false;
    EXPECT_FALSE(compare_engines(queue_with_inflow(), kMesoTolerance).difference);
    EXPECT_TRUE(compare_engines(queue_with_inflow(), kMesoTolerance, rules).difference);
}

TEST(UndocumentedRule, ThePowerBoundNeedsAPolicyWithAPowerLimit) {
    Plan plan;
    plan.meso = "table2";
    plan.limit_kmh = 80.0;
    plan.vehicle = "electric_100kw";
    plan.components = {{"CTG-Ref", 100.0}};
    UndocumentedRules rules;
    rules.power_bound_needs_power_limit = false;
    EXPECT_FALSE(compare_engines(plan, kMesoTolerance).difference);
    EXPECT_TRUE(compare_engines(plan, kMesoTolerance, rules).difference);
}

TEST(UndocumentedRule, ALostLeaderStaysOnTheRadar) {
    PlanDraw random(80);
    const Plan plan = random.lane_changes(true);
    UndocumentedRules rules;
    rules.lost_leader_stays_on_radar = false;
    EXPECT_FALSE(compare_engines(plan, kMesoTolerance).difference);
    EXPECT_TRUE(compare_engines(plan, kMesoTolerance, rules).difference);
}

// The comparison finds a difference and prints a smaller scenario. The engines still differ in this scenario, and it
// can be loaded.
TEST(Comparison, PrintsASmallerScenarioThatStillDiffers) {
    UndocumentedRules rules;
    rules.insertion_ends_start_messages = false;
    const Plan plan = queue_with_inflow();
    const Comparison comparison = compare_engines(plan, kMesoTolerance, rules);
    ASSERT_TRUE(comparison.difference);
    EXPECT_FALSE(is_decided_by_rounding(plan, comparison.difference->step, kMesoTolerance, rules));
    const Failure failure = shrunk({plan, *comparison.difference}, kMesoTolerance, rules);
    EXPECT_EQ(failure.plan.lanes, 1);
    EXPECT_LT(failure.plan.duration_s, plan.duration_s);
    EXPECT_EQ(failure.plan.components.size(), 1U);
    EXPECT_TRUE(compare_engines(failure.plan, kMesoTolerance, rules).difference);
    const std::string text = failure.text();
    EXPECT_NE(text.find("the speed"), std::string::npos) << text;
    const std::string yaml = text.substr(text.find("seed:"));
    EXPECT_NO_THROW(parse_scenario(yaml, "printed scenario")) << yaml;
}

}  // namespace
}  // namespace stopline
