// Who waits for whom, and why: vehicles placed by hand on two intersections, the watch called once; and the rules, in runs.
#include "sim/congestion/delay_causes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "runs/network/network_run.h"
#include "sim/junction/arrivals.h"
#include "sim/junction/occupants.h"
#include "sim/junction/right_of_way.h"
#include "sim/junction/stop_lines.h"
#include "sim/step/occupied_lanes.h"
#include "support/track.h"

namespace stopline {
namespace {

using testing_support::Track;

Scenario arterial(const std::vector<std::string>& overrides = {}) {
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/arterial.yaml", overrides);
}

// Two intersections without vehicles. Every place is given as a lane's name.
class Hindrance : public testing::Test {
protected:
    Hindrance() : track_(empty()) { set_lights(); }

    void set_lights() {
        state().tick = 1000;
        // Streets from west to east have green.
        for (std::size_t group = 0; group < state().stop_lines.lights.size(); ++group) {
            state().stop_lines.lights[group] = group % 2 == 0 ? Light::green : Light::red;
        }
    }

    static Model empty() {
        Model model = network_model(arterial({"network.grid.columns=2"}), 2);
        for (DemandPlan::Inlet& inlet : model.demand.inlets) inlet.vehicles = 0;
        return model;
    }

    State& state() { return track_.editable(); }

    int lane(const std::string& name) {
        const std::vector<Lane>& lanes = track_.model().graph.lanes;
        return static_cast<int>(
            std::find_if(lanes.begin(), lanes.end(), [&](const Lane& l) { return l.name == name; }) - lanes.begin());
    }

    // A vehicle that stands there; returns its number.
    int stand(const std::string& name, double front_m, const std::string& next = {}) {
        return put(name, front_m, 0.0, next);
    }
    // One that moves.
    int put(const std::string& name, double front_m, double speed_mps, const std::string& next = {}) {
        const int on = lane(name);
        track_.place(on, front_m, speed_mps);
        const std::size_t slot = at(state().blocks[at(on)].last());
        state().vehicles.stopped_since[slot] = static_cast<int>(state().tick);
        const Lane& road = track_.model().graph.lanes[at(on)];
        const std::string leads_to =
            next.empty() && road.origin >= 0 ? track_.model().graph.lanes[at(road.next[0])].name : next;
        state().vehicles.next_lane[slot] = leads_to.empty() ? -1 : lane(leads_to);
        const auto& routes = track_.model().graph.routes;
        for (std::size_t k = 0; k < routes.size(); ++k) {
            const auto place = std::find(routes[k].lanes.begin(), routes[k].lanes.end(), on);
            if (place == routes[k].lanes.end()) continue;
            const auto after =
                std::find(routes[k].lanes.begin(), routes[k].lanes.end(), state().vehicles.next_lane[slot]);
            if (!leads_to.empty() && after == routes[k].lanes.end()) continue;
            state().vehicles.record[slot].route = static_cast<int>(k);
            state().vehicles.record[slot].route_index = static_cast<int>(place - routes[k].lanes.begin());
        }
        return state().vehicles.id[slot];
    }

    // Where one lane's conflict area with another begins.
    double area_m(const std::string& one, const std::string& two) {
        for (const Conflict& c : track_.model().graph.conflicts_of(lane(one))) {
            if (c.other == lane(two)) return c.from_m;
        }
        ADD_FAILURE() << one << " and " << two << " do not meet";
        return 0.0;
    }

    void look() {
        const Model& model = track_.model();
        Partition& all = state().partitions[0];
        find_occupied_lanes(state(), state().queues, all);
        find_junction_occupants(state(), state().junctions, all);
        decide_stop_lines(model, state(), all);
        decide_right_of_way(model, state(), all);
        watch_delays(model, state());
    }

    double lost_s(DelayCause cause) { return state().congestion.delays.delay_s[static_cast<std::size_t>(cause)]; }

