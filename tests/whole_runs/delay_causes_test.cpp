// Attribution of delays to causes. The tests place vehicles by hand on two intersections and attribute the delays of
// single steps.
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
#include "sim/state/queries/stopped_vehicles.h"
#include "sim/step/occupied_lanes.h"
#include "support/track.h"

namespace stopline {
namespace {

using testing_support::Track;

Scenario arterial(const std::vector<std::string>& overrides = {}) {
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/arterial.yaml", overrides);
}

// Two intersections without vehicles. Lanes are given by name.
class DelayCauses : public testing::Test {
protected:
    DelayCauses() : track_(empty_model()) { set_lights(); }

    void set_lights() {
        state().tick = 1000;
        // The street from west to east has green.
        for (std::size_t group = 0; group < state().signals.lights.size(); ++group) {
            state().signals.lights[group] = group % 2 == 0 ? Light::green : Light::red;
        }
    }

    static Model empty_model() {
        Model model = network_model(arterial({"network.grid.columns=2"}), 2);
        for (DemandPlan::Inlet& inlet : model.demand.inlets) inlet.vehicles = 0;
        return model;
    }

    State& state() { return track_.mutable_state(); }

    int lane(const std::string& name) {
        const std::vector<Lane>& lanes = track_.model().graph.lanes;
        return static_cast<int>(
            std::find_if(lanes.begin(), lanes.end(), [&](const Lane& l) { return l.name == name; }) - lanes.begin());
    }

    // Places a stopped vehicle and returns its id. `next` is the connection that it takes.
    int place_stopped(const std::string& name, double front_m, const std::string& next = {}) {
        return place(name, front_m, 0.0, next);
    }
    // Places a vehicle and returns its id.
    int place(const std::string& name, double front_m, double speed_mps, const std::string& next = {}) {
        const int own_lane = lane(name);
        track_.place(own_lane, front_m, speed_mps);
        const std::size_t slot = at(state().blocks[at(own_lane)].last());
        state().vehicles.stopped_since_tick[slot] = static_cast<int>(state().tick);
        const Lane& road = track_.model().graph.lanes[at(own_lane)];
        const std::string next_lane =
            next.empty() && road.origin >= 0 ? track_.model().graph.lanes[at(road.next[0])].name : next;
        state().vehicles.next_lane[slot] = next_lane.empty() ? -1 : lane(next_lane);
        const auto& routes = track_.model().graph.routes;
        for (std::size_t k = 0; k < routes.size(); ++k) {
            const auto own = std::find(routes[k].lanes.begin(), routes[k].lanes.end(), own_lane);
            if (own == routes[k].lanes.end()) continue;
            const auto after =
                std::find(routes[k].lanes.begin(), routes[k].lanes.end(), state().vehicles.next_lane[slot]);
            if (!next_lane.empty() && after == routes[k].lanes.end()) continue;
            state().vehicles.record[slot].route = static_cast<int>(k);
            state().vehicles.record[slot].route_index = static_cast<int>(own - routes[k].lanes.begin());
        }
        return state().vehicles.id[slot];
    }

    // Returns the start of the conflict area of two connections, along the first one.
    double conflict_start_m(const std::string& one, const std::string& two) {
        for (const Conflict& c : track_.model().graph.conflicts_of(lane(one))) {
            if (c.other == lane(two)) return c.from_m;
        }
        ADD_FAILURE() << one << " and " << two << " have no conflict";
        return 0.0;
    }

    // Runs those phases of a step that are needed to attribute delays.
    void attribute() {
        const Model& model = track_.model();
        Partition& all = state().partitions[0];
        find_occupied_lanes(state(), state().queues, all);
        find_junction_occupants(state(), state().junctions, all);
        decide_stop_lines(model, state(), all);
        decide_right_of_way(model, state(), all);
        watch_delays(model, state());
    }

    // Returns what the delay watch knows about a vehicle that must be stopped.
    StoppedVehicle stopped_vehicle(int id) { return find_stopped_vehicle(state(), id).value(); }

    double delay_s(DelayCause cause) { return state().congestion.delays.delay_s[static_cast<std::size_t>(cause)]; }

