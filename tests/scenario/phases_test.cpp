// Tests of the checks of signal.phases and signal.programmes.
#include <gtest/gtest.h>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

// Lines 1 to 6 of the file; the signal follows.
constexpr const char* kIntersection =
    "duration: 0 s\n"
    "network:\n"
    "  kind: intersection\n"
    "  intersection:\n"
    "    lanes: [{movements: left}, {movements: straight+right}]\n"
    "signal:\n";

std::string error_of_signal(const std::string& signal) { return error_of(kIntersection + signal); }

// Returns a list of two phases for each street: left turns first, then the other movements.
std::string four_phases() {
    return "  phases:\n"
           "  - {protected: [west_left, east_left], green: 8 s}\n"
           "  - {protected: [west_straight, west_right, east_straight, east_right], green: 20 s}\n"
           "  - {protected: [south_left, north_left], green: 8 s}\n"
           "  - {protected: [south_straight, south_right, north_straight, north_right], green: 20 s}\n";
}

TEST(SignalPhases, AreAccepted) {
    EXPECT_EQ(error_of_signal(four_phases()), "");
    EXPECT_EQ(error_of_signal(four_phases() + "  - {green: 12 s, yellow: 0 s, all_red: 0 s}\n"), "");
}

TEST(SignalPhases, ConflictingProtectedGreensAreRefusedByName) {
    const std::string error = error_of_signal(
        "  phases:\n"
        "  - protected: [west_left, east_left]\n"
        "    green: 8 s\n"
        "  - protected:\n"
        "    - west_straight\n"
        "    - east_straight\n"
        "    - west_left\n"
        "    permissive: [east_left, west_right, east_right]\n"
        "    green: 20 s\n"
        "  - {protected: [south_straight, north_straight, south_right, north_right], permissive: [south_left, "
        "north_left], green: 20 s}\n");
    EXPECT_TRUE(contains(error,
                         "test.yaml:13:7: field 'signal.phases[1].protected[2]': the protected movements east_straight "
                         "and west_left of phase 2 conflict"));
    EXPECT_EQ(lines_of(error), 1U) << error;
}

TEST(SignalPhases, PermissiveMovementsNeedAnOrder) {
    const std::string error = error_of_signal(
        "  phases:\n"
        "  - {permissive: [west_straight, south_straight], green: 8 s}\n" +
        four_phases().substr(10));
    EXPECT_TRUE(contains(error,
                         "test.yaml:8:34: field 'signal.phases[0].permissive[1]': the permissive movements "
                         "west_straight and south_straight of phase 1 conflict, and neither yields"));
}

TEST(SignalPhases, EveryMovementNeedsGreen) {
    const std::string phases = four_phases();
    const std::string error = error_of_signal(phases.substr(0, phases.find("  - {protected: [south_left")) +
                                              "  - {protected: [south_left, north_left, south_right], green: 8 s}\n");
    EXPECT_TRUE(
        contains(error,
                 "test.yaml:8:3: field 'signal.phases': each movement needs green in some phase; without green: "
                 "south_straight, north_straight, north_right"));
}

TEST(SignalPhases, NamesOfMovementsMustExist) {
    EXPECT_TRUE(contains(error_of_signal(four_phases() + "  - {protected: [west_lef], green: 8 s}\n"),
                         "test.yaml:12:18: field 'signal.phases[4].protected[0]': there is no movement 'west_lef'"
                         "; did you mean 'west_left'? Known: west_straight, west_right, west_left, south_straight"));
    EXPECT_TRUE(
        contains(error_of_signal(four_phases() + "  - {protected: west_left, permissive: west_left, green: 8 s}\n"),
                 "the phase names the movement west_left twice"));
    // The lanes allow no left turn.
    const std::string no_left = "network: {kind: grid, intersection: {lanes: [{movements: straight+right}]}}\n";
    EXPECT_TRUE(contains(error_of(no_left + "signal: {phases: [{protected: [west_left], green: 8 s}]}\n"),
                         "there is no movement 'west_left'"));
}

