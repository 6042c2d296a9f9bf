// Lane changes on parallel lanes before one signal. Lane k of the approach has index 2 k, and its exit lane has index
// 2 k + 1. The exit lanes stand for the turns left, straight and right, so the target lane of a vehicle sets its turn.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "base/containers/index.h"
#include "base/random.h"
#include "sim/lane_change/lane_change.h"
#include "sim/lane_change/route_choice.h"
#include "sim/perception/lane_gaps.h"
#include "support/track.h"

namespace stopline {
namespace {

using testing_support::Track;
using testing_support::TrackPlan;

struct Case {
    const char* fidelity;
    const char* policy;
};

std::string case_name(const testing::TestParamInfo<Case>& info) {
    std::string name = std::string(info.param.fidelity) + "_" + info.param.policy;
    std::erase_if(name, [](char c) { return c == '-'; });
    return name;
}

// Returns a road with parallel lanes. `mirrored` swaps left and right.
Model parallel_lanes(const TrackPlan& plan, bool mirrored = false) {
    Model model = build_model(testing_support::scenario_of(plan), 0);
    LaneGraph& graph = model.graph;
    Approach approach{"approach", {}, 0.0, 0.0};
    const std::array<Turn, 3> turns{Turn::left, Turn::straight, Turn::right};
    for (int k = 0; k < plan.lanes; ++k) {
        const int before = k > 0 ? 2 * (k - 1) : -1;
        const int after = k + 1 < plan.lanes ? 2 * (k + 1) : -1;
        Lane& lane = graph.lanes[at(2 * k)];
        lane.left = mirrored ? after : before;
        lane.right = mirrored ? before : after;
        lane.approach = 0;
        graph.lanes[at(2 * k + 1)].turn = turns[at(k % 3)];
        approach.lanes.push_back(2 * k);
    }
    if (mirrored) std::reverse(approach.lanes.begin(), approach.lanes.end());
    graph.approaches = {approach};
    model.demand.inlets.clear();
    return model;
}

TrackPlan plan_of(const Case& c, int lanes) {
    TrackPlan plan;
    plan.policy = c.policy;
    plan.lanes = lanes;
    plan.length_m = 1000.0;
    plan.overrides = {std::string("fidelity=") + c.fidelity};
    if (std::string(c.fidelity) == "meso") plan.overrides.emplace_back("meso=fitted");
    return plan;
}

// Places a vehicle on lane k. It must change to lane `target` before the stop line. Returns its id.
int place(Track& track, int k, double position_m, double speed_mps, int target) {
    const int id = track.place(2 * k, position_m, speed_mps);
    State& state = track.mutable_state();
    const int slot = state.blocks[at(2 * k)].last();
    state.vehicles.record[at(slot)].route = target;
    adopt_lane_route(track.model(), state, 2 * k, slot);
    return id;
}

// Returns a random number from [0, 1) for a vehicle and a quantity.
double uniform(std::uint64_t seed, int vehicle, int quantity) {
    return random_uniform(seed, static_cast<std::uint64_t>(vehicle), static_cast<std::uint64_t>(quantity),
                          Purpose::turn);
}

// Fills each lane with vehicles. The first front is up to 5 m upstream of `first_front_m`. The gaps are random between
// `min_gap_m` and twice `min_gap_m`, and the target lanes are random too.
void fill(Track& track, std::uint64_t seed, int lanes, double min_gap_m, double speed_mps, double first_front_m) {
    int vehicle = 0;
    for (int k = 0; k < lanes; ++k) {
        double front_m = first_front_m - 5.0 * uniform(seed, ++vehicle, 0);
        while (front_m > 50.0) {
            const int target = static_cast<int>(uniform(seed, vehicle, 1) * lanes);
            place(track, k, front_m, speed_mps, target);
            front_m -= track.model().vehicles[0].length_m + min_gap_m * (1.0 + uniform(seed, ++vehicle, 2));
        }
    }
}

class LaneChanging : public testing::TestWithParam<Case> {};
class DenseLaneChanging : public testing::TestWithParam<Case> {};

// Numbers of discretionary lane changes (`all`) and of returns among them. A return leads back to the lane that the
// vehicle left less than half a minute ago.
struct DiscretionaryChanges {
    int all = 0;
    int returns = 0;

