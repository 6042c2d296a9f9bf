// Avoidance of deadlocks inside an intersection. Three vehicles from three sides are inside, in most tests stopped.
// Each of the first two is blocked by the next one. A fourth vehicle would close the cycle if it drove on, because it
// would block the third one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "base/containers/index.h"
#include "sim/junction/deadlock_avoidance.h"
#include "sim/junction/occupants.h"
#include "sim/junction/right_of_way.h"
#include "sim/state/queries/stopping_distance.h"
#include "sim/step/occupied_lanes.h"
#include "support/track.h"

namespace stopline {
namespace {

using testing_support::Track;

constexpr double kBefore_m = 0.2;  // a stopped vehicle stands this far before the next conflict area

class DeadlockAvoidance : public testing::TestWithParam<const char*> {
protected:
    DeadlockAvoidance() : track_(empty_model()) {
        track_.mutable_state().tick = 1000;
        place_before("west_0_straight", "south_0_straight");
        place_before("south_0_straight", "east_0_straight");
        place_before("east_0_straight", "north_0_straight");
        place("north_0_straight", entered().from_m - 5.0);
    }

    static Model empty_model() {
        const std::string fidelity = std::string("fidelity=") + GetParam();
        Model model = build_model(
            load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml", {fidelity, "rules.keep_clear=on"}), 0);
        for (DemandPlan::Inlet& inlet : model.demand.inlets) inlet.vehicles = 0;
        return model;
    }

    int lane(const std::string& name) const {
        const std::vector<Lane>& lanes = track_.model().graph.lanes;
        const auto is_named = [&](const Lane& lane) { return lane.name == name; };
        return static_cast<int>(std::find_if(lanes.begin(), lanes.end(), is_named) - lanes.begin());
    }

    Conflict conflict(const std::string& one, const std::string& two) const {
        for (const Conflict& c : track_.model().graph.conflicts_of(lane(one))) {
            if (c.other == lane(two)) return c;
        }
        ADD_FAILURE() << one << " and " << two << " have no conflict";
        return {};
    }

    // Places a stopped vehicle on a connection.
    void place(const std::string& connection, double front_m) {
        const int number = lane(connection);
        track_.place(number, front_m, 0.0);
        VehicleRecord& record = track_.mutable_state().vehicles.record[slot_on(connection)];
        const std::vector<Route>& routes = track_.model().graph.routes;
        const auto has_connection = [&](const Route& route) { return route.lanes[1] == number; };
        record.route = static_cast<int>(std::find_if(routes.begin(), routes.end(), has_connection) - routes.begin());
        record.route_index = 1;
        record.junction_entry_tick = 900;
    }

    void place_before(const std::string& connection, const std::string& next) {
        place(connection, conflict(connection, next).from_m - kBefore_m);
    }

    std::size_t slot_on(const std::string& connection) const { return track_.slot(lane(connection), 0); }
    VehicleArrays& vehicles() { return track_.mutable_state().vehicles; }

    // Places a driving vehicle of the same length behind the vehicle on a connection.
    void add_follower(const std::string& connection, double front_m, double speed_mps) {
        track_.place(lane(connection), front_m, speed_mps);
        const std::size_t follower = track_.slot(lane(connection), 1);
        vehicles().record[follower] = vehicles().record[slot_on(connection)];
        vehicles().length_m[follower] = vehicles().length_m[slot_on(connection)];
    }

    // Lets a vehicle drive towards the area that it shares with connection `next`.
    void drive_towards(const std::string& connection, const std::string& next, double distance_m, double speed_mps) {
        const std::size_t slot = slot_on(connection);
        vehicles().position_m[slot] = conflict(connection, next).from_m - distance_m;
        vehicles().speed_mps[slot] = speed_mps;
    }

    bool can_stop(std::size_t slot, double distance_m) const {
        const Model& model = track_.model();
        const VehicleArrays& v = track_.state().vehicles;
        return model.meso ? can_stop_within(model, v.speed_mps[slot], distance_m)
                          : can_stop_after_response(model, v, static_cast<int>(slot), distance_m,
                                                    model.common_driver().cacc.deceleration_emergency_mps2);
    }

    // The area that the vehicle from the north must not enter.
    Conflict entered() const { return conflict("north_0_straight", "east_0_straight"); }

    // Returns the area that the k-th vehicle on a connection must not enter.
    KeptOutArea kept_out_area(const std::string& connection = "north_0_straight", int k = 0) {
        State& state = track_.mutable_state();
        find_occupied_lanes(state, state.queues, state.partitions[0]);
        find_junction_occupants(state, state.junctions, state.partitions[0]);
        const auto slot = static_cast<int>(track_.slot(lane(connection), k));
        const double speed_mps = state.vehicles.speed_mps[at(slot)];
        const Candidate candidate{slot, state.vehicles.position_m[at(slot)], true, speed_mps < 1.0};
        return area_to_keep_clear(track_.model(), state, lane(connection), candidate);
    }

    Track track_;
};
INSTANTIATE_TEST_SUITE_P(BothFidelities, DeadlockAvoidance, testing::Values("full", "meso"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST_P(DeadlockAvoidance, KeepsTheLastVehicleOutOfTheCycle) {
    const KeptOutArea area = kept_out_area();
    EXPECT_EQ(area.from_m, entered().from_m);
    EXPECT_EQ(area.crossing_slot, static_cast<int>(slot_on("east_0_straight")));
}

// The vehicle from the north entered the intersection first, so it would drive on without the rule.
TEST_P(DeadlockAvoidance, TheLastVehicleWaitsForTheOneThatMustCross) {
    vehicles().record[slot_on("north_0_straight")].junction_entry_tick = 800;
    vehicles().position_m[slot_on("north_0_straight")] = entered().from_m - 2.0;
    kept_out_area();
    decide_right_of_way(track_.model(), track_.mutable_state(), track_.mutable_state().partitions[0]);
    const YieldStop* const stop =
        yield_stops_of(track_.state(), lane("north_0_straight")).find(static_cast<int>(slot_on("north_0_straight")));
    ASSERT_NE(stop, nullptr);
    EXPECT_EQ(stop->reason, YieldReason::deadlock);
    EXPECT_EQ(stop->blocker, static_cast<int>(slot_on("east_0_straight")));
    EXPECT_LT(stop->position_m, entered().from_m);
}

TEST_P(DeadlockAvoidance, AnOpenChainIsNoCycle) {
    vehicles().speed_mps[slot_on("south_0_straight")] = 1.5;  // this vehicle drives on
    EXPECT_FALSE(kept_out_area().exists());
}

TEST_P(DeadlockAvoidance, BelongsToTheKeepClearRule) {
    const_cast<Model&>(track_.model()).rules.keep_clear = false;
    EXPECT_FALSE(kept_out_area().exists());
}

TEST_P(DeadlockAvoidance, ThePassBlockerRuleReplacesIt) {
    const_cast<Model&>(track_.model()).rules.pass_blocker_ticks = 1;
    EXPECT_FALSE(kept_out_area().exists());
}

TEST_P(DeadlockAvoidance, AVehicleThatCannotStopDrivesOn) {
    vehicles().speed_mps[slot_on("north_0_straight")] = 12.0;
    EXPECT_FALSE(kept_out_area().exists());
}

// The vehicles still drive, but each of them must stop before its next area.
TEST_P(DeadlockAvoidance, DrivingVehiclesCanCloseACycle) {
    drive_towards("west_0_straight", "south_0_straight", 2.0, 1.5);
    drive_towards("south_0_straight", "east_0_straight", 2.0, 1.5);
    drive_towards("east_0_straight", "north_0_straight", 2.0, 1.5);
    vehicles().speed_mps[slot_on("north_0_straight")] = 3.0;
    const KeptOutArea area = kept_out_area();
    EXPECT_EQ(area.from_m, entered().from_m);
    EXPECT_EQ(area.crossing_slot, static_cast<int>(slot_on("east_0_straight")));
}

TEST_P(DeadlockAvoidance, AVehicleBelongsToTheCycleIfItCanNoLongerStopBeforeItsArea) {
    drive_towards("south_0_straight", "west_0_straight", 1.0, 4.0);
    EXPECT_TRUE(kept_out_area().exists());
    drive_towards("south_0_straight", "west_0_straight", 6.0, 4.0);
    EXPECT_FALSE(kept_out_area().exists());
}

// Another vehicle from the south is still upstream of the stop line. It can stop before the last area of its path only.
TEST_P(DeadlockAvoidance, AFastVehicleBelongsToTheCycleBeforeItPassesTheStopLine) {
    drive_towards("south_0_straight", "east_0_straight", -20.0, 5.0);  // this vehicle leaves the intersection
    EXPECT_FALSE(kept_out_area().exists());
    const int approach = track_.model().graph.lanes[at(lane("south_0_straight"))].origin;
    const Lane& road = track_.model().graph.lanes[at(approach)];
    const double front_m = -road.length_m + road.stop_line_m - 0.5;
    const double margin_m = track_.model().drivers.front().give_way.margin_m;
    const double to_last_m = conflict("south_0_straight", "east_0_straight").from_m - margin_m - front_m;
    track_.place(approach, road.length_m + front_m, 5.0);
    const std::size_t fast = track_.slot(approach, 0);
    while (can_stop(fast, to_last_m)) vehicles().speed_mps[fast] += 0.1;
    vehicles().speed_mps[fast] -= 0.1;
    vehicles().record[fast].route = vehicles().record[slot_on("south_0_straight")].route;
    vehicles().record[fast].route_index = 0;
    vehicles().next_lane[fast] = lane("south_0_straight");
    track_.mutable_state().signals.lights[at(road.signal_group)] = Light::green;
    EXPECT_TRUE(kept_out_area().exists());
    track_.mutable_state().stop_lines.stop_slot[at(approach)] = static_cast<int>(fast);
    EXPECT_FALSE(kept_out_area().exists());
}

// The vehicle from the south waits for a vehicle on the right lane from the east. If it is short, its body then leaves
// the path of the vehicle from the west.
TEST_P(DeadlockAvoidance, AVehicleThatClearsTheAreaBeforeItStopsIsNoPartOfTheCycle) {
    drive_towards("east_0_straight", "north_0_straight", -20.0, 5.0);  // this vehicle leaves the intersection
    place_before("east_1_straight", "north_0_straight");
    drive_towards("south_0_straight", "east_1_straight", 2.0, 1.5);
    EXPECT_EQ(kept_out_area().from_m, conflict("north_0_straight", "east_1_straight").from_m);
    vehicles().length_m[slot_on("south_0_straight")] = 2.0F;
    EXPECT_FALSE(kept_out_area().exists());
    // Another short vehicle follows the first one and must stop further upstream.
    add_follower("south_0_straight", conflict("south_0_straight", "east_1_straight").from_m - 6.5, 1.5);
    EXPECT_TRUE(kept_out_area().exists());
}

// A short vehicle from the north follows another one, which must stop in its path.
TEST_P(DeadlockAvoidance, AVehicleBehindADrivingLeaderStaysOutOfTheCycle) {
    drive_towards("east_0_straight", "north_0_straight", -20.0, 5.0);  // this vehicle leaves the intersection
    place_before("east_1_straight", "north_0_straight");
    drive_towards("south_0_straight", "east_1_straight", 2.0, 1.5);
    vehicles().length_m[slot_on("north_0_straight")] = 1.5F;
    drive_towards("north_0_straight", "west_0_straight", 1.5, 1.0);
    const double to_area_m = conflict("north_0_straight", "east_1_straight").from_m;
    add_follower("north_0_straight", to_area_m - 1.5, 1.0);
    const KeptOutArea area = kept_out_area("north_0_straight", 1);
    EXPECT_EQ(area.from_m, to_area_m);
    EXPECT_EQ(area.crossing_slot, static_cast<int>(slot_on("east_1_straight")));
}

// The vehicles from the north and the south approach at the same speed and distance. If both drove on, they would close
// the cycle together.
TEST_P(DeadlockAvoidance, OfTwoVehiclesThatWouldCloseTheCycleTogetherOneStops) {
    int steps_with_one = 0;
    for (double distance_m = 6.0; distance_m > 0.0; distance_m -= 0.01) {
        drive_towards("north_0_straight", "east_0_straight", distance_m, 3.0);
        drive_towards("south_0_straight", "west_0_straight", distance_m, 3.0);
        const bool north_stops = kept_out_area("north_0_straight").exists();
        const bool south_stops = kept_out_area("south_0_straight").exists();
        EXPECT_FALSE(north_stops && south_stops) << distance_m;
        steps_with_one += north_stops || south_stops ? 1 : 0;
    }
    EXPECT_GT(steps_with_one, 5);
}

}  // namespace
}  // namespace stopline
