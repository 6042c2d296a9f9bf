// Properties of the controller `dual_ring` in random rings with random histories of its detectors.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "signals/announced_greens.h"
#include "signals/ring_junction.h"
#include "signals/rings/ring_problems.h"

namespace stopline {
namespace {

// --- Random rings ---------------------------------------------------------------------------------------------------

double whole_s(Random& random, double min_s, double max_s) {
    return std::round(uniform(random, min_s, max_s) / kStep_s) * kStep_s;
}
bool chance(Random& random, double probability) { return uniform(random, 0.0, 1.0) < probability; }

// Sets equal times of both rings between barriers, and the cycle, by longer greens.
void coordinate(Random& random, SignalSettings& settings) {
    const int barrier = chance(random, 0.5) ? 1 : 2;
    settings.cycle_s = 0.0;
    for (const int side : {1, 2}) {
        std::array<double, 3> ring_s{};
        std::array<PhaseSettings*, 3> last{};
        for (PhaseSettings& phase : settings.phases) {
            const auto ring = static_cast<std::size_t>(phase.ring);
            if (phase.barrier != side) continue;
            // The last phases before a barrier end together, so the longest clearance limits all greens.
            phase.yellow_s = 3.0;
            phase.all_red_s = std::min(phase.all_red_s, 2.0);
            phase.green_s = std::max(phase.green_s, phase.min_green_s + 2.0);
            ring_s[ring] += phase.total_s();
            last[ring] = &phase;
        }
        const double side_s = std::max(ring_s[1], ring_s[2]);
        for (const std::size_t ring : {1U, 2U}) {
            if (last[ring] != nullptr) last[ring]->green_s += side_s - ring_s[ring];
        }
        settings.cycle_s += side_s;
    }
    for (const int ring : {1, 2}) {
        std::vector<PhaseSettings*> candidates;
        for (PhaseSettings& phase : settings.phases) {
            const bool is_straight = phase.protected_movements.front().ends_with("_straight");
            if (phase.ring == ring && phase.barrier == barrier && is_straight) candidates.push_back(&phase);
        }
        candidates[random() % candidates.size()]->coordinated = "on";
    }
}

// Rings with leading, lagging or missing left-turn phases. Left turns without a phase, and some others, are permissive
// together with the straight movement of their side.
SignalSettings random_rings(Random& random) {
    SignalSettings settings;
    settings.controller = "dual_ring";
    settings.first_green_s = whole_s(random, 0.0, 3.0);
    const bool is_coordinated = chance(random, 0.5);
    for (const int ring : {1, 2}) {
        for (const int barrier : {1, 2}) {
            const std::string side = barrier == 1 ? "west" : "south";
            const std::string opposite = barrier == 1 ? "east" : "north";
            const std::string left = ring == 1 ? side : opposite;
            const std::string straight = ring == 1 ? opposite : side;
            const auto add = [&](const std::string& movement_name) {
                PhaseSettings phase = ring_phase(ring, barrier, {movement_name}, whole_s(random, 0.5, 6.0), 0.0);
                phase.green_s = phase.min_green_s + whole_s(random, 0.0, 12.0);
                phase.yellow_s = whole_s(random, 0.5, 4.0);
                phase.all_red_s = whole_s(random, 0.0, 3.0);
                phase.gap_s = whole_s(random, 0.2, 4.0);
                const std::uint64_t kind = random() % 6;
                phase.recall = kind == 0 ? "maximum" : kind == 1 ? "minimum" : "off";
                phase.dual_entry = chance(random, 0.3) ? "on" : "off";
                settings.phases.push_back(phase);
            };
            const std::uint64_t kind = random() % 3;
            if (kind == 0) add(left + "_left");
            add(straight + "_straight");
            if (kind == 1) add(left + "_left");
        }
    }
    for (PhaseSettings& phase : settings.phases) {
        const std::string name = phase.protected_movements.front();
        const std::size_t turn = name.find("_straight");
        if (turn == std::string::npos) continue;
        const std::string left = name.substr(0, turn) + "_left";
        const bool has_phase = std::any_of(settings.phases.begin(), settings.phases.end(),
                                           [&](const PhaseSettings& one) { return has_protected_green(one, left); });
        if (!has_phase || chance(random, 0.5)) phase.permissive_movements.push_back(left);
    }
    if (is_coordinated) coordinate(random, settings);
    return settings;
}

// --- Rules ----------------------------------------------------------------------------------------------------------

bool is_left(std::size_t group) { return kMovements[group].find("_left") != std::string::npos; }
bool is_west_east(std::size_t group) { return group < 4; }

// Returns true if the paths of two movements cross.
bool cross_paths(std::size_t a, std::size_t b) {
    if (is_west_east(a) != is_west_east(b)) return true;
    return is_left(a) != is_left(b) && kMovements[a][0] != kMovements[b][0];
}

struct Counts {
    int phases = 0;
    int pairs_of_lefts = 0;     // starts of a phase after which both rings have a left turn
    int permissive_greens = 0;  // ticks with green for a left turn and for traffic with priority
    int coordinated_cycles = 0;
    int early_coordinated = 0;  // coordinated greens that begin before their point
    int served_calls = 0;
};

class RingCheck {
public:
    RingCheck(const Junction& junction, const SignalSettings& settings)
        : junction_(junction),
          settings_(settings),
          before_(junction.state().lights),
          since_(8, kLongAgo),
          red_since_(8, kLongAgo),
          red_ticks_(8, 0),
          waiting_since_(8, -1),
          last_(pair_of(junction)) {
        for (const PhaseSettings& phase : settings.phases) {
            longest_ticks_ += to_ticks(phase.total_s(), kStep_s);
        }
        if (settings.cycle_s > 0.0) longest_ticks_ = to_ticks(settings.cycle_s, kStep_s);
    }

