// Avoidance of deadlocks inside an intersection. Three stopped vehicles from three sides are inside. Each of the first
// two is blocked by the next one. A fourth vehicle would close the cycle if it drove on, because it would block the
// third one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "base/containers/index.h"
#include "sim/junction/deadlock_avoidance.h"
#include "sim/junction/occupants.h"
#include "sim/junction/right_of_way.h"
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

    // The area that the vehicle from the north must not enter.
    Conflict entered() const { return conflict("north_0_straight", "east_0_straight"); }

    KeptOutArea kept_out_area() {
        State& state = track_.mutable_state();
        find_occupied_lanes(state, state.queues, state.partitions[0]);
        find_junction_occupants(state, state.junctions, state.partitions[0]);
        const auto slot = static_cast<int>(slot_on("north_0_straight"));
        const double speed_mps = state.vehicles.speed_mps[at(slot)];
        const Candidate candidate{slot, state.vehicles.position_m[at(slot)], true, speed_mps < 1.0};
        return area_to_keep_clear(track_.model(), state, lane("north_0_straight"), candidate);
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
    const YieldStop* const stop = track_.state().junctions.yield_stops[at(lane("north_0_straight"))].find(
        static_cast<int>(slot_on("north_0_straight")));
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

}  // namespace
}  // namespace stopline