TEST(SignalPhases, TimesAreChecked) {
    EXPECT_TRUE(contains(error_of_signal(four_phases() + "  - {green: 1.005 s}\n"),
                         "field 'signal.phases[4].green': 1.005 s is not a whole number of steps"));
    EXPECT_TRUE(
        contains(error_of_signal(four_phases() + "  - {yellow: 3 s}\n"), "'signal.phases[4].green' is missing"));
    EXPECT_TRUE(contains(error_of_signal(four_phases() + "  green: 10 s\n"),
                         "field 'signal.green': has no effect: the phases have times of their own"));
    EXPECT_TRUE(contains(error_of_signal(four_phases() + "  - {green: 10 s, gap: 2 s}\n"),
                         "field 'signal.phases[4].gap': has no effect with the controller fixed_time"));
    EXPECT_TRUE(contains(error_of_signal(four_phases() + "  cycle: 80 s\n"),
                         "field 'signal.cycle': must be left out here: it follows from the phases, 88 s"));
}

TEST(SignalPhases, AreForIntersectionsAndGrids) {
    EXPECT_TRUE(contains(error_of("signal: {phases: [{protected: west_left, green: 8 s}]}\n"),
                         "field 'signal.phases': is not for a straight road"));
}

TEST(SignalPhases, ProgrammesHaveRisingTimesOfDay) {
    const std::string programme = "[{protected: [west_left, east_left], green: 8 s}]";
    EXPECT_TRUE(contains(error_of_signal("  programmes:\n  - {from: 6.5 h, phases: " + programme +
                                         "}\n  - {from: 6 h, phases: " + programme + "}\n"),
                         "field 'signal.programmes[1].from': 6 h is not after the start of the programme before it"));
    EXPECT_TRUE(
        contains(error_of_signal("  programmes:\n  - {from: 6.5 h, phases: " + programme + "}\n"),
                 "field 'signal.programmes[0].phases': each movement needs green in some phase; without green: "));
    EXPECT_TRUE(
        contains(error_of_signal(four_phases() + "  programmes:\n  - {from: 6.5 h, phases: " + programme + "}\n"),
                 "cannot be combined with signal.phases"));
    EXPECT_TRUE(contains(error_of_signal(four_phases() + "  clock: 6 h\n"),
                         "field 'signal.clock': has no effect without signal.programmes"));
}

TEST(ActuatedSignals, AreChecked) {
    const std::string actuated = "  controller: actuated\n";
    EXPECT_EQ(error_of_signal(actuated + four_phases()), "");
    EXPECT_EQ(error_of_signal(actuated + four_phases() + "  - {green: 10 s, recall: minimum}\n"), "");
    EXPECT_EQ(
        error_of_signal(actuated + four_phases().replace(four_phases().find("green: 8 s"), 10,
                                                         "green: 8 s, min_green: 6 s, max_green: 20 s, gap: 2 s")),
        "");
    EXPECT_TRUE(contains(error_of_signal(actuated),
                         "test.yaml:7:15: field 'signal.controller': 'actuated' needs signal.phases or "
                         "signal.programmes"));
    EXPECT_TRUE(contains(error_of_signal(actuated + four_phases() + "  - {green: 10 s}\n"),
                         "field 'signal.phases[4].recall': a phase without movements has no detectors"));
    EXPECT_TRUE(
        contains(error_of_signal(actuated + four_phases() + "  - {green: 10 s, recall: minimum, min_green: 12 s}\n"),
                 "field 'signal.phases[4].min_green': 12 s is longer than the maximum green, 10 s"));
    EXPECT_TRUE(
        contains(error_of_signal(actuated + four_phases() + "  - {green: 10 s, recall: minimum, max_green: 2 s}\n"),
                 "field 'signal.phases[4].max_green': 2 s is shorter than the minimum green, 5 s (min_green)"));
    EXPECT_TRUE(contains(error_of_signal(four_phases() + "  advance_detector: 50 m\n"),
                         "field 'signal.advance_detector' applies only if controller is "));
}

