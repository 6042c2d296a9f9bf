// Counts of conflicts and overlaps, and the longest time inside a junction. The tests place vehicles by hand and run
// those phases of a step that count conflicts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/containers/index.h"
#include "sim/junction/occupants.h"
#include "sim/junction/right_of_way.h"
#include "sim/step/occupied_lanes.h"
#include "sim/step/partition_reports.h"
#include "support/track.h"

namespace stopline {
namespace {

using testing_support::Track;

// The reference intersection without vehicles.
class ConflictCount : public testing::Test {
protected:
    ConflictCount() : track_(empty_model()) { track_.mutable_state().tick = 1000; }

    static Model empty_model() {
        Model model = build_model(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml"), 0);
        for (DemandPlan::Inlet& inlet : model.demand.inlets) inlet.vehicles = 0;
        return model;
    }

    const LaneGraph& graph() const { return track_.model().graph; }

    int lane(const std::string& name) const {
        const auto named = [&](const Lane& lane) { return lane.name == name; };
        return static_cast<int>(std::find_if(graph().lanes.begin(), graph().lanes.end(), named) -
                                graph().lanes.begin());
    }

    Conflict conflict(const std::string& one, const std::string& two) const {
        for (const Conflict& c : graph().conflicts_of(lane(one))) {
            if (c.other == lane(two)) return c;
        }
        ADD_FAILURE() << one << " and " << two << " have no conflict";
        return {};
    }

    // Places a stopped vehicle with its front at `front_m` along a connection. A negative position is on the approach.
    // A position beyond the end is on the exit lane. The vehicle passed the stop line `ticks_inside` ticks ago.
    void place(const std::string& connection, double front_m, int ticks_inside = 0) {
        const int number = lane(connection);
        const Lane& road = graph().lanes[at(number)];
        const double origin_m = graph().lanes[at(road.origin)].length_m;
        const int on = front_m < 0.0 ? road.origin : front_m < road.length_m ? number : road.next[0];
        const double from_m = on == road.origin ? -origin_m : on == number ? 0.0 : road.length_m;
        track_.place(on, front_m - from_m, 0.0);
        State& state = track_.mutable_state();
        const std::size_t slot = at(state.blocks[at(on)].last());
        state.vehicles.next_lane[slot] = on == road.origin ? number : -1;
        state.vehicles.record[slot].previous_lane = number;
        state.vehicles.record[slot].junction_entry_tick = static_cast<int>(state.tick) - ticks_inside;
    }

    // Runs those phases of a step that count conflicts. Returns the number of new conflicts.
    std::int64_t new_conflicts() {
        const std::int64_t before = track_.state().records.violations.conflicts;
        State& state = track_.mutable_state();
        find_occupied_lanes(state, state.queues, state.partitions[0]);
        find_junction_occupants(state, state.junctions, state.partitions[0]);
        decide_right_of_way(track_.model(), state, state.partitions[0]);
        merge_partition_reports(state);
        return state.records.violations.conflicts - before;
    }

    double length_m() const { return track_.model().vehicles[0].length_m; }

    Track track_;
};

TEST_F(ConflictCount, CountsAPairOncePerStep) {
    const Conflict c = conflict("west_0_straight", "south_0_straight");
    place("west_0_straight", c.from_m + 0.1);
    EXPECT_EQ(new_conflicts(), 0) << "one vehicle alone";
    place("south_0_straight", c.other_from_m + 0.1);
    EXPECT_EQ(new_conflicts(), 1);
    EXPECT_EQ(new_conflicts(), 1) << "the next step";
    EXPECT_FALSE(track_.state().records.violations.none());
}

TEST_F(ConflictCount, RecordsTheFirstViolation) {
    const Conflict c = conflict("west_0_straight", "south_0_straight");
    place("west_0_straight", c.from_m + 0.1);
    place("south_0_straight", c.other_from_m + 0.1);
    EXPECT_LT(track_.state().records.violations.first.time_s, 0.0);
    new_conflicts();
    const Violation first = track_.state().records.violations.first;
    EXPECT_EQ(first.kind, Violation::Kind::conflict);
    EXPECT_DOUBLE_EQ(first.time_s, track_.model().time_s(1000));
    EXPECT_EQ(first.lane, std::min(lane("west_0_straight"), lane("south_0_straight")));
    EXPECT_EQ(std::minmax(first.vehicle, first.other), std::minmax(0, 1));
    ++track_.mutable_state().tick;
    new_conflicts();
    EXPECT_DOUBLE_EQ(track_.state().records.violations.first.time_s, first.time_s)
        << "a later conflict replaced the first";
}

// The follower overlaps its leader by half a metre.
TEST(Overlap, IsRecordedOnItsLane) {
    for (const bool meso : {false, true}) {
        const std::string fidelity = meso ? "fidelity=meso" : "fidelity=full";
        Model model = build_model(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml", {fidelity}), 0);
        for (DemandPlan::Inlet& inlet : model.demand.inlets) inlet.vehicles = 0;
        Track track(std::move(model));
        const int lane = track.model().graph.entries[2];
        track.place(lane, 60.0, 0.0);
        track.place(lane, 60.5 - track.model().vehicles[0].length_m, 0.0);
        track.simulation().step();
        const Violation first = track.state().records.violations.first;
        EXPECT_GT(track.state().records.violations.overlaps, 0) << meso;
        EXPECT_EQ(first.kind, Violation::Kind::overlap) << meso;
        EXPECT_DOUBLE_EQ(first.time_s, track.model().step_s) << meso;
        EXPECT_EQ(first.lane, lane) << meso;
        EXPECT_EQ(first.vehicle, 1) << meso;
        EXPECT_EQ(first.other, 0) << meso;
    }
}

TEST_F(ConflictCount, CountsFromFrontInToRearOut) {
    const Conflict c = conflict("west_0_straight", "south_0_straight");
    place("west_0_straight", c.to_m + length_m() - 0.1);
    place("south_0_straight", c.other_from_m + 0.1);
    EXPECT_EQ(new_conflicts(), 1) << "its rear is still in the area";
    VehicleArrays& v = track_.mutable_state().vehicles;
    const std::size_t south = track_.slot(lane("south_0_straight"), 0);
    const std::size_t west = track_.slot(lane("west_0_straight"), 0);
    v.position_m[south] = c.other_from_m - 0.1;
    EXPECT_EQ(new_conflicts(), 0) << "its front is not in the area yet";
    v.position_m[south] = c.other_from_m + 0.1;
    v.position_m[west] = c.to_m + length_m() + 0.1;
    EXPECT_EQ(new_conflicts(), 0) << "its rear has left the area";
}

TEST_F(ConflictCount, CountsEveryPair) {
    const Conflict c = conflict("west_0_straight", "south_0_straight");
    place("west_0_straight", c.to_m + length_m() - 0.1);
    place("west_0_straight", c.to_m - 0.4);
    place("south_0_straight", c.other_from_m + 0.1);
    EXPECT_EQ(new_conflicts(), 2);
}

TEST_F(ConflictCount, IncludesVehiclesThatReachBackFromTheExitLane) {
    // The connections merge, so their conflict area reaches to their ends. The first vehicle has its front on the exit
    // lane and its rear still in this area.
    const Conflict c = conflict("west_1_right", "north_1_straight");
    place("west_1_right", graph().lanes[at(lane("west_1_right"))].length_m + 1.0);
    ASSERT_EQ(track_.count(lane("west_1_right")), 0);
    place("north_1_straight", c.other_from_m + 0.5);
    EXPECT_EQ(new_conflicts(), 1);
}

TEST_F(ConflictCount, IsZeroForConnectionsWithoutConflict) {
    for (const char* name : {"west_0_left", "east_0_left", "west_1_straight", "east_1_straight"}) place(name, 0.5);
    EXPECT_EQ(new_conflicts(), 0);
}

TEST_F(ConflictCount, LongestTimeInJunctionIsAMaximumOverFirstVehicles) {
    place("west_0_straight", 20.0, 120);
    place("west_0_straight", -0.5, 40);  // past the stop line, on the stretch that all movements share
    new_conflicts();
    EXPECT_EQ(track_.state().records.longest_in_junction_ticks, 120);
    track_.mutable_state().tick += 30;
    new_conflicts();
    EXPECT_EQ(track_.state().records.longest_in_junction_ticks, 150);
    track_.mutable_state().blocks[at(lane("west_0_straight"))].count =
        0;  // removed; the other vehicle has been inside for 70 ticks
    new_conflicts();
    EXPECT_EQ(track_.state().records.longest_in_junction_ticks, 150);
    track_.mutable_state().tick += 100;
    new_conflicts();
    EXPECT_EQ(track_.state().records.longest_in_junction_ticks, 170);
}

}  // namespace
}  // namespace stopline