    void add(const std::vector<LaneChange>& changes) {
        constexpr double kHalfMinute_s = 30.0;
        std::map<int, LaneChange> last;
        for (const LaneChange& change : changes) {
            const auto before = last.find(change.vehicle);
            all += change.for_route ? 0 : 1;
            if (before != last.end() && !change.for_route && change.time_s - before->second.time_s < kHalfMinute_s)
                returns += change.to_lane == before->second.from_lane ? 1 : 0;
            last[change.vehicle] = change;
        }
    }
};

// Runs three lanes of vehicles with random target lanes up to a signal and checks for violations.
void run_traffic(const Case& which, std::uint64_t seed, double gap_m, DiscretionaryChanges& discretionary) {
    TrackPlan plan = plan_of(which, 3);
    plan.green_from_s = 20.0;
    plan.green_s = 15.0;
    Model model = parallel_lanes(plan);
    model.signals = {};
    model.signals.add(fixed_time_plan(0, {GroupProgramme({{to_ticks(15.0, model.step_s), Light::green},
                                                          {to_ticks(3.0, model.step_s), Light::yellow},
                                                          {to_ticks(22.0, model.step_s), Light::red}},
                                                         to_ticks(20.0, model.step_s), true)}));
    Track track(std::move(model));
    fill(track, seed, 3, gap_m, std::min(13.0, 0.5 * gap_m), 900.0);
    const auto entered = track.state().records.entered;
    track.run(400.0);
    const Violations& violations = track.state().records.violations;
    EXPECT_TRUE(violations.none()) << violations.overlaps << " overlaps, " << violations.red_entries
                                   << " red entries, seed " << seed << ", gap " << gap_m;
    EXPECT_GT(track.state().records.lane_changes.size(), at(static_cast<int>(entered / 20)));
    discretionary.add(track.state().records.lane_changes);
}

// Seeds 2, 10 and 29 are regression tests: vehicles with SWITCH-1 and SWITCH-2 overlapped before
// keep_room_acceleration() reserved room in proportion to the own speed of the vehicle.
TEST_P(DenseLaneChanging, HasNoCollisionAtAnyDensity) {
    DiscretionaryChanges discretionary;
    for (const std::uint64_t seed : {2U, 7U, 10U, 29U}) {
        for (const double gap_m : {3.2, 5.5, 8.0, 16.0, 40.0}) run_traffic(GetParam(), seed, gap_m, discretionary);
    }
    // Few vehicles change back and forth between queues that move alternately.
    EXPECT_LE(6 * discretionary.returns, discretionary.all);
}

TEST_P(LaneChanging, ReachesTargetLanesWithoutStoppingInFreeTraffic) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        Track track(parallel_lanes(plan_of(GetParam(), 3)));
        fill(track, seed, 3, 60.0, 12.0, 500.0);
        const std::int64_t end = to_ticks(180.0, track.step_s());
        while (track.state().tick < end) {
            track.step();
            const VehicleArrays& v = track.state().vehicles;
            for (const LaneBlock& block : track.state().blocks) {
                for (int slot = block.first; slot < block.past_last(); ++slot) {
                    ASSERT_GT(v.speed_mps[at(slot)], 0.5)
                        << "vehicle " << v.id[at(slot)] << " has stopped, seed " << seed;
                }
            }
        }
        EXPECT_EQ(track.state().present(), 0);
        EXPECT_TRUE(track.state().records.violations.none());
    }
}

TEST_P(LaneChanging, IsSymmetricInLeftAndRight) {
    TrackPlan plan = plan_of(GetParam(), 3);
    // With these settings only mandatory lane changes occur. Discretionary changes are not symmetric: if the lanes on
    // both sides are equally good, a vehicle changes to the right.
    plan.overrides.emplace_back("driver.lane_change.look_ahead_time=1000 s");
    plan.overrides.emplace_back("driver.lane_change.left_factor=1");
    Track one(parallel_lanes(plan));
    Track other(parallel_lanes(plan, true));
    for (Track* track : {&one, &other}) {
        place(*track, 0, 400.0, 12.0, 2);
        place(*track, 1, 390.0, 10.0, 0);
        place(*track, 1, 350.0, 13.0, 1);
        place(*track, 2, 380.0, 11.0, 1);
        place(*track, 2, 340.0, 13.0, 0);
        track->run(60.0);
    }
    ASSERT_GE(one.state().records.lane_changes.size(), 5U);
    ASSERT_EQ(one.state().records.lane_changes.size(), other.state().records.lane_changes.size());
    EXPECT_EQ(one.simulation().state_hash(), other.simulation().state_hash());
}

