// Tests of the controller `dual_ring` without vehicles: the tests set the detectors.
#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "signals/ring_junction.h"
#include "signals/rings/ring_problems.h"

namespace stopline {
namespace {

// Phases in the lists count from 0, so phase 0 is the phase 1 of NEMA.
struct Begin {
    std::int64_t tick;
    RingPair pair;
    bool operator==(const Begin&) const = default;
};

// Returns the pairs of phases that begin within a time.
std::vector<Begin> pairs_within(Junction& junction, double time_s) {
    std::vector<Begin> begins;
    RingPair present = pair_of(junction);
    const std::int64_t end = junction.tick() + to_ticks(time_s, kStep_s);
    while (junction.tick() < end) {
        junction.step();
        if (pair_of(junction) != present) begins.push_back({junction.tick(), pair_of(junction)});
        present = pair_of(junction);
    }
    return begins;
}

std::ostream& operator<<(std::ostream& out, const Begin& begin) {
    return out << begin.tick << ": " << begin.pair.phase[0] << " and " << begin.pair.phase[1];
}

void set_all(SignalSettings& settings, const std::string& recall) {
    for (PhaseSettings& phase : settings.phases) phase.recall = recall;
}

TEST(DualRing, RecallServesAllPhasesInTheOrderOfTheFile) {
    SignalSettings settings = eight_phases(5.0, 20.0);
    set_all(settings, "minimum");
    Junction junction(settings, kMovements);
    const std::vector<Begin> expected{
        {10, {{0, 4}}}, {110, {{1, 5}}}, {210, {{2, 6}}}, {310, {{3, 7}}}, {410, {{0, 4}}}};
    EXPECT_EQ(pairs_within(junction, 45.0), expected);
    // Ring 2 serves its left turns last (lagging).
    std::swap(settings.phases[4], settings.phases[5]);
    std::swap(settings.phases[6], settings.phases[7]);
    Junction lagging(settings, kMovements);
    pairs_within(lagging, 2.0);
    EXPECT_EQ(lagging.light(movement("west_left")), Light::green);
    EXPECT_EQ(lagging.light(movement("west_straight")), Light::green);
    EXPECT_EQ(lagging.light(movement("east_left")), Light::red);
    EXPECT_EQ(lagging.light(movement("east_straight")), Light::red);
}

// A ring goes on by itself within a side. Before a barrier it waits for the other ring.
TEST(DualRing, RingsWaitForEachOtherAtBarriersOnly) {
    SignalSettings settings = eight_phases(5.0, 20.0);
    set_all(settings, "minimum");
    settings.phases[4].min_green_s = 12.0;  // left turn of ring 2
    Junction junction(settings, kMovements);
    const std::vector<Begin> expected{{10, {{0, 4}}}, {110, {{1, 4}}}, {180, {{1, 5}}}, {280, {{2, 6}}}};
    EXPECT_EQ(pairs_within(junction, 30.0), expected);
}

TEST(DualRing, SkipsPhasesWithoutCallsAndRestsInGreen) {
    Junction junction(eight_phases(5.0, 20.0), kMovements);
    pairs_within(junction, 60.0);
    const RingPair first = pair_of(junction);
    EXPECT_EQ(pairs_within(junction, 60.0).size(), 0U);
    junction.occupy(junction.stop_detector(movement("north_straight")), true);
    std::vector<Begin> begins = pairs_within(junction, 20.0);
    ASSERT_EQ(begins.size(), 1U);
    EXPECT_EQ(begins[0].pair, (RingPair{{3, -1}})) << "ring 2 has no call on the other side";
    EXPECT_EQ(begins[0].tick, 1200 + 1 + 50);
    // A call on the same side is served at once in the ring that is red.
    junction.occupy(junction.stop_detector(movement("north_left")), true);
    begins = pairs_within(junction, 1.0);
    ASSERT_EQ(begins.size(), 1U);
    EXPECT_EQ(begins[0].pair, (RingPair{{3, 6}}));
    EXPECT_EQ(first, (RingPair{{0, 4}}));
}

TEST(DualRing, DualEntryServesAPhaseWithoutACall) {
    SignalSettings settings = eight_phases(5.0, 20.0);
    settings.phases[7].dual_entry = "on";
    Junction junction(settings, kMovements);
    pairs_within(junction, 60.0);
    junction.occupy(junction.stop_detector(movement("north_straight")), true);
    const std::vector<Begin> begins = pairs_within(junction, 20.0);
    ASSERT_EQ(begins.size(), 1U);
    EXPECT_EQ(begins[0].pair, (RingPair{{3, 7}}));
}

// Without a call beyond the barrier, both rings begin the same side again for a phase whose turn was over.
TEST(DualRing, BothRingsClearForAPhaseWhoseTurnIsOver) {
    SignalSettings settings = eight_phases(5.0, 20.0);
    settings.phases[1].dual_entry = settings.phases[5].dual_entry = "on";
    Junction junction(settings, kMovements);
    junction.occupy(junction.stop_detector(movement("east_straight")), true);
    junction.occupy(junction.stop_detector(movement("west_straight")), true);
    pairs_within(junction, 30.0);
    EXPECT_EQ(pair_of(junction), (RingPair{{1, 5}}));
    junction.occupy(junction.stop_detector(movement("east_straight")), false);
    junction.occupy(junction.stop_detector(movement("west_straight")), false);
    junction.occupy(junction.stop_detector(movement("west_left")), true);
    const std::vector<Begin> begins = pairs_within(junction, 20.0);
    ASSERT_EQ(begins.size(), 1U);
    EXPECT_EQ(begins[0].pair, (RingPair{{0, 5}}));
    EXPECT_EQ(begins[0].tick, 301 + 50) << "yellow and red";
    EXPECT_EQ(junction.light(movement("west_straight")), Light::green);
    EXPECT_EQ(junction.state().green_start_tick[movement("west_straight")], 10)
        << "a movement that keeps its green has no yellow";
}

// --- Coordination ---------------------------------------------------------------------------------------------------

SignalSettings coordinated_phases() {
    SignalSettings settings = eight_phases(5.0, 20.0);
    settings.phases[1].coordinated = settings.phases[5].coordinated = "on";
    settings.cycle_s = 100.0;
    return settings;
}

TEST(DualRing, CoordinatedPhasesGetTheTimeThatOthersLeave) {
    Junction junction(coordinated_phases(), kMovements);
    const std::size_t coordinated = movement("east_straight");
    pairs_within(junction, 500.0);
    EXPECT_EQ(junction.light(coordinated), Light::green);
    EXPECT_EQ(junction.state().green_start_tick[coordinated], 10) << "no call: green all the time";
    // The background cycle begins at 1 s. The phases of the other side can begin at 51 s after its start.
    junction.occupy(junction.stop_detector(movement("north_straight")), true);
    std::vector<Begin> begins;
    while (begins.empty()) begins = pairs_within(junction, 0.1);
    EXPECT_EQ(begins[0].tick, 10 + 5000 + 500) << "yellow begins at the yield point of 45 s";
    junction.occupy(junction.stop_detector(movement("north_straight")), false);
    begins = pairs_within(junction, 30.0);
    ASSERT_EQ(begins.size(), 1U);
    EXPECT_EQ(begins[0].tick, 5510 + 50 + 50) << "after the minimum, since the gap has passed";
    EXPECT_EQ(begins[0].pair, (RingPair{{1, 5}}));
    // It holds its green up to the yield point of the next cycle, whatever the calls.
    junction.occupy(junction.stop_detector(movement("south_straight")), true);
    begins = pairs_within(junction, 200.0);
    ASSERT_FALSE(begins.empty());
    EXPECT_EQ(begins[0].tick, 10 + 6000 + 500);
}

TEST(DualRing, ALateCallWaitsForTheNextCycle) {
    for (const bool is_late : {false, true}) {
        Junction junction(coordinated_phases(), kMovements);
        // The last phases of the cycle are forced off at 95 s. Yellow and red (5 s) and the minimum (5 s) come before.
        pairs_within(junction, 1.0 + 300.0 + 85.0 - (is_late ? 0.0 : 0.1));
        junction.occupy(junction.stop_detector(movement("north_straight")), true);
        std::vector<Begin> begins;
        while (begins.empty()) begins = pairs_within(junction, 0.1);
        EXPECT_EQ(begins[0].tick, is_late ? 10 + 4000 + 500 : 10 + 3000 + 900);
    }
}

// With maximum recall all phases have their green times, and the cycle repeats exactly.
TEST(DualRing, TheBackgroundCycleRepeatsExactly) {
    SignalSettings settings = coordinated_phases();
    set_all(settings, "maximum");
    Junction junction(settings, kMovements);
    std::vector<Begin> expected{{10, {{1, 5}}}};  // a run begins with the coordinated phases
    for (int cycle = 0; cycle < 5; ++cycle) {
        const std::int64_t start = 10 + 1000 * cycle;
        if (cycle > 0) expected.push_back({start, {{0, 4}}});
        if (cycle > 0) expected.push_back({start + 250, {{1, 5}}});
        expected.push_back({start + 500, {{2, 6}}});
        expected.push_back({start + 750, {{3, 7}}});
    }
    EXPECT_EQ(pairs_within(junction, 500.0), expected);
}

// --- Settings -------------------------------------------------------------------------------------------------------

std::string problem_of(const SignalSettings& settings) {
    const std::vector<SignalProblem> problems = ring_problems(settings, 8);
    return problems.empty() ? "" : problems.front().field + ": " + problems.front().message;
}

TEST(DualRing, SettingsAreChecked) {
    EXPECT_EQ(problem_of(eight_phases()), "");
    EXPECT_EQ(problem_of(coordinated_phases()), "");
    EXPECT_EQ(problem_of({}), "controller: 'dual_ring' needs signal.phases");
    SignalSettings settings = coordinated_phases();
    settings.cycle_s = 0.0;
    EXPECT_EQ(problem_of(settings), "phases[1].coordinated: has no effect without signal.cycle");
    settings = coordinated_phases();
    settings.phases[5].coordinated = "off";
    EXPECT_EQ(problem_of(settings), "cycle: coordination needs a phase with 'coordinated: on' in ring 2");
    settings.phases[7].coordinated = "on";
    EXPECT_EQ(problem_of(settings),
              "phases[7].coordinated: the coordinated phases of both rings need the same barrier");
    settings = coordinated_phases();
    settings.phases[0].coordinated = "on";
    EXPECT_EQ(problem_of(settings), "phases[1].coordinated: ring 1 already has a coordinated phase");
    settings = coordinated_phases();
    settings.phases[0].green_s = 25.0;
    EXPECT_NE(problem_of(settings).find("barrier 1 take 55 s in ring 1 and 50 s in ring 2"), std::string::npos);
    settings = coordinated_phases();
    settings.cycle_s = 90.0;
    EXPECT_NE(problem_of(settings).find("cycle: 90 s is not the sum of the phases of a ring, 100 s"),
              std::string::npos);
    settings = coordinated_phases();
    settings.phases[3].min_green_s = 21.0;
    EXPECT_NE(problem_of(settings).find("phases[3].min_green: 21 s is longer than the green"), std::string::npos);
    settings = eight_phases();
    settings.phases[2].protected_movements.clear();
    EXPECT_EQ(problem_of(settings), "phases[2]: a phase of a ring needs movements");
}

}  // namespace
}  // namespace stopline