    void observe(Counts& counts) {
        const RingPair pair = pair_of(junction_);
        check_conflicts(pair, counts);
        for (std::size_t group = 0; group < 8; ++group) {
            if (junction_.light(group) != before_[group]) check_change(group, pair);
        }
        check_phases(pair, counts);
        check_coordination(pair, counts);
        check_waits(counts);
        before_ = junction_.state().lights;
    }

private:
    static constexpr std::int64_t kLongAgo = std::numeric_limits<std::int64_t>::min() / 2;
    const SignalPhase& phase(int number) const { return junction_.phases().phases[static_cast<std::size_t>(number)]; }
    bool has_protected(int number, std::size_t group) const {
        return number >= 0 &&
               has_protected_green(settings_.phases[static_cast<std::size_t>(number)], kMovements[group]);
    }
    // Returns true if the pair protects neither of two crossing movements from the other one.
    bool may_be_together(const RingPair& pair, std::size_t a, std::size_t b) const {
        if (is_west_east(a) != is_west_east(b)) return false;
        const std::size_t left = is_left(a) ? a : b;
        return !has_protected(pair.phase[0], left) && !has_protected(pair.phase[1], left);
    }

    void check_conflicts(const RingPair& pair, Counts& counts) {
        for (std::size_t a = 0; a < 8; ++a) {
            if (junction_.light(a) != Light::green) continue;
            for (std::size_t b = 0; b < 8; ++b) {
                if (a == b || !cross_paths(a, b) || junction_.light(b) == Light::red) continue;
                ASSERT_TRUE(may_be_together(pair, a, b))
                    << kMovements[a] << " and " << kMovements[b] << " at tick " << junction_.tick();
                ++counts.permissive_greens;
            }
        }
    }

    void check_change(std::size_t group, const RingPair& pair) {
        const std::int64_t tick = junction_.tick();
        const Light now = junction_.light(group);
        if (before_[group] == Light::green) {
            ASSERT_EQ(now, Light::yellow) << kMovements[group];
            ASSERT_TRUE(any_phase(
                group,
                [&](int number, std::size_t ring) { return tick - start_[ring] >= phase(number).min_green_ticks; }))
                << "minimum of " << kMovements[group] << " at tick " << tick;
        } else if (before_[group] == Light::yellow) {
            // If the yellow fits two phases, the shorter red applies: the check does not know which of them has ended.
            red_ticks_[group] = std::numeric_limits<std::int64_t>::max();
            any_phase(group, [&](int number, std::size_t /*ring*/) {
                if (tick - since_[group] == phase(number).yellow_ticks)
                    red_ticks_[group] = std::min(red_ticks_[group], phase(number).all_red_ticks);
                return false;
            });
            ASSERT_LT(red_ticks_[group], std::numeric_limits<std::int64_t>::max())
                << "yellow of " << kMovements[group] << " at tick " << tick;
            red_since_[group] = tick;
            // Without a red time the group can have green at once, in a phase of the other ring.
            ASSERT_TRUE(now == Light::red || red_ticks_[group] == 0) << kMovements[group];
        } else {
            ASSERT_EQ(now, Light::green) << kMovements[group];
            for (std::size_t other = 0; other < 8; ++other) {
                if (!cross_paths(group, other) || may_be_together(pair, group, other)) continue;
                ASSERT_GE(tick - red_since_[other], red_ticks_[other])
                    << kMovements[group] << " after " << kMovements[other] << " at tick " << tick;
            }
        }
        since_[group] = tick;
    }