    Track track_;
};

TEST_F(Hindrance, AQueueAtARedLightWaitsForTheSignal) {
    stand("c0r0_south_in_0", 154.0, "c0r0_south_0_straight");
    stand("c0r0_south_in_0", 146.0, "c0r0_south_0_straight");
    stand("c0r0_south_in_0", 138.0, "c0r0_south_0_straight");
    look();
    EXPECT_EQ(lost_s(DelayCause::signal), 3.0);
    EXPECT_TRUE(state().congestion.delays.episodes.empty());
    EXPECT_TRUE(state().congestion.delays.gridlocks.empty());
}

TEST_F(Hindrance, WhoStandsAcrossTheWayBlocksTheJunction) {
    const double m = area_m("c0r0_south_0_straight", "c0r0_west_0_straight");
    const int blocker = stand("c0r0_south_0_straight", m + 1.0);
    const int first = stand("c0r0_west_in_0", 154.0, "c0r0_west_0_straight");
    stand("c0r0_west_in_0", 146.0, "c0r0_west_0_straight");
    look();
    ASSERT_EQ(state().congestion.delays.episodes.size(), 1u);
    const DelayEpisode& e = state().congestion.delays.episodes[0];
    EXPECT_EQ(e.cause, DelayCause::junction_blocking);
    EXPECT_EQ(e.vehicle, first);
    EXPECT_EQ(e.blocker, blocker);
    EXPECT_EQ(e.blocker_lane, lane("c0r0_south_0_straight"));
    EXPECT_EQ(e.max_vehicles, 2);
    EXPECT_EQ(lost_s(DelayCause::junction_blocking), 2.0);
}

TEST_F(Hindrance, AFullExitIsSpillbackOrTurnBlocking) {
    stand("c1r0_west_in_0", 4.0, "c1r0_west_0_straight");  // its rear is still inside
    const int straight = stand("c0r0_west_in_0", 154.0, "c0r0_west_0_straight");
    stand("c1r0_west_in_1", 4.0, "c1r0_west_1_straight");
    for (std::size_t group = 0; group < state().stop_lines.lights.size(); ++group) state().stop_lines.lights[group] = Light::green;
    const int turning = stand("c0r0_south_in_1", 154.0, "c0r0_south_1_right");
    look();
    ASSERT_EQ(state().congestion.delays.episodes.size(), 2u);
    for (const DelayEpisode& e : state().congestion.delays.episodes) {
        EXPECT_EQ(e.cause, e.vehicle == straight ? DelayCause::spillback : DelayCause::turn_blocking);
        EXPECT_TRUE(e.vehicle == straight || e.vehicle == turning);
    }
}

// It waits for its light, but for the one in the exit too, until that has moved.
TEST_F(Hindrance, AtARedLightWhoWasKeptOutGoesOnWaitingForTheSameVehicle) {
    stand("c1r0_west_in_0", 4.0, "c1r0_west_0_straight");
    stand("c0r0_west_in_0", 154.0, "c0r0_west_0_straight");
    const int first = state().blocks[at(lane("c0r0_west_in_0"))].first;
    const int in_exit = state().blocks[at(lane("c1r0_west_in_0"))].first;
    look();
    EXPECT_EQ(lost_s(DelayCause::spillback), 1.0);
    for (const bool moves : {false, true}) {
        state().tick += track_.model().rules.watch_ticks;
        for (Light& light : state().stop_lines.lights) light = Light::red;
        if (moves) state().vehicles.speed_mps[at(in_exit)] = 1.0;
        look();
        state().vehicles.speed_mps[at(in_exit)] = 0.0;
        EXPECT_EQ(state().congestion.watch.waits_for[at(first)], moves ? -1 : in_exit);
    }
    state().tick += track_.model().rules.watch_ticks;
    look();
    EXPECT_EQ(state().congestion.watch.waits_for[at(first)], -1) << "it stands again";
    EXPECT_EQ(lost_s(DelayCause::spillback), 1.0);
}

// The light is not all that it waits for.
TEST_F(Hindrance, AtARedLightWhoStandsCloseBehindOneInTheIntersectionWaitsForThatToo) {
    stand("c0r0_south_0_straight", 3.0);
    stand("c0r0_south_in_0", 152.0, "c0r0_south_0_straight");
    look();
    const int behind = state().blocks[at(lane("c0r0_south_in_0"))].first;
    EXPECT_EQ(state().congestion.watch.direct_cause[at(behind)], DelayCause::signal);
    EXPECT_EQ(state().congestion.watch.waits_for[at(behind)], state().blocks[at(lane("c0r0_south_0_straight"))].first);
    EXPECT_EQ(lost_s(DelayCause::signal), 1.0);
}

// A light that is red for hours is no hindrance, but nobody waits for so long untold.
TEST_F(Hindrance, WhoHasStoodForTwoCyclesIsToldOfWhateverTheCause) {
    const int waits = stand("c0r0_south_in_0", 154.0, "c0r0_south_0_straight");
    state().tick += track_.model().rules.long_wait_ticks - 1;
    look();
    EXPECT_TRUE(state().congestion.delays.episodes.empty());
    state().tick += 1;
    look();
    ASSERT_EQ(state().congestion.delays.episodes.size(), 1u);
    EXPECT_EQ(state().congestion.delays.episodes[0].cause, DelayCause::signal);
    EXPECT_EQ(state().congestion.delays.episodes[0].vehicle, waits);
}

// What is decided at the next intersection in this step may be known already, or not yet: threads share them out.
TEST_F(Hindrance, WhoIsHeldAtTheNextIntersectionDoesNotMatter) {
    stand("c1r0_west_in_0", 5.0, "c1r0_west_0_straight");
    const std::size_t other = at(state().blocks[at(lane("c1r0_west_in_0"))].first);
    const int inside = lane("c0r0_west_0_straight");
    const double front_m = track_.model().graph.lanes[at(inside)].length_m - 2.0;
    stand("c0r0_west_0_straight", front_m);
    const int slot = state().blocks[at(inside)].first;
    look();
    state().vehicles.record[at(slot)].leader_id = state().vehicles.id[other];
    state().vehicles.position_m[at(slot - 1)] = front_m + 7.0;
    state().vehicles.length_m[at(slot - 1)] = state().vehicles.length_m[other];
    state().vehicles.speed_mps[at(slot - 1)] = 0.0;
    const JunctionOccupant insider{slot, front_m, 0.0, 0};
    for (const int held_at : {-2, static_cast<int>(state().tick)}) {
        state().vehicles.record[other].yield_tick = held_at;
        EXPECT_FALSE(is_behind_yielding_vehicle(state(), inside, insider)) << held_at;
    }
}

// A column that closes up to its queue crawls for some seconds in full dynamics. Who comes does not take that for traffic that moves.
TEST_F(Hindrance, WhoCrawlsInTheExitOrAcrossTheWayIsWaitedForAsIfItStood) {
    const double m = area_m("c0r0_south_0_straight", "c0r0_west_0_straight");
    for (const double speed_mps : {0.3, 2.0}) {
        for (const bool in_exit : {false, true}) {
            track_ = Track(empty());
            set_lights();
            const int slow = in_exit ? put("c1r0_west_in_0", 4.0, speed_mps, "c1r0_west_0_straight")
                                     : put("c0r0_south_0_straight", m + 1.0, speed_mps);
            stand("c0r0_west_in_0", 154.0, "c0r0_west_0_straight");
            look();
            const int stopped = state().stop_lines.stop_slot[at(lane("c0r0_west_in_0"))];
            if (speed_mps > 1.0) {
                EXPECT_EQ(stopped, -1) << "makes room";
                continue;
            }
            EXPECT_GE(stopped, 0);
            ASSERT_EQ(state().congestion.delays.episodes.size(), 1u);
            const DelayEpisode& e = state().congestion.delays.episodes[0];
            EXPECT_EQ(e.cause, in_exit ? DelayCause::spillback : DelayCause::junction_blocking);
            EXPECT_EQ(e.blocker, slow);
            EXPECT_EQ(e.blocker_lane, lane(in_exit ? "c1r0_west_in_0" : "c0r0_south_0_straight"));
            EXPECT_EQ(e.max_vehicles, 1) << "it does not stand itself";
        }
    }
}

// One waits for the exit, whose queue waits for who is across the next intersection: stood there, and crawls in the next look.
TEST_F(Hindrance, WhoStoodAcrossTheWayAndCrawlsNowIsNotInACircle) {
    const double m = area_m("c1r0_south_0_straight", "c1r0_west_0_straight");
    const int blocker = stand("c1r0_south_0_straight", m + 1.0);
    for (double front_m = 154.0; front_m > 4.0; front_m -= 8.0) {
        stand("c1r0_west_in_0", front_m, "c1r0_west_0_straight");
    }
    stand("c0r0_west_in_0", 154.0, "c0r0_west_0_straight");
    look();
    state().vehicles.speed_mps[at(state().blocks[at(lane("c1r0_south_0_straight"))].first)] = 0.3;
    state().tick += 10;
    look();
    EXPECT_TRUE(state().congestion.delays.gridlocks.empty());
    ASSERT_EQ(state().congestion.delays.episodes.size(), 2u);
    EXPECT_EQ(state().congestion.delays.episodes[1].blocker, blocker);
}

// A column that fills the exit moves, but up to a light that is not green: there will be no room.
TEST_F(Hindrance, WhoMovesInTheExitCountsAsStandingWhileTheLightAtItsEndIsNotGreen) {
    constexpr double kNeeds_m = 5.15 + 2.95;  // a vehicle and its gap at standstill
    constexpr double kMoves_mps = 10.0;
    const std::string exit = "c1r0_west_in_0";
    const double line_m = track_.model().graph.lanes[at(lane(exit))].stop_line_m;
    const int fit = static_cast<int>(line_m / kNeeds_m);
    const int beyond = track_.model().graph.lanes[at(lane("c1r0_west_0_straight"))].origin;
    ASSERT_EQ(beyond, lane(exit));
    for (const Light light : {Light::green, Light::yellow, Light::red}) {
        for (const int present : {fit - 1, fit}) {
            track_ = Track(empty());
            set_lights();
            state().stop_lines.lights[at(track_.model().graph.lanes[at(lane(exit))].signal_group)] = light;
            int last = -1;
            // Evenly, so that they are not where they will stand.
            for (int k = 0; k < present; ++k) {
                last = put(exit, line_m - 1.0 - kNeeds_m * (k + 0.3), kMoves_mps, "c1r0_west_0_straight");
            }
            const int asks = stand("c0r0_west_in_0", 154.0, "c0r0_west_0_straight");
            look();
            const bool room = light == Light::green || present < fit;
            const int stopped = state().stop_lines.stop_slot[at(lane("c0r0_west_in_0"))];
            EXPECT_EQ(stopped < 0, room) << static_cast<int>(light) << ", " << present << " of " << fit;
            if (room || stopped < 0) continue;
            ASSERT_EQ(state().congestion.delays.episodes.size(), 1u);
            EXPECT_EQ(state().congestion.delays.episodes[0].cause, DelayCause::spillback);
            EXPECT_EQ(state().congestion.delays.episodes[0].vehicle, asks);
            EXPECT_EQ(state().congestion.delays.episodes[0].blocker, last);
        }
    }
}

// Four vehicles from four sides, each across the way of the next.
TEST_F(Hindrance, ACircleIsAGridlockWithItsMembers) {
    const std::vector<std::string> ring{"c0r0_west_0_straight", "c0r0_south_0_straight", "c0r0_east_0_straight",
                                        "c0r0_north_0_straight"};
    std::set<int> members;
    for (std::size_t k = 0; k < ring.size(); ++k) {
        // Just before the area with the one that it waits for; its body is in the area with the one behind.
        double far_m = 0.0;
        for (const std::string& other : ring) {
            if (other == ring[k] || other == ring[(k + 2) % 4]) continue;
            far_m = std::max(far_m, area_m(ring[k], other));
        }
        members.insert(stand(ring[k], far_m - 0.5));
    }
    look();
    ASSERT_EQ(state().congestion.delays.gridlocks.size(), 1u);
    const Gridlock& g = state().congestion.delays.gridlocks[0];
    EXPECT_EQ(std::set<int>(g.vehicles.begin(), g.vehicles.end()), members);
    EXPECT_EQ(lost_s(DelayCause::gridlock), 4.0);
    state().tick += track_.model().rules.watch_ticks;
    look();
    ASSERT_EQ(state().congestion.delays.gridlocks.size(), 1u) << "the same one, a second later";
    EXPECT_EQ(state().congestion.delays.gridlocks[0].to_s - state().congestion.delays.gridlocks[0].from_s, 1.0);
}

struct Run {
    const char* fidelity;
    double until_s;
};
void PrintTo(const Run& run, std::ostream* out) { *out << run.fidelity; }
class SlowRules : public testing::TestWithParam<Run> {};
INSTANTIATE_TEST_SUITE_P(Modes, SlowRules, testing::Values(Run{"meso", 1200.0}, Run{"full", 400.0}),
                         [](const auto& run) { return std::string(run.param.fidelity); });

// Whether its way leads over a lane now: its front or its rear is there, or the front will be next.
bool is_on(const State& state, int vehicle, int lane) {
    for (std::size_t k = 0; k < state.blocks.size(); ++k) {
        for (int slot = state.blocks[k].first; slot < state.blocks[k].past_last(); ++slot) {
            const auto i = static_cast<std::size_t>(slot);
            if (state.vehicles.id[i] != vehicle) continue;
            const VehicleRecord& record = state.vehicles.record[i];
            return static_cast<int>(k) == lane || state.vehicles.next_lane[i] == lane || record.previous_lane == lane ||
                   record.second_previous_lane == lane;
        }
    }
    return false;
}

TEST(PassedBlocker, IsToldOfOnTheWayOfWhoPasses) {
    const Model model =
        network_model(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                                    {"signal.green=20 s", "demand.left=10 %", "demand.right=30 %", "rules.sight=30 m",
                                     "network.grid.columns=3", "network.grid.rows=3"}),
                      2);
    Simulation simulation(model);
    std::size_t seen = 0;
    int passed = 0;
    for (double time_s = 0.0; time_s < 900.0; time_s += model.step_s) {
        simulation.step();
        const std::vector<RuleUse>& rules = simulation.state().congestion.delays.rule_uses;
        for (; seen < rules.size(); ++seen) {
            if (rules[seen].kind != RuleUse::Kind::passed_blocker) continue;
            ++passed;
            EXPECT_TRUE(is_on(simulation.state(), rules[seen].vehicle, rules[seen].lane)) << rules[seen].time_s;
        }
    }
    EXPECT_GT(passed, 20);
}

// What holds of every use of a rule, and of the vehicles, on a grid that gridlocks.
TEST_P(SlowRules, AreUsedAsTheySay) {
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                      {std::string("fidelity=") + GetParam().fidelity, "signal.green=20 s", "demand.left=10 %",
                       "demand.right=30 %", "rules.sight=30 m", "network.grid.columns=3", "network.grid.rows=3"});
    const Model model = network_model(scenario, 2);
    Simulation simulation(model);
    simulation.run_until(GetParam().until_s);
    const State& state = simulation.state();
    EXPECT_TRUE(state.records.violations.none());
    EXPECT_EQ(state.records.violations.conflicts, 0);
    EXPECT_EQ(state.records.entered, state.records.exited + state.present());
    const double cycle_s = scenario.signal.intersection_cycle_s();
    std::set<int> out;
    std::int64_t passed = 0;
    for (const RuleUse& use : state.congestion.delays.rule_uses) {
        if (use.kind == RuleUse::Kind::passed_blocker) {
            ++passed;
            EXPECT_GE(use.stopped_s, 2.0 * scenario.signal.green_s - 1e-6);
        } else if (use.kind == RuleUse::Kind::teleported) {
            EXPECT_GE(use.stopped_s, 3.0 * cycle_s - 1e-6);
            EXPECT_TRUE(out.insert(use.vehicle).second) << "is out already";
        } else if (use.kind == RuleUse::Kind::reinserted) {
            EXPECT_EQ(out.erase(use.vehicle), 1u) << "was not out";
        }
    }
    EXPECT_EQ(passed, state.congestion.delays.passed_blockers);
    EXPECT_EQ(static_cast<int>(out.size()), state.congestion.teleporting.count) << "all who were moved on are back, or wait to be";
    EXPECT_GT(state.congestion.delays.episodes.size(), 20u);
    if (GetParam().until_s > 1000.0) {
        EXPECT_GT(state.congestion.delays.teleported, 0);
        EXPECT_GT(passed, 0);
        EXPECT_FALSE(state.congestion.delays.gridlocks.empty());
    }
    // Nobody waits for ever: who heads a lane for three cycles is moved on, and those behind move up.
    EXPECT_LT(state.congestion.delays.longest_stop_s, 10.0 * cycle_s);
}