// --- Rings ----------------------------------------------------------------------------------------------------------

std::string ring_phase(int ring, int barrier, const std::string& movements, const std::string& more = "") {
    return "  - {ring: " + std::to_string(ring) + ", barrier: " + std::to_string(barrier) + ", protected: [" +
           movements + "], green: 20 s" + more + "}\n";
}

// Lines 7 and 8 of the file, then a line for each phase.
std::string ring_phases(const std::string& coordinated = "") {
    return "  controller: dual_ring\n  phases:\n" + ring_phase(1, 1, "west_left") +
           ring_phase(1, 1, "east_straight, east_right", coordinated) + ring_phase(2, 1, "east_left") +
           ring_phase(2, 1, "west_straight, west_right", coordinated) + ring_phase(1, 2, "south_left") +
           ring_phase(1, 2, "north_straight, north_right") + ring_phase(2, 2, "north_left") +
           ring_phase(2, 2, "south_straight, south_right");
}

TEST(DualRingSignals, AreAccepted) {
    EXPECT_EQ(error_of_signal(ring_phases()), "");
    EXPECT_EQ(error_of_signal("  cycle: 112 s\n" + ring_phases(", coordinated: on")), "");
}

TEST(DualRingSignals, ProtectedGreensOfBothRingsMustNotConflict) {
    std::string phases = ring_phases();
    // Phase 7 gets a movement that conflicts with phase 6, which can run together with it.
    phases.replace(phases.find("north_left"), 10, "north_left, west_right");
    EXPECT_TRUE(contains(error_of_signal(phases),
                         "test.yaml:15:51: field 'signal.phases[6].protected[1]': the protected movements "
                         "north_straight and west_right of phases 6 and 7 conflict"));
    // The same movements in one phase are reported once.
    phases = ring_phases();
    phases.replace(phases.find("west_left"), 9, "west_left, east_straight");
    EXPECT_EQ(lines_of(error_of_signal(phases)), 1U) << error_of_signal(phases);
    EXPECT_TRUE(contains(error_of_signal(phases), "west_left and east_straight of phase 1 conflict"));
}

TEST(DualRingSignals, CoordinationIsChecked) {
    EXPECT_TRUE(contains(error_of_signal("  cycle: 112 s\n" + ring_phases()),
                         "test.yaml:7:10: field 'signal.cycle': coordination needs a phase with 'coordinated: on' in "
                         "ring 1"));
    EXPECT_TRUE(contains(error_of_signal("  cycle: 100 s\n" + ring_phases(", coordinated: on")),
                         "field 'signal.cycle': 100 s is not the sum of the phases of a ring, 112 s"));
    EXPECT_TRUE(contains(error_of_signal(ring_phases(", coordinated: on")),
                         "test.yaml:10:93: field 'signal.phases[1].coordinated': has no effect without signal.cycle"));
    EXPECT_TRUE(contains(error_of_signal("  cycle: 112.005 s\n" + ring_phases(", coordinated: on")),
                         "field 'signal.cycle': 112.005 s is not a whole number of steps"));
}

TEST(DualRingSignals, OtherControllersHaveNoRings) {
    std::string phases = ring_phases();
    phases.replace(phases.find("dual_ring"), 9, "actuated");
    EXPECT_TRUE(
        contains(error_of_signal(phases), "field 'signal.phases[0].ring': has no effect with the controller actuated"));
    EXPECT_TRUE(
        contains(error_of_signal(ring_phases() + ring_phase(3, 1, "west_left")), "field 'signal.phases[8].ring'"));
    EXPECT_TRUE(contains(error_of_signal("  controller: dual_ring\n"), "'dual_ring' needs signal.phases"));
    EXPECT_TRUE(contains(error_of_signal("  controller: dual_ring\n  programmes:\n  - {from: 0 h, phases: "
                                         "[{protected: west_left, green: 8 s}]}\n"),
                         "field 'signal.programmes': 'dual_ring' has a single programme: use signal.phases"));
}

}  // namespace
}  // namespace stopline