TEST_P(LaneChanging, TwoVehiclesSwapTheirLanes) {
    Track track(parallel_lanes(plan_of(GetParam(), 2)));
    place(track, 0, 960.0, 8.0, 1);
    place(track, 1, 960.0, 8.0, 0);
    track.run(60.0);
    EXPECT_EQ(track.state().present(), 0);
    EXPECT_EQ(track.state().records.lane_changes.size(), 2U);
}

TEST_P(LaneChanging, WaitsBeforeTheStopLineWithoutAGap) {
    Model model = parallel_lanes(plan_of(GetParam(), 2));
    model.signals = {};
    model.signals.add(fixed_time_plan(0, {GroupProgramme({{1, Light::red}}, 0, true)}));
    Track track(std::move(model));
    const int waiting_vehicle = place(track, 0, 900.0, 10.0, 1);
    // A stopped platoon without usable gaps occupies the target lane throughout the run.
    for (int k = 0; k < 40; ++k) {
        track.place(2, 980.0 - k * (track.model().vehicles[0].length_m + 2.0), 0.0);
    }
    track.mutable_state().vehicles.next_lane[track.slot(2, 0)] = -1;
    track.run(40.0);
    const auto vehicle = track.vehicle(0, 0);
    EXPECT_EQ(vehicle.id, waiting_vehicle);
    EXPECT_LT(vehicle.speed_mps, 0.1);
    EXPECT_LE(vehicle.position_m, 1000.0 - track.model().common_driver().stop.margin_m + 0.1);
    EXPECT_GE(vehicle.position_m, 975.0);
    EXPECT_TRUE(track.state().records.lane_changes.empty());
}

// A vehicle waits at the stop line for a lane change. On the target lane a dense row of vehicles approaches at full
// speed. A vehicle that can still brake gently lets it in.
TEST(OpeningOfGaps, AnApproachingVehicleLetsAWaitingVehicleIn) {
    for (const char* const fidelity : {"full", "meso"}) {
        TrackPlan plan = plan_of({fidelity, "CTG-Ref"}, 2);
        plan.overrides.emplace_back("driver.lane_change.gap_opening=on");
        Track track(parallel_lanes(plan));
        const int waiting_vehicle = place(track, 0, 1000.0 - track.model().common_driver().stop.margin_m, 0.0, 1);
        constexpr int kRow = 40;
        for (int k = 0; k < kRow; ++k) place(track, 1, 990.0 - 22.0 * k, 13.0, 1);
        track.run(40.0);
        ASSERT_EQ(track.state().records.lane_changes.size(), 1U) << fidelity;
        EXPECT_EQ(track.state().records.lane_changes[0].vehicle, waiting_vehicle);
        EXPECT_GT(track.state().blocks[2].count, kRow / 4) << fidelity << ": only the end of the row lets it in";
    }
}