// Every second that a vehicle stands is in the account, under one cause.
TEST(SlowHindranceAccount, HasEverySecondThatAVehicleStands) {
    const Scenario scenario = arterial({"network.grid.columns=3"});
    const Model model = network_model(scenario, 2);
    Simulation simulation(model);
    double stood_s = 0.0;
    while (simulation.time_s() < 400.0) {
        const State& state = simulation.state();
        if (state.tick % model.rules.watch_ticks == 0) {
            for (const LaneBlock& block : state.blocks) {
                for (int slot = block.first; slot < block.past_last(); ++slot) {
                    stood_s += state.vehicles.speed_mps[at(slot)] < 0.1 ? 1.0 : 0.0;
                }
            }
        }
        simulation.step();
    }
    const auto& lost = simulation.state().congestion.delays.delay_s;
    EXPECT_NEAR(std::accumulate(lost.begin(), lost.end(), 0.0), stood_s, 1e-6);
    EXPECT_GT(lost[static_cast<std::size_t>(DelayCause::signal)], 0.5 * stood_s);
    EXPECT_EQ(lost[static_cast<std::size_t>(DelayCause::none)], 0.0);
    EXPECT_GT(lost[static_cast<std::size_t>(DelayCause::queue_discharge)], 0.0);
    double episodes_s = 0.0;
    for (const DelayEpisode& e : simulation.state().congestion.delays.episodes) {
        if (is_blocking(e.cause)) episodes_s += e.delay_s;
        EXPECT_GE(e.to_s, e.from_s);
        EXPECT_GE(e.delay_s, e.max_vehicles);
    }
    double hindered_s = 0.0;
    for (std::size_t cause = 0; cause < lost.size(); ++cause) {
        if (is_blocking(static_cast<DelayCause>(cause))) hindered_s += lost[cause];
    }
    EXPECT_NEAR(episodes_s, hindered_s, 1e-6);
}