    // Returns true if `test` holds for a phase with this group that was present at the tick before.
    template <class Test>
    bool any_phase(std::size_t group, const Test& test) const {
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            const int number = last_.phase[ring];
            if (number >= 0 && phase(number).has_green(static_cast<int>(group)) && test(number, ring)) return true;
        }
        return false;
    }

    void check_phases(const RingPair& pair, Counts& counts) {
        const std::int64_t tick = junction_.tick();
        int barrier = 0;
        for (const int number : pair.phase) {
            if (number < 0) continue;
            const int own = settings_.phases[static_cast<std::size_t>(number)].barrier;
            ASSERT_TRUE(barrier == 0 || barrier == own) << "the rings are on different sides at tick " << tick;
            barrier = own;
        }
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            if (pair.phase[ring] == last_.phase[ring]) continue;
            if (last_.phase[ring] >= 0) {
                const SignalPhase& ended = phase(last_.phase[ring]);
                ASSERT_GE(tick - start_[ring], ended.min_green_ticks + ended.yellow_ticks + ended.all_red_ticks);
            }
            start_[ring] = tick;
            ++counts.phases;
        }
        if (pair.phase[0] >= 0 && pair.phase[1] >= 0 && pair != last_ && is_left_phase(pair.phase[0]) &&
            is_left_phase(pair.phase[1]))
            ++counts.pairs_of_lefts;
        last_ = pair;
    }

    bool is_left_phase(int number) const {
        return settings_.phases[static_cast<std::size_t>(number)].protected_movements.front().ends_with("_left");
    }

    // At the latest start of its green, a coordinated phase is green. It stays so up to its yield point.
    void check_coordination(const RingPair& pair, Counts& counts) {
        const RingPlan& rings = junction_.phases().rings;
        const std::int64_t tick = junction_.tick();
        if (!rings.is_coordinated() || tick < rings.cycle_start_tick) return;
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            const int number = rings.coordinated[ring];
            const RingPhase& own = rings.phases[static_cast<std::size_t>(number)];
            const std::int64_t to_yield = rings.ticks_to(own.force_off, tick);
            if (to_yield == 0 || to_yield > own.force_off - own.start_point) continue;
            ASSERT_EQ(pair.phase[ring], number) << "coordinated phase of ring " << ring << " at tick " << tick;
            const std::size_t group =
                movement(settings_.phases[static_cast<std::size_t>(number)].protected_movements[0]);
            ASSERT_EQ(junction_.light(group), Light::green) << "at tick " << tick;
            if (rings.ticks_to(own.start_point, tick) != 0) continue;
            ++counts.coordinated_cycles;
            if (start_[ring] < tick) ++counts.early_coordinated;
        }
    }

    // A vehicle at a red stop line gets green within bounded time.
    void check_waits(Counts& counts) {
        for (std::size_t group = 0; group < 8; ++group) {
            const bool waits =
                junction_.light(group) != Light::green && junction_.detectors()[3 * group + 1].is_occupied;
            if (!waits) {
                counts.served_calls += waiting_since_[group] >= 0 ? 1 : 0;
                waiting_since_[group] = -1;
                continue;
            }
            if (waiting_since_[group] < 0) waiting_since_[group] = junction_.tick();
            ASSERT_LE(junction_.tick() - waiting_since_[group], 2 * longest_ticks_ + to_ticks(4.0, kStep_s))
                << kMovements[group] << " at tick " << junction_.tick();
        }
    }

    const Junction& junction_;
    const SignalSettings& settings_;
    std::vector<Light> before_;
    std::vector<std::int64_t> since_;
    std::vector<std::int64_t> red_since_;
    std::vector<std::int64_t> red_ticks_;
    std::vector<std::int64_t> waiting_since_;
    std::array<std::int64_t, kRings> start_{};
    RingPair last_;
    std::int64_t longest_ticks_ = 0;
};

