// The usable distance of a vehicle that prepares a left turn at the intersection after the next one. It is the distance
// to the stop line of this turn, minus the queue on the target lane before the next intersection.
#include <gtest/gtest.h>

#include <string_view>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/lane_change/lane_change.h"
#include "sim/lane_change/route_choice.h"
#include "support/track.h"

namespace stopline {
namespace {

using testing_support::Track;

Model berlin() {
    return build_model(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/berlin.yaml",
                                     {"populations=[CDG]", "measure.baseline=CDG", "demand.start=empty"}),
                       0);
}

int lane_named(const Model& model, std::string_view name) {
    for (std::size_t lane = 0; lane < model.graph.lanes.size(); ++lane) {
        if (model.graph.lanes[lane].name == name) return static_cast<int>(lane);
    }
    ADD_FAILURE() << name;
    return 0;
}

struct UsableDistance : testing::Test {
    Track track{berlin()};
    const Model& model = track.model();
    int before = lane_named(model, "wilmersdorfer_str_east_in_1");
    int left_lane = lane_named(model, "wilmersdorfer_str_east_in_0");
    int left_lane_beyond = lane_named(model, "kaiser_friedrich_str_east_in_0");

    // Places a vehicle that goes straight on at the next intersection and turns left at the one after it.
    UsableDistance() {
        State& state = track.mutable_state();
        track.place(before, 100.0, 10.0);
        const int slot = state.blocks[at(before)].first;
        VehicleRecord& record = state.vehicles.record[at(slot)];
        record.route = state.plan.route_with(model.graph.lanes[at(before)].approach, Turn::straight);
        record.following_turn = Turn::left;
        adopt_lane_route(model, state, before, slot);
        EXPECT_LT(state.vehicles.lane_memory[at(slot)].preferred_offset, 0) << "the vehicle prefers the left lane";
    }

    double usable_m() const {
        const State& state = track.state();
        const int slot = state.blocks[at(before)].first;
        return mandatory_change(model, state, lane_change_request(model, state, before, slot)).usable_m;
    }

    void place_queue(int lane, double first_m) {
        for (int k = 0; k < kQueue; ++k) track.place(lane, first_m - 9.0 * k, 0.0);
    }

    static constexpr int kQueue = 8;
};

TEST_F(UsableDistance, QueueBeyondTheNextIntersectionDoesNotCount) {
    const double free_m = usable_m();
    EXPECT_GT(free_m, track.model().graph.lanes[at(left_lane_beyond)].length_m);
    place_queue(left_lane_beyond, 150.0);
    EXPECT_EQ(usable_m(), free_m);
}

TEST_F(UsableDistance, QueueBeforeTheNextIntersectionCounts) {
    const double free_m = usable_m();
    place_queue(left_lane, 200.0);
    EXPECT_NEAR(free_m - usable_m(), kQueue * track.state().plan.max_space_per_vehicle_m(), 1e-9);
}

}  // namespace
}  // namespace stopline