TEST(SlowKeepClear, LeavesTheJunctionFreeMoreOften) {
    std::vector<double> blocked_s;
    for (const char* rule : {"rules.keep_clear=off", "rules.keep_clear=on"}) {
        const Model model = network_model(arterial({rule, "network.grid.columns=3"}), 2);
        Simulation simulation(model);
        simulation.run_until(900.0);
        EXPECT_TRUE(simulation.state().records.violations.none());
        const auto& lost = simulation.state().congestion.delays.delay_s;
        blocked_s.push_back(lost[static_cast<std::size_t>(DelayCause::gridlock)] +
                            static_cast<double>(simulation.state().congestion.delays.passed_blockers));
    }
    EXPECT_LT(blocked_s[1], 0.5 * blocked_s[0]);
}

// Where lights change one after the other, a column drives up to a light that is red already.
TEST(SlowKeepClear, MindsTheLightAtTheEndOfTheExit) {
    std::vector<double> blocked_s;
    for (const char* rule : {"rules.count_queue_at_red_exit=off", "rules.count_queue_at_red_exit=on"}) {
        const Scenario grid = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                                            {rule, "network.grid.columns=3", "network.grid.rows=3", "demand.left=0 %",
                                             "demand.right=0 %", "signal.green=20 s", "signal.offset=5 s"});
        const Model model = network_model(grid, 2);
        Simulation simulation(model);
        simulation.run_until(900.0);
        EXPECT_TRUE(simulation.state().records.violations.none());
        blocked_s.push_back(simulation.state().congestion.delays.delay_s[static_cast<std::size_t>(DelayCause::junction_blocking)]);
    }
    EXPECT_GT(blocked_s[0], 1000.0);
    EXPECT_LT(blocked_s[1], 0.2 * blocked_s[0]);
}

// Drivers who begin to brake for lines late are told in time too, in both fidelities.
TEST(SlowKeepClear, HoldsWhereDriversBrakeLate) {
    for (const char* fidelity : {"fidelity=meso", "fidelity=full"}) {
        for (const char* stop : {"driver.stop.deceleration=2.5 m/s2", "driver.stop.deceleration=4.7 m/s2"}) {
            const Scenario grid =
                load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                              {fidelity, stop, "network.grid.columns=3", "network.grid.rows=3", "demand.left=0 %",
                               "demand.right=0 %", "signal.green=20 s", "signal.offset=15 s"});
            const Model model = network_model(grid, 2);
            Simulation simulation(model);
            simulation.run_until(600.0);
            const State& state = simulation.state();
            EXPECT_TRUE(state.records.violations.none());
            EXPECT_LT(state.congestion.delays.delay_s[static_cast<std::size_t>(DelayCause::junction_blocking)], 200.0)
                << fidelity << ' ' << stop;
        }
    }
}

}  // namespace
}  // namespace stopline