// Vehicles arrive at random at each lane. They wait at red and leave a while after green has begun.
class RandomTraffic {
public:
    RandomTraffic(Random& random, std::size_t lanes) : random_(random) {
        for (std::size_t lane = 0; lane < lanes; ++lane)
            arrival_.push_back(std::pow(10.0, uniform(random, -3.0, -0.7)));
    }

    void set_detectors(Junction& junction) {
        for (std::size_t lane = 0; lane < junction.lanes(); ++lane) {
            SignalDetector& stop = junction.stop_detector(lane);
            SignalDetector& advance = junction.advance_detector(lane);
            if (chance(random_, arrival_[lane])) junction.cross(advance);
            bool is_occupied = stop.is_occupied || chance(random_, arrival_[lane]);
            if (is_occupied && junction.light(lane) == Light::green) is_occupied = !chance(random_, 0.1);
            junction.occupy(stop, is_occupied);
        }
    }

private:
    Random& random_;
    std::vector<double> arrival_;  // probability in each tick
};

Counts check_histories(std::uint64_t seed, int histories, double history_s) {
    Random random(seed);
    Counts counts;
    for (int history = 0; history < histories; ++history) {
        const SignalSettings settings = random_rings(random);
        const std::vector<SignalProblem> problems = ring_problems(settings, 8);
        EXPECT_TRUE(problems.empty()) << problems.front().field << ": " << problems.front().message;
        Junction junction(settings, kMovements);
        RingCheck check(junction, settings);
        RandomTraffic traffic(random, junction.lanes());
        const std::int64_t end = to_ticks(history_s, kStep_s);
        while (junction.tick() < end) {
            traffic.set_detectors(junction);
            junction.step();
            check.observe(counts);
            if (::testing::Test::HasFatalFailure()) {
                ADD_FAILURE() << "seed " << seed << ", history " << history;
                return counts;
            }
        }
    }
    return counts;
}

void expect_all_situations(const Counts& counts, int histories) {
    EXPECT_GT(counts.phases, 10 * histories);
    EXPECT_GT(counts.pairs_of_lefts, histories / 10);
    EXPECT_GT(counts.permissive_greens, histories);
    EXPECT_GT(counts.coordinated_cycles, histories);
    EXPECT_GT(counts.early_coordinated, histories / 10);
    EXPECT_GT(counts.served_calls, 10 * histories);
}

TEST(DualRing, KeepsItsRulesInRandomHistories) {
    const Counts counts = check_histories(1, 300, 300.0);
    expect_all_situations(counts, 300);
}

TEST(DualRing, KeepsAnnouncedGreensInRandomHistories) {
    Random random(3);
    int announced_ahead = 0;
    int announced_rests = 0;
    for (int history = 0; history < 300; ++history) {
        Junction junction(random_rings(random), kMovements);
        RandomTraffic traffic(random, junction.lanes());
        AnnouncedGreens announced;
        while (junction.tick() < to_ticks(100.0, kStep_s)) {
            traffic.set_detectors(junction);
            junction.step();
            announced.observe(junction);
            ASSERT_FALSE(HasFatalFailure()) << "history " << history;
        }
        announced_ahead += announced.announced_ahead;
        announced_rests += announced.announced_rests;
    }
    EXPECT_GT(announced_ahead, 10'000);
    EXPECT_GT(announced_rests, 10'000);
}

// Returns the number of histories for each seed: the environment variable STOPLINE_HISTORIES, at least 1,000, or 20,000
// if it is not set. With 100000, ten tests check a million histories in half a minute each.
int histories_of_a_seed() {
    const char* number = std::getenv("STOPLINE_HISTORIES");
    return number == nullptr ? 20'000 : std::max(1'000, std::atoi(number));
}

class SlowDualRing : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(SlowDualRing, KeepsItsRulesInManyRandomHistories) {
    const int histories = histories_of_a_seed();
    const Counts counts = check_histories(GetParam(), histories, 40.0);
    expect_all_situations(counts, histories / 10);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SlowDualRing, ::testing::Range<std::uint64_t>(2, 12));

}  // namespace
}  // namespace stopline
