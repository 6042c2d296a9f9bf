// Tests of the controller `actuated` without vehicles: the tests set the detectors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "signals/actuated_junction.h"
#include "signals/announced_greens.h"

namespace stopline {
namespace {

// Watches the lights of a junction and checks the rules that hold for every history of detectors.
class SafetyCheck {
public:
    explicit SafetyCheck(const Junction& junction) : junction_(junction), groups_(junction.state().lights.size()) {
        const std::vector<SignalPhase>& phases = junction.phases().phases;
        for (std::size_t a = 0; a < groups_; ++a) {
            for (std::size_t b = 0; b < groups_; ++b) {
                const bool are_together = std::any_of(phases.begin(), phases.end(), [&](const SignalPhase& phase) {
                    return phase.has_green(static_cast<int>(a)) && phase.has_green(static_cast<int>(b));
                });
                conflicts_.push_back(!are_together);
            }
        }
        before_ = junction.state().lights;
        since_.assign(groups_, 0);
        yellow_phase_.assign(groups_, -1);
        red_since_.assign(groups_, std::numeric_limits<std::int64_t>::min() / 2);
        red_phase_.assign(groups_, -1);
    }

    void observe() {
        const std::vector<Light>& lights = junction_.state().lights;
        const std::int64_t tick = junction_.tick();
        for (std::size_t a = 0; a < groups_; ++a) {
            for (std::size_t b = 0; b < groups_; ++b) {
                if (a == b || !conflicts_[a * groups_ + b] || lights[a] != Light::green) continue;
                ASSERT_EQ(lights[b], Light::red) << "groups " << a << " and " << b << " at tick " << tick;
            }
        }
        for (std::size_t group = 0; group < groups_; ++group) {
            if (lights[group] == before_[group]) continue;
            check_change(group, before_[group], lights[group], tick);
            since_[group] = tick;
        }
        if (junction_.phase() != phase_) {
            if (phase_ >= 0) ++phase_changes;
            phase_ = junction_.phase();
            start_tick_ = tick;
            check_all_reds(tick);
        }
        before_ = lights;
    }

    int phase_changes = 0;
    int minimum_greens = 0;  // greens that lasted for exactly their minimum
    int maximum_greens = 0;

private:
    const SignalPhase& phase(int number) const { return junction_.phases().phases[static_cast<std::size_t>(number)]; }

    void check_change(std::size_t group, Light from, Light to, std::int64_t tick) {
        const std::int64_t shown = tick - since_[group];
        if (from == Light::green) {
            ASSERT_EQ(to, Light::yellow);
            ASSERT_GE(shown, phase(phase_).min_green_ticks);
            const std::int64_t phase_green = tick - start_tick_;
            ASSERT_GE(phase_green, phase(phase_).min_green_ticks);
            if (all_others_recall()) {
                ASSERT_LE(phase_green, phase(phase_).max_green_ticks);
            }
            minimum_greens += phase_green == phase(phase_).min_green_ticks ? 1 : 0;
            maximum_greens += phase_green == phase(phase_).max_green_ticks ? 1 : 0;
            yellow_phase_[group] = phase_;
        } else if (from == Light::yellow) {
            ASSERT_EQ(to, Light::red);
            ASSERT_EQ(shown, phase(yellow_phase_[group]).yellow_ticks);
            red_since_[group] = tick;
            red_phase_[group] = yellow_phase_[group];
        } else {
            ASSERT_EQ(to, Light::green);
        }
    }

    // Checks that groups that lost green have been red for the all-red time when a phase begins.
    void check_all_reds(std::int64_t tick) const {
        for (std::size_t group = 0; group < groups_; ++group) {
            if (red_phase_[group] < 0) continue;
            ASSERT_GE(tick - red_since_[group], phase(red_phase_[group]).all_red_ticks);
        }
    }

    bool all_others_recall() const {
        const std::vector<SignalPhase>& phases = junction_.phases().phases;
        return std::all_of(phases.begin(), phases.end(), [](const SignalPhase& p) { return p.recall != Recall::off; });
    }