// A vehicle waits at the stop line beside a queue, for a change to the lane of this queue. The second vehicle of the
// queue opens a gap for it, even if it has already let in a vehicle further upstream. It opens no gap if it has already
// let in another vehicle that waited at the line: the two lanes take turns.
TEST(OpeningOfGaps, AQueuedVehicleLetsOneVehicleInAtTheLine) {
    for (const char* const fidelity : {"full", "meso"}) {
        for (const bool at_the_line : {false, true}) {
            TrackPlan plan = plan_of({fidelity, "CTG-Ref"}, 2);
            plan.green_from_s = 5.0;
            plan.overrides.emplace_back("driver.lane_change.gap_opening=on");
            Track track(parallel_lanes(plan));
            const double line_m = 1000.0 - track.model().common_driver().stop.margin_m;
            // The queue is so dense that the gap becomes too short as soon as the second vehicle starts.
            const double share = urgent_share(track.model().driver_of(0).lane_change, 1.0);
            const double space_m =
                track.model().vehicles[0].length_m + required_gap_m(track.model(), 0, 0.0, 0.0, share) + 0.05;
            const int waiting = place(track, 0, line_m, 0.0, 1);
            place(track, 1, line_m, 0.0, 1);
            const int second = place(track, 1, line_m - space_m, 0.0, 1);
            for (int k = 2; k < 6; ++k) place(track, 1, line_m - k * space_m, 0.0, 1);
            LaneChangeMemory& memory = track.mutable_state().vehicles.lane_memory[track.slot(2, 1)];
            // Tick 1 is after the vehicle's entry tick 0, so it counts for this approach.
            (at_the_line ? memory.let_in_waiting_tick : memory.let_in_tick) = 1;
            while (track.state().records.lane_changes.empty() && track.time_s() < 60.0) track.run(track.step_s());
            ASSERT_EQ(track.state().records.lane_changes.size(), 1U) << fidelity;
            EXPECT_EQ(track.state().records.lane_changes[0].vehicle, waiting);
            const LaneBlock& queue = track.state().blocks[2];
            int behind = 0;  // place of the second vehicle of the queue; 0: not behind the vehicle that has changed
            for (int k = 1; k < queue.count; ++k) behind = track.vehicle(2, k).id == second ? k : behind;
            EXPECT_EQ(behind > 0, !at_the_line) << fidelity;
            if (behind == 0) continue;
            EXPECT_GT(track.state().vehicles.lane_memory[track.slot(2, behind)].let_in_waiting_tick, 1) << fidelity;
        }
    }
}

// A vehicle waits at the stop line for a lane change. The vehicle beside it stands so close behind that the gap is too
// short, and it cannot open the gap any more. It must then go on, so that both vehicles leave.
TEST(LongStandstillGap, VehicleThatCannotOpenTheGapGoesOn) {
    for (const char* const fidelity : {"full", "meso"}) {
        Track track(parallel_lanes(plan_of({fidelity, "CDG-6m"}, 2)));
        const double waiting_m = 1000.0 - track.model().common_driver().stop.margin_m;
        place(track, 0, waiting_m, 0.0, 1);
        place(track, 1, waiting_m - track.model().vehicles[0].length_m - 1.2, 0.0, 1);
        track.run(60.0);
        EXPECT_EQ(track.state().present(), 0) << fidelity;
        EXPECT_EQ(track.state().records.lane_changes.size(), 1U) << fidelity;
    }
}

// As in the previous test, but the vehicle waits upstream of the line, where it requires a longer gap than at the line.
TEST(LongStandstillGap, RequiredGapIsThatOfThePresentUrgency) {
    for (const char* const fidelity : {"full", "meso"}) {
        Track track(parallel_lanes(plan_of({fidelity, "CDG-6m"}, 2)));
        place(track, 0, 985.0, 0.0, 1);
        place(track, 1, 985.0 - track.model().vehicles[0].length_m - 1.85, 0.0, 1);
        track.run(60.0);
        EXPECT_EQ(track.state().present(), 0) << fidelity;
    }
}

constexpr double kPocket_m = 60.0;

// Returns a road with `lanes` lanes before a red signal. Lane 0 is a pocket, which begins kPocket_m before the line.
Model road_with_pocket(const Case& c, int lanes) {
    TrackPlan plan = plan_of(c, lanes);
    plan.green_from_s = testing_support::kForever_s;
    Model model = parallel_lanes(plan);
    Lane& pocket = model.graph.lanes[0];
    pocket.start_offset_m = pocket.stop_line_m - kPocket_m;
    pocket.length_m -= pocket.start_offset_m;
    pocket.stop_line_m = kPocket_m;
    return model;
}

// Returns the number of vehicles at rest that fit into the pocket.
int pocket_capacity(const Track& track) {
    const double space_m = track.model().vehicles[0].length_m + track.model().policies[0].settings.standstill_gap_m;
    return static_cast<int>(kPocket_m / space_m);
}