    Track track_;
};

TEST_F(DelayCauses, QueueAtARedLightWaitsForTheSignal) {
    place_stopped("c0r0_south_in_0", 154.0, "c0r0_south_0_straight");
    place_stopped("c0r0_south_in_0", 146.0, "c0r0_south_0_straight");
    place_stopped("c0r0_south_in_0", 138.0, "c0r0_south_0_straight");
    attribute();
    EXPECT_EQ(delay_s(DelayCause::signal), 3.0);
    EXPECT_TRUE(state().congestion.delays.episodes.empty());
    EXPECT_TRUE(state().congestion.delays.gridlocks.empty());
}

TEST_F(DelayCauses, VehicleStoppedInAConflictAreaBlocksTheJunction) {
    const double conflict_m = conflict_start_m("c0r0_south_0_straight", "c0r0_west_0_straight");
    const int blocker = place_stopped("c0r0_south_0_straight", conflict_m + 1.0);
    const int first = place_stopped("c0r0_west_in_0", 154.0, "c0r0_west_0_straight");
    place_stopped("c0r0_west_in_0", 146.0, "c0r0_west_0_straight");
    attribute();
    ASSERT_EQ(state().congestion.delays.episodes.size(), 1u);
    const DelayEpisode& e = state().congestion.delays.episodes[0];
    EXPECT_EQ(e.cause, DelayCause::junction_blocking);
    EXPECT_EQ(e.vehicle, first);
    EXPECT_EQ(e.blocker, blocker);
    EXPECT_EQ(e.blocker_lane, lane("c0r0_south_0_straight"));
    EXPECT_EQ(e.max_vehicles, 2);
    EXPECT_EQ(delay_s(DelayCause::junction_blocking), 2.0);
}

TEST_F(DelayCauses, FullExitLaneIsSpillbackOrTurnBlocking) {
    place_stopped("c1r0_west_in_0", 4.0, "c1r0_west_0_straight");  // its rear is still in the junction
    const int straight = place_stopped("c0r0_west_in_0", 154.0, "c0r0_west_0_straight");
    place_stopped("c1r0_west_in_1", 4.0, "c1r0_west_1_straight");
    for (std::size_t group = 0; group < state().signals.lights.size(); ++group)
        state().signals.lights[group] = Light::green;
    const int turning = place_stopped("c0r0_south_in_1", 154.0, "c0r0_south_1_right");
    attribute();
    ASSERT_EQ(state().congestion.delays.episodes.size(), 2u);
    for (const DelayEpisode& e : state().congestion.delays.episodes) {
        EXPECT_EQ(e.cause, e.vehicle == straight ? DelayCause::spillback : DelayCause::turn_blocking);
        EXPECT_TRUE(e.vehicle == straight || e.vehicle == turning);
    }
}

// The keep-clear rule has held a vehicle because of a blocker in its exit lane. When the signal is red, the vehicle
// still counts as waiting for this blocker, until the blocker has moved.
TEST_F(DelayCauses, VehicleAtARedLightStillWaitsForItsLastBlocker) {
    const int blocker = place_stopped("c1r0_west_in_0", 4.0, "c1r0_west_0_straight");
    const int first = place_stopped("c0r0_west_in_0", 154.0, "c0r0_west_0_straight");
    const int blocker_slot = state().blocks[at(lane("c1r0_west_in_0"))].first;
    attribute();
    EXPECT_EQ(delay_s(DelayCause::spillback), 1.0);
    for (const bool moves : {false, true}) {
        state().tick += track_.model().rules.watch_ticks;
        for (Light& light : state().signals.lights) light = Light::red;
        if (moves) state().vehicles.speed_mps[at(blocker_slot)] = 1.0;
        attribute();
        state().vehicles.speed_mps[at(blocker_slot)] = 0.0;
        EXPECT_EQ(stopped_vehicle(first).waits_for, moves ? -1 : blocker);
    }
    state().tick += track_.model().rules.watch_ticks;
    attribute();
    EXPECT_EQ(stopped_vehicle(first).waits_for, -1) << "the blocker has moved and stopped again";
    EXPECT_EQ(delay_s(DelayCause::spillback), 1.0);
}

TEST_F(DelayCauses, VehicleAtARedLightAlsoWaitsForALeaderInTheJunction) {
    const int leader = place_stopped("c0r0_south_0_straight", 3.0);
    const int waiting_vehicle = place_stopped("c0r0_south_in_0", 152.0, "c0r0_south_0_straight");
    attribute();
    EXPECT_EQ(stopped_vehicle(waiting_vehicle).direct_cause, DelayCause::signal);
    EXPECT_EQ(stopped_vehicle(waiting_vehicle).waits_for, leader);
    EXPECT_EQ(delay_s(DelayCause::signal), 1.0);
}

// A stop of two cycles is reported for every cause, also for a red signal, where no vehicle blocks the stopped one.
TEST_F(DelayCauses, EveryCauseIsReportedAfterAStopOfTwoCycles) {
    const int waiting_vehicle = place_stopped("c0r0_south_in_0", 154.0, "c0r0_south_0_straight");
    state().tick += track_.model().rules.long_wait_ticks - 1;
    attribute();
    EXPECT_TRUE(state().congestion.delays.episodes.empty());
    state().tick += 1;
    attribute();
    ASSERT_EQ(state().congestion.delays.episodes.size(), 1u);
    EXPECT_EQ(state().congestion.delays.episodes[0].cause, DelayCause::signal);
    EXPECT_EQ(state().congestion.delays.episodes[0].vehicle, waiting_vehicle);
}

// Threads decide at several intersections at the same time. A decision of the current step at the next intersection
// must not matter, because another thread may not have made it yet.
TEST_F(DelayCauses, YieldingAtTheNextIntersectionDoesNotCount) {
    place_stopped("c1r0_west_in_0", 5.0, "c1r0_west_0_straight");
    const std::size_t leader = at(state().blocks[at(lane("c1r0_west_in_0"))].first);
    const int connection = lane("c0r0_west_0_straight");
    const double front_m = track_.model().graph.lanes[at(connection)].length_m - 2.0;
    place_stopped("c0r0_west_0_straight", front_m);
    const int slot = state().blocks[at(connection)].first;
    attribute();
    state().vehicles.record[at(slot)].leader_id = state().vehicles.id[leader];
    state().vehicles.position_m[at(slot - 1)] = front_m + 7.0;
    state().vehicles.length_m[at(slot - 1)] = state().vehicles.length_m[leader];
    state().vehicles.speed_mps[at(slot - 1)] = 0.0;
    const JunctionOccupant occupant{slot, front_m, 0.0, 0};
    for (const int yield_tick : {kNeverYielded_tick, static_cast<int>(state().tick)}) {
        state().vehicles.record[leader].yield_tick = yield_tick;
        EXPECT_FALSE(is_behind_yielding_vehicle(state(), connection, occupant)) << yield_tick;
    }
}

// The slot before a lane's first vehicle holds a copy of the leader beyond the lane. The yielding state in this slot is
// not that of a vehicle and must not count: neither for an occupant that has its front on the exit lane, nor for one
// that has its front exactly at the start of its connection.
TEST_F(DelayCauses, YieldingStateBeforeTheFirstVehicleOfALaneDoesNotCount) {
    const int connection = lane("c0r0_west_0_straight");
    const double length_m = track_.model().graph.lanes[at(connection)].length_m;
    place_stopped("c1r0_west_in_0", 1.0, "c1r0_west_0_straight");
    place_stopped("c0r0_west_0_straight", 0.0);
    for (const bool on_exit : {true, false}) {
        const int slot = state().blocks[at(on_exit ? lane("c1r0_west_in_0") : connection)].first;
        VehicleArrays& v = state().vehicles;
        v.record[at(slot)].leader_id = v.id[at(slot)] + 1;
        v.position_m[at(slot - 1)] = v.position_m[at(slot)] + 7.0;
        v.length_m[at(slot - 1)] = v.length_m[at(slot)];
        v.speed_mps[at(slot - 1)] = 0.0;
        v.record[at(slot - 1)].yield_tick = static_cast<int>(state().tick);
        const double front_m = v.position_m[at(slot)] + (on_exit ? length_m : 0.0);
        EXPECT_FALSE(is_behind_yielding_vehicle(state(), connection, {slot, front_m, front_m - 4.0, 0})) << on_exit;
    }
}

// In full dynamics vehicles crawl for some seconds while they close up to a queue. Other drivers must treat them as
// stopped.
TEST_F(DelayCauses, CrawlingBlockerCountsAsStopped) {
    const double conflict_m = conflict_start_m("c0r0_south_0_straight", "c0r0_west_0_straight");
    for (const double speed_mps : {0.3, 2.0}) {
        for (const bool in_exit : {false, true}) {
            track_ = Track(empty_model());
            set_lights();
            const int blocker = in_exit ? place("c1r0_west_in_0", 4.0, speed_mps, "c1r0_west_0_straight")
                                        : place("c0r0_south_0_straight", conflict_m + 1.0, speed_mps);
            place_stopped("c0r0_west_in_0", 154.0, "c0r0_west_0_straight");
            attribute();
            const int stop_slot = state().stop_lines.stop_slot[at(lane("c0r0_west_in_0"))];
            if (speed_mps > 1.0) {
                EXPECT_EQ(stop_slot, -1) << "a faster vehicle will make room";
                continue;
            }
            EXPECT_GE(stop_slot, 0);
            ASSERT_EQ(state().congestion.delays.episodes.size(), 1u);
            const DelayEpisode& e = state().congestion.delays.episodes[0];
            EXPECT_EQ(e.cause, in_exit ? DelayCause::spillback : DelayCause::junction_blocking);
            EXPECT_EQ(e.blocker, blocker);
            EXPECT_EQ(e.blocker_lane, lane(in_exit ? "c1r0_west_in_0" : "c0r0_south_0_straight"));
            EXPECT_EQ(e.max_vehicles, 1) << "the crawling vehicle itself is not counted";
        }
    }
}

// A vehicle waits because its exit lane is full. The queue on the exit lane waits for a blocker in the next
// intersection. The blocker is stopped at first and crawls a second later.
TEST_F(DelayCauses, BlockerThatStartsToCrawlIsNotInAGridlock) {
    const double conflict_m = conflict_start_m("c1r0_south_0_straight", "c1r0_west_0_straight");
    const int blocker = place_stopped("c1r0_south_0_straight", conflict_m + 1.0);
    for (double front_m = 154.0; front_m > 4.0; front_m -= 8.0) {
        place_stopped("c1r0_west_in_0", front_m, "c1r0_west_0_straight");
    }
    place_stopped("c0r0_west_in_0", 154.0, "c0r0_west_0_straight");
    attribute();
    state().vehicles.speed_mps[at(state().blocks[at(lane("c1r0_south_0_straight"))].first)] = 0.3;
    state().tick += 10;
    attribute();
    EXPECT_TRUE(state().congestion.delays.gridlocks.empty());
    ASSERT_EQ(state().congestion.delays.episodes.size(), 2u);
    EXPECT_EQ(state().congestion.delays.episodes[1].blocker, blocker);
}

// Moving vehicles fill the exit lane. If the signal at the end of this lane is yellow or red, they will stop there and
// leave no room for a further vehicle.
TEST_F(DelayCauses, MovingVehiclesCountAsStoppedBeforeARedLight) {
    constexpr double kSpace_m = 5.15 + 2.95;  // length of a vehicle and its standstill gap
    constexpr double kMoving_mps = 10.0;
    const std::string exit = "c1r0_west_in_0";
    const double line_m = track_.model().graph.lanes[at(lane(exit))].stop_line_m;
    const int capacity = static_cast<int>(line_m / kSpace_m);
    const int origin = track_.model().graph.lanes[at(lane("c1r0_west_0_straight"))].origin;
    ASSERT_EQ(origin, lane(exit));
    for (const Light light : {Light::green, Light::yellow, Light::red}) {
        for (const int present : {capacity - 1, capacity}) {
            track_ = Track(empty_model());
            set_lights();
            state().signals.lights[at(track_.model().graph.lanes[at(lane(exit))].signal_group)] = light;
            int last = -1;
            // Each vehicle is still upstream of the position at which it will stop.
            for (int k = 0; k < present; ++k) {
                last = place(exit, line_m - 1.0 - kSpace_m * (k + 0.3), kMoving_mps, "c1r0_west_0_straight");
            }
            const int waiting_vehicle = place_stopped("c0r0_west_in_0", 154.0, "c0r0_west_0_straight");
            attribute();
            const bool has_room = light == Light::green || present < capacity;
            const int stop_slot = state().stop_lines.stop_slot[at(lane("c0r0_west_in_0"))];
            EXPECT_EQ(stop_slot < 0, has_room) << static_cast<int>(light) << ", " << present << " of " << capacity;
            if (has_room || stop_slot < 0) continue;
            ASSERT_EQ(state().congestion.delays.episodes.size(), 1u);
            EXPECT_EQ(state().congestion.delays.episodes[0].cause, DelayCause::spillback);
            EXPECT_EQ(state().congestion.delays.episodes[0].vehicle, waiting_vehicle);
            EXPECT_EQ(state().congestion.delays.episodes[0].blocker, last);
        }
    }
}

// Four vehicles from four legs block each other in a cycle.
TEST_F(DelayCauses, CycleOfWaitingVehiclesIsAGridlock) {
    const std::vector<std::string> ring{"c0r0_west_0_straight", "c0r0_south_0_straight", "c0r0_east_0_straight",
                                        "c0r0_north_0_straight"};
    std::set<int> members;
    for (std::size_t k = 0; k < ring.size(); ++k) {
        // The front is just before the conflict area that this vehicle shares with its blocker. The body is in the
        // conflict area that it shares with the previous vehicle.
        double blocked_m = 0.0;
        for (const std::string& other : ring) {
            if (other == ring[k] || other == ring[(k + 2) % 4]) continue;
            blocked_m = std::max(blocked_m, conflict_start_m(ring[k], other));
        }
        members.insert(place_stopped(ring[k], blocked_m - 0.5));
    }
    attribute();
    ASSERT_EQ(state().congestion.delays.gridlocks.size(), 1u);
    const Gridlock& g = state().congestion.delays.gridlocks[0];
    EXPECT_EQ(std::set<int>(g.vehicles.begin(), g.vehicles.end()), members);
    EXPECT_EQ(delay_s(DelayCause::gridlock), 4.0);
    state().tick += track_.model().rules.watch_ticks;
    attribute();
    ASSERT_EQ(state().congestion.delays.gridlocks.size(), 1u) << "the same gridlock one second later";
    EXPECT_EQ(state().congestion.delays.gridlocks[0].to_s - state().congestion.delays.gridlocks[0].from_s, 1.0);
}

// Every second for which a vehicle is stopped belongs to exactly one cause.
TEST(SlowDelayBalance, CausesAddUpToTheStoppedTime) {
    const Scenario scenario = arterial({"network.grid.columns=3"});
    const Model model = network_model(scenario, 2);
    Simulation simulation(model);
    double stopped_s = 0.0;
    while (simulation.time_s() < 400.0) {
        const State& state = simulation.state();
        if (state.tick % model.rules.watch_ticks == 0) {
            for (const LaneBlock& block : state.blocks) {
                for (int slot = block.first; slot < block.past_last(); ++slot) {
                    stopped_s += state.vehicles.speed_mps[at(slot)] < 0.1 ? 1.0 : 0.0;
                }
            }
        }
        simulation.step();
    }
    const auto& delay_s = simulation.state().congestion.delays.delay_s;
    EXPECT_NEAR(std::accumulate(delay_s.begin(), delay_s.end(), 0.0), stopped_s, 1e-6);
    EXPECT_GT(delay_s[static_cast<std::size_t>(DelayCause::signal)], 0.5 * stopped_s);
    EXPECT_EQ(delay_s[static_cast<std::size_t>(DelayCause::none)], 0.0);
    EXPECT_GT(delay_s[static_cast<std::size_t>(DelayCause::queue_discharge)], 0.0);
    double episodes_s = 0.0;
    for (const DelayEpisode& e : simulation.state().congestion.delays.episodes) {
        if (is_blocking(e.cause)) episodes_s += e.delay_s;
        EXPECT_GE(e.to_s, e.from_s);
        EXPECT_GE(e.delay_s, e.max_vehicles);
    }
    double blocked_s = 0.0;
    for (std::size_t cause = 0; cause < delay_s.size(); ++cause) {
        if (is_blocking(static_cast<DelayCause>(cause))) blocked_s += delay_s[cause];
    }
    EXPECT_NEAR(episodes_s, blocked_s, 1e-6);
}

}  // namespace
}  // namespace stopline