    const Junction& junction_;
    std::size_t groups_;
    std::vector<bool> conflicts_;  // [group * groups_ + other group]
    std::vector<Light> before_;
    std::vector<std::int64_t> since_;
    std::vector<int> yellow_phase_;  // [group] phase after which the group had yellow
    std::vector<std::int64_t> red_since_;
    std::vector<int> red_phase_;
    int phase_ = -1;
    std::int64_t start_tick_ = 0;
};

double whole_ticks_s(Random& random, double min_s, double max_s) {
    return std::round(uniform(random, min_s, max_s) / kStep_s) * kStep_s;
}

// Phases of a street with left turns: leading, lagging, or leading on one side only. Pedestrians may follow.
SignalSettings random_phases(Random& random) {
    SignalSettings settings;
    settings.first_green_s = whole_ticks_s(random, 0.0, 5.0);
    const bool all_recall = random() % 3 == 0;
    const auto add = [&](std::vector<std::string> movements) {
        PhaseSettings phase = phase_of(std::move(movements), whole_ticks_s(random, 0.5, 10.0), 0.0);
        phase.green_s = phase.min_green_s + whole_ticks_s(random, 0.0, 30.0);
        phase.yellow_s = whole_ticks_s(random, 0.5, 5.0);
        phase.all_red_s = whole_ticks_s(random, 0.0, 4.0);
        phase.gap_s = whole_ticks_s(random, 0.2, 5.0);
        const std::uint64_t kind = random() % 6;
        phase.recall = kind == 0 ? "maximum" : kind == 1 || all_recall ? "minimum" : "off";
        settings.phases.push_back(phase);
    };
    for (const bool is_west : {true, false}) {
        const std::string side = is_west ? "west" : "south";
        const std::string other = is_west ? "east" : "north";
        switch (random() % 3) {
            case 0:
                add({side + "_left", other + "_left"});
                add({side + "_straight", other + "_straight"});
                break;
            case 1:
                add({side + "_left", side + "_straight"});
                add({side + "_straight", other + "_straight"});
                add({other + "_left", other + "_straight"});
                break;
            default:
                add({side + "_left", side + "_straight"});
                add({other + "_left", other + "_straight"});
        }
    }
    if (random() % 2 == 0) {
        add({});
        settings.phases.back().recall = "minimum";
    }
    return settings;
}

// In random histories of detectors no two conflicting groups have green, and all times and announcements are kept.
TEST(Actuated, KeepsItsTimesInRandomHistories) {
    constexpr int kSignals = 100;
    constexpr int kTicks = 10'000;  // for each signal, so 10^6 in total
    Random random(1);
    int phase_changes = 0;
    int minimum_greens = 0;
    int maximum_greens = 0;
    int announced_ahead = 0;
    for (int signal = 0; signal < kSignals; ++signal) {
        Junction junction(random_phases(random), kMovements);
        SafetyCheck check(junction);
        AnnouncedGreens announced;
        const double change = std::pow(10.0, uniform(random, -3.0, -0.5));  // probability that a detector changes
        for (int k = 0; k < kTicks; ++k) {
            for (std::size_t lane = 0; lane < junction.lanes(); ++lane) {
                for (SignalDetector* detector : {&junction.stop_detector(lane), &junction.advance_detector(lane)}) {
                    const bool changes = uniform(random, 0.0, 1.0) < change;
                    if (changes && !detector->is_occupied) junction.cross(*detector);
                    junction.occupy(*detector, detector->is_occupied != changes);
                }
            }
            junction.step();
            check.observe();
            announced.observe(junction);
            if (HasFatalFailure()) return;
        }
        phase_changes += check.phase_changes;
        minimum_greens += check.minimum_greens;
        maximum_greens += check.maximum_greens;
        announced_ahead += announced.announced_ahead;
    }
    EXPECT_GT(phase_changes, 3000);
    EXPECT_GT(minimum_greens, 100);
    EXPECT_GT(maximum_greens, 100);
    EXPECT_GT(announced_ahead, 10'000);
}

SignalSettings two_streets(const std::string& recall = "off") {
    SignalSettings settings;
    settings.first_green_s = 1.0;
    settings.phases = {phase_of({"west_straight"}, 5.0, 30.0, recall), phase_of({"west_left"}, 4.0, 20.0),
                       phase_of({"south_straight"}, 6.0, 25.0, recall)};
    return settings;
}

// Returns the phases that begin within a time, with the tick at which each begins.
std::vector<std::pair<int, std::int64_t>> phases_within(Junction& junction, double time_s) {
    std::vector<std::pair<int, std::int64_t>> phases;
    const std::int64_t end = junction.tick() + to_ticks(time_s, kStep_s);
    int present = junction.phase();
    while (junction.tick() < end) {
        junction.step();
        if (junction.phase() != present) phases.emplace_back(junction.phase(), junction.tick());
        present = junction.phase();
    }
    return phases;
}

TEST(Actuated, RestsInGreenWithoutCallsAndSkipsPhasesWithoutCalls) {
    Junction junction(two_streets(), kMovements);
    phases_within(junction, 100.0);
    EXPECT_EQ(junction.phase(), 0);
    EXPECT_EQ(junction.state().lights[0], Light::green);
    junction.occupy(junction.stop_detector(4), true);  // from the south
    const auto phases = phases_within(junction, 50.0);
    ASSERT_EQ(phases.size(), 1U);
    EXPECT_EQ(phases[0].first, 2) << "the left turn from the west has no call";
    EXPECT_EQ(phases[0].second, 1000 + 1 + 50) << "the gap has passed, so yellow begins at once";
}

TEST(Actuated, RecallServesAPhaseInEachCycle) {
    Junction junction(two_streets("minimum"), kMovements);
    const auto phases = phases_within(junction, 1.0 + 3 * 21.0);
    // Without vehicles each green lasts for its minimum: 5 s + 5 s and 6 s + 5 s.
    const std::vector<std::pair<int, std::int64_t>> expected{{0, 10},  {2, 110}, {0, 220}, {2, 320},
                                                             {0, 430}, {2, 530}, {0, 640}};
    EXPECT_EQ(phases, expected);
}

TEST(Actuated, AVehicleExtendsGreenUpToTheMaximum) {
    Junction junction(two_streets("minimum"), kMovements);
    phases_within(junction, 1.0);
    ASSERT_EQ(junction.phase(), 0);
    for (int k = 0; k < 20; ++k) {  // every 2.9 s, below the gap of 3 s
        junction.cross(junction.advance_detector(0));
        phases_within(junction, 2.9);
        if (junction.state().lights[0] != Light::green) break;
    }
    EXPECT_EQ(junction.state().since_tick[0], 10 + 300) << "yellow begins after the maximum of 30 s";
    Junction other(two_streets("minimum"), kMovements);
    phases_within(other, 1.0);
    for (int k = 0; k < 4; ++k) {
        other.cross(other.advance_detector(0));
        phases_within(other, 2.9);
    }
    phases_within(other, 10.0);
    EXPECT_EQ(other.state().lights[0], Light::red);
    EXPECT_EQ(other.state().green_start_tick[4], 11 + 3 * 29 + 30 + 50) << "the gap, yellow and red after the last one";
}

// Announces a platoon on the first lane until its rear has passed. Vehicles cover the upstream detector all the time.
// Returns the tick at which the green of this lane ends.
std::int64_t green_end_with_platoon(std::int64_t rear_tick, bool can_wait) {
    Junction junction(two_streets("minimum"), kMovements);
    phases_within(junction, 1.0);
    while (junction.light(0) == Light::green && junction.tick() < 1'000) {
        const bool has_passed = junction.tick() >= rear_tick;
        for (SignalDetector* detector : {&junction.stop_detector(0), &junction.advance_detector(0)}) {
            detector->platoon_rear_tick = has_passed ? -1 : rear_tick;
            detector->platoon_can_wait = can_wait;
        }
        junction.occupy(junction.advance_detector(0), !has_passed);
        junction.step();
    }
    return junction.tick();
}

TEST(Actuated, GreenLastsUntilTheRearOfAnAnnouncedPlatoonHasPassed) {
    // Green begins at tick 10, and the maximum is 30 s. The gap of 3 s follows the last vehicle at the detector.
    EXPECT_EQ(green_end_with_platoon(200, true), 200 + 30);
    EXPECT_EQ(green_end_with_platoon(310, true), 310);
    EXPECT_EQ(green_end_with_platoon(310, false), 310);
}

TEST(Actuated, APlatoonThatDoesNotFitWaitsIfItCan) {
    EXPECT_EQ(green_end_with_platoon(311, true), 10 + 50) << "the minimum of 5 s";
    EXPECT_EQ(green_end_with_platoon(311, false), 310) << "the maximum of 30 s";
}

// A vehicle that passes the upstream detector at red calls its phase. One that passes it at green does not.
TEST(Actuated, TheAdvanceDetectorRemembersVehiclesThatPassAtRed) {
    Junction junction(two_streets(), kMovements);
    phases_within(junction, 10.0);
    junction.cross(junction.advance_detector(1));
    const auto phases = phases_within(junction, 30.0);
    ASSERT_FALSE(phases.empty());
    EXPECT_EQ(phases[0].first, 1);
    EXPECT_EQ(junction.phase(), 1) << "no other phase has a call";
    junction.cross(junction.advance_detector(1));
    junction.occupy(junction.stop_detector(0), true);
    phases_within(junction, 15.0);
    junction.occupy(junction.stop_detector(0), false);
    phases_within(junction, 60.0);
    EXPECT_EQ(junction.phase(), 0) << "the left turn had green when its second vehicle passed";
}

// A lane with two movements calls the phase that serves both.
TEST(Actuated, ASharedLaneCallsThePhaseThatServesAllItsMovements) {
    SignalSettings settings = two_streets();
    settings.phases[0].protected_movements = {"south_straight"};
    settings.phases[1].protected_movements = {"west_left"};
    settings.phases[2].protected_movements = {"west_straight"};
    settings.phases[2].permissive_movements = {"west_left"};
    Junction junction(settings, kMovements, {0b11, 0b10000});
    phases_within(junction, 10.0);
    junction.occupy(junction.stop_detector(0), true);
    const auto phases = phases_within(junction, 20.0);
    ASSERT_FALSE(phases.empty());
    EXPECT_EQ(phases[0].first, 2);
}

TEST(Actuated, APedestrianPhaseLastsForItsGreen) {
    SignalSettings settings = two_streets("minimum");
    PhaseSettings pedestrians = phase_of({}, 1.0, 12.0, "minimum");
    pedestrians.yellow_s = 0.0;
    settings.phases.push_back(pedestrians);
    Junction junction(settings, kMovements);
    const auto phases = phases_within(junction, 60.0);
    ASSERT_GE(phases.size(), 4U);
    EXPECT_EQ(phases[2].first, 3);
    EXPECT_EQ(phases[3].second - phases[2].second, 120 + 20);
}

TEST(Actuated, AnotherProgrammeBeginsWithANewCycle) {
    SignalSettings settings;
    settings.first_green_s = 0.0;
    settings.clock_s = 3600.0;
    const PhaseSettings west = phase_of({"west_straight"}, 5.0, 30.0, "minimum");
    const PhaseSettings south = phase_of({"south_straight"}, 6.0, 30.0, "minimum");
    const PhaseSettings long_south = phase_of({"south_straight"}, 20.0, 30.0, "minimum");
    settings.programmes = {{0.0, {west, south}}, {3600.0 + 12.0, {long_south, west}}};
    Junction junction(settings, kMovements);
    const auto phases = phases_within(junction, 60.0);
    // The first cycle ends at 21 s. The second programme is in force since 12 s.
    ASSERT_GE(phases.size(), 3U);
    EXPECT_EQ(phases[0], (std::pair<int, std::int64_t>{1, 100}));
    EXPECT_EQ(phases[1], (std::pair<int, std::int64_t>{2, 210}));
    EXPECT_EQ(phases[2], (std::pair<int, std::int64_t>{3, 460}));
}

}  // namespace
}  // namespace stopline