TEST_P(LaneChanging, WaitsBehindTheQueueOfAFullPocket) {
    Track track(road_with_pocket(GetParam(), 2));
    const int capacity = pocket_capacity(track);
    for (int k = 0; k < capacity + 2; ++k) place(track, 1, 900.0 - 30.0 * k, 10.0, 0);
    track.run(90.0);
    const State& state = track.state();
    ASSERT_GE(state.blocks[0].count, capacity - 1) << "the pocket fills";
    ASSERT_GE(state.blocks[2].count, 2) << "the pocket is too small for all vehicles";
    const auto first = track.vehicle(2, 0);
    EXPECT_LT(first.speed_mps, 0.1);
    EXPECT_LT(first.position_m, 1000.0 - kPocket_m + track.model().vehicles[0].length_m + 1.0)
        << "the vehicle waits at the start of the pocket, not at the stop line";
}

// A queue stands on lane 1, beside the pocket (lane 0). The third lane is empty. `target` 0: all vehicles must turn
// from the pocket. `target` 1: all vehicles go straight on, which lane 1 and the third lane both allow. Returns the
// number of vehicles that change to the third lane.
int changes_to_third_lane(const Case& c, int target) {
    Model model = road_with_pocket(c, 3);
    model.graph.lanes[5].turn = Turn::straight;  // the second and the third lane allow straight on
    Track track(std::move(model));
    const double space_m =
        track.model().vehicles[0].length_m + track.model().policies[0].settings.standstill_gap_m + 0.1;
    for (int k = 0; k < 20; ++k) place(track, 1, 995.0 - space_m * k, 0.0, target);
    track.run(30.0);
    int changes = 0;
    for (const LaneChange& change : track.state().records.lane_changes) changes += change.to_lane == 4 ? 1 : 0;
    return changes;
}

TEST_P(LaneChanging, KeepsTheLaneBesideItsPocketInAQueue) {
    EXPECT_EQ(changes_to_third_lane(GetParam(), 0), 0);
    EXPECT_GT(changes_to_third_lane(GetParam(), 1), 0) << "the third lane attracts vehicles that need no pocket";
}

TEST_P(LaneChanging, OvertakesASlowerVehicleWithOneChange) {
    Track track([&] {
        Model model = parallel_lanes(plan_of(GetParam(), 2));
        for (const int lane : {1, 3}) model.graph.lanes[at(lane)].turn = Turn::straight;
        return model;
    }());
    track.place(0, 300.0, 6.0);
    track.place(0, 200.0, 13.0);
    const double slow_mps = 6.0;
    const std::int64_t end = to_ticks(50.0, track.step_s());
    while (track.state().tick < end) {
        constexpr int kSlowVehicle = 0;
        State& state = track.mutable_state();
        for (const LaneBlock& block : state.blocks) {
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                if (state.vehicles.id[at(slot)] == kSlowVehicle) state.vehicles.speed_mps[at(slot)] = slow_mps;
            }
        }
        track.step();
    }
    ASSERT_EQ(track.state().records.lane_changes.size(), 1U);
    EXPECT_EQ(track.state().records.lane_changes[0].vehicle, 1);
    EXPECT_FALSE(track.state().records.lane_changes[0].for_route);
}

INSTANTIATE_TEST_SUITE_P(Fidelities, LaneChanging,
                         testing::Values(Case{"full", "CDG"}, Case{"full", "CTG-Ref"}, Case{"full", "SWITCH-1"},
                                         Case{"meso", "CDG"}, Case{"meso", "CTG-Ref"}, Case{"meso", "SWITCH-1"},
                                         Case{"meso", "MIX"}),
                         case_name);
INSTANTIATE_TEST_SUITE_P(Fidelities, DenseLaneChanging,
                         testing::Values(Case{"full", "CDG"}, Case{"full", "CTG-Ref"}, Case{"full", "SWITCH-1"},
                                         Case{"full", "SWITCH-2"}, Case{"full", "MIX"}, Case{"meso", "CDG"},
                                         Case{"meso", "CTG-Ref"}, Case{"meso", "SWITCH-1"}, Case{"meso", "SWITCH-2"},
                                         Case{"meso", "MIX"}),
                         case_name);

}  // namespace
}  // namespace stopline
