// Gap acceptance of left-turning vehicles. Vehicles with priority enter on the opposite leg one by one at chosen times.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/junction/arrivals.h"
#include "sim/junction/lights/signals.h"
#include "sim/state/lane_blocks.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

constexpr double kEnd_s = 500.0;
// A moving vehicle passes the area sooner than one that starts from rest. It may accept a gap that is shorter by up to
// this time.
constexpr double kHeadStart_s = 0.5;
// Headways between entering vehicles with priority, shorter and longer than the critical gap.
constexpr double kHeadways_s[] = {2.5, 8.0, 3.5, 6.0, 4.5, 10.0, 4.0, 7.0, 5.5, 4.8, 9.0};

struct PriorityArrival {
    double time_s;
    bool awaited;  // a left-turning vehicle has waited since the previous arrival
};

struct OncomingVehicle {
    int id;
    double distance_m;  // from the front to the conflict area; negative beyond its start
    double speed_mps;
};

// Legs with one lane each. Vehicles from the west turn left. Vehicles from the east have priority; the parameter of the
// test names their movement.
class GapAcceptance : public testing::TestWithParam<const char*> {
protected:
    GapAcceptance()
        : model_(make_model()), left_turn_(lane("west_0_left")), priority_(lane(std::string("east_0_") + GetParam())) {}

    static Model make_model() {
        const Scenario scenario =
            load_scenario(STOPLINE_SOURCE_DIR "/scenarios/intersection.yaml",
                          {"network.intersection.lanes=[{movements: straight+left+right}]", "signal.green=1000 s",
                           "demand={kind: queue, start: empty}", "step=20 ms"});
        Model model = build_model(scenario, 0);
        for (DemandPlan::Inlet& inlet : model.demand.inlets) inlet.vehicles = 0;
        return model;
    }

    int lane(const std::string& name) const {
        int k = 0;
        while (model_.graph.lanes.at(at(k)).name != name) ++k;
        return k;
    }

    // Changes the inlet (the entry lane) upstream of a connection, so that all its vehicles take this connection.
    // Returns the inlet.
    DemandPlan::Inlet& inlet_to(int connection) {
        auto inlet = model_.demand.inlets.begin();
        while (inlet->lane != model_.graph.lanes[at(connection)].origin) ++inlet;
        std::erase_if(inlet->routes, [&](int route) { return model_.graph.routes[at(route)].lanes[1] != connection; });
        inlet->shares = {1.0};
        return *inlet;
    }

    // Returns the vehicles with priority, the foremost first.
    std::vector<OncomingVehicle> oncoming_vehicles(const State& state, double area_m) const {
        std::vector<OncomingVehicle> vehicles;
        const int origin = model_.graph.lanes[at(priority_)].origin;
        for (const int lane_index : {priority_, origin}) {
            const double to_m = area_m + (lane_index == origin ? model_.graph.lanes[at(origin)].length_m : 0.0);
            const VehicleArrays& v = state.vehicles;
            for (int slot = state.blocks[at(lane_index)].first; slot < state.blocks[at(lane_index)].past_last();
                 ++slot) {
                vehicles.push_back({v.id[at(slot)], to_m - v.position_m[at(slot)], v.speed_mps[at(slot)]});
            }
        }
        return vehicles;
    }

    // Returns true if a left-turning vehicle waits before the conflict area, on its connection or its approach lane.
    bool has_waiting_vehicle(const State& state) const {
        return yield_stops_of(state, left_turn_).count > 0 ||
               yield_stops_of(state, model_.graph.lanes[at(left_turn_)].origin).count > 0;
    }

    Model model_;
    int left_turn_;
    int priority_;
};

INSTANTIATE_TEST_SUITE_P(Oncoming, GapAcceptance, testing::Values("straight", "right"),
                         [](const auto& movement) { return std::string(movement.param); });

// A vehicle is in the conflict area if its front is beyond the start of the area. Exactly at the start, it arrives now.
TEST_P(GapAcceptance, VehicleAtTheStartOfTheAreaArrivesNow) {
    for (const Conflict& conflict : model_.graph.conflicts_of(left_turn_)) {
        if (conflict.other != priority_) continue;
        State state = make_state(model_, 1);
        start_signals(model_, state);
        const int slot = append_slot(state, priority_);
        state.vehicles.speed_mps[at(slot)] = 9.0;
        const auto arrival_with = [&](double front_m) {
            state.vehicles.position_m[at(slot)] = front_m;
            SparseLists<JunctionOccupant>& occupants = state.partitions[0].occupants;
            occupants.clear(state.junctions.occupants_place);
            occupants.add(priority_, {slot, front_m, front_m - 5.0, 0}, state.junctions.occupants_place);
            return next_arrival(model_, state, conflict, {.horizon_s = 10.0, .acceleration_mps2 = 2.0});
        };
        EXPECT_EQ(arrival_with(conflict.other_from_m).slot, slot);
        EXPECT_EQ(arrival_with(conflict.other_from_m).time_s, 0.0);
        EXPECT_EQ(arrival_with(conflict.other_from_m - 0.1).slot, slot);
        EXPECT_EQ(arrival_with(conflict.other_from_m + 0.1).slot, -1);
    }
}

TEST_P(GapAcceptance, AcceptsLongGapsAndRejectsShortOnes) {
    double area_m = 1e9;
    for (const Conflict& c : model_.graph.conflicts_of(left_turn_)) {
        if (c.other == priority_) area_m = c.other_from_m;
    }
    ASSERT_LT(area_m, 1e9) << "the connections have no conflict";
    const double critical_s = model_.drivers[0].give_way.critical_gap_s;
    inlet_to(left_turn_).vehicles = 1000;
    std::int64_t& released = inlet_to(priority_).vehicles;
    double next_s = 20.0;
    bool awaited = false;
    int last_id = -1;
    std::vector<double> accepted_s;
    // Number of gaps that were accepted before an oncoming vehicle at full speed.
    int checked_gaps = 0;
    std::vector<PriorityArrival> arrivals;  // arrivals of vehicles with priority at the conflict area
    Simulation simulation(model_);
    const State& state = simulation.state();
    while (simulation.time_s() < kEnd_s) {
        if (simulation.time_s() >= next_s) next_s += kHeadways_s[at(static_cast<int>(released++)) % 11];
        const std::size_t accepted_before = state.records.gaps_accepted.size();
        const double time_s = simulation.time_s();
        const std::vector<OncomingVehicle> oncoming = oncoming_vehicles(state, area_m);
        for (const OncomingVehicle& vehicle : oncoming) {  // ids rise from front to rear
            if (vehicle.distance_m > 0.0 || vehicle.id <= last_id) continue;
            last_id = vehicle.id;
            arrivals.push_back({time_s, awaited});
            awaited = true;
        }
        const double last_arrival_s = arrivals.empty() ? -kEnd_s : arrivals.back().time_s;
        simulation.step();
        awaited = awaited && has_waiting_vehicle(state) && state.records.gaps_accepted.size() == accepted_before;
        if (state.records.gaps_accepted.size() > accepted_before) {
            accepted_s.push_back(time_s);
            const auto next =
                std::find_if(oncoming.begin(), oncoming.end(), [](auto& o) { return o.distance_m > 0.0; });
            // The time gap is checked only if the next oncoming vehicle drives at full speed. A vehicle that has braked
            // for the previous left-turning vehicle still accelerates, so it arrives sooner than distance / speed says.
            if (next != oncoming.end() && next->speed_mps > 0.97 * model_.graph.lanes[at(priority_)].limit_mps) {
                EXPECT_GE(time_s + next->distance_m / next->speed_mps - last_arrival_s, critical_s - kHeadStart_s)
                    << "at " << time_s << " s";
                ++checked_gaps;
            }
        }
    }
    EXPECT_TRUE(state.records.violations.none());
    EXPECT_GE(checked_gaps, 15);
    for (const double start_s : accepted_s) {
        const auto next = std::find_if(arrivals.begin(), arrivals.end(), [&](auto& a) { return a.time_s > start_s; });
        if (next == arrivals.begin() || next == arrivals.end()) continue;
        EXPECT_GE(next->time_s - std::prev(next)->time_s, critical_s - kHeadStart_s) << "at " << start_s << " s";
    }
    // If the interval between two arrivals is only slightly longer than the critical gap, a vehicle may reject it. It
    // predicts an early arrival, as if the next vehicle with priority accelerated to the limit. If that vehicle turns
    // right, it brakes and arrives even later.
    const double margin_s = GetParam() == std::string("right") ? 3.0 : 1.5;
    int rejected = 0;
    for (std::size_t k = 1; k < arrivals.size(); ++k) {
        if (!arrivals[k].awaited) continue;
        const double gap_s = arrivals[k].time_s - arrivals[k - 1].time_s;
        rejected += gap_s < critical_s ? 1 : 0;
        EXPECT_LT(gap_s, critical_s + margin_s)
            << "a sufficient gap was not used, up to " << arrivals[k].time_s << " s";
    }
    EXPECT_GE(rejected, 10);
}

// A left-turning vehicle and a vehicle with priority, alone in the network.
struct Encounter {
    bool stops;    // the left-turning vehicle stops
    double lag_s;  // from the arrival at the waiting position to the arrival of the other vehicle at the conflict area;
                   // negative: the left-turning vehicle goes second
};

// A moving vehicle accepts a lag that is at least the critical lag. With the critical gap of 60 s alone, it would never
// turn before the other vehicle.
TEST_P(GapAcceptance, MovingVehicleAcceptsTheCriticalLag) {
    const std::span<const Conflict> conflicts = model_.graph.conflicts_of(left_turn_);
    const auto conflict =
        std::find_if(conflicts.begin(), conflicts.end(), [&](const Conflict& c) { return c.other == priority_; });
    ASSERT_NE(conflict, conflicts.end());
    GiveWaySettings& give_way = model_.drivers[0].give_way;
    const double wait_m = conflict->from_m - give_way.margin_m;
    std::int64_t& left = inlet_to(left_turn_).vehicles;
    std::int64_t& priority = inlet_to(priority_).vehicles;
    // `head_start_s`: time from the entry of the left-turning vehicle to that of the vehicle with priority.
    const auto meet = [&](double head_start_s) {
        left = priority = 0;
        Simulation simulation(model_);
        const State& state = simulation.state();
        Encounter result{false, 0.0};
        double waits_from_s = -1.0;
        double arrives_s = -1.0;
        while (simulation.time_s() < 60.0) {
            if (simulation.time_s() >= 5.0) left = 1;
            if (simulation.time_s() >= 5.0 + head_start_s) priority = 1;
            simulation.step();
            const LaneBlock& path = state.blocks[at(left_turn_)];
            if (path.count > 0 && waits_from_s < 0.0) {
                if (state.vehicles.speed_mps[at(path.first)] < kCrawlingSpeed_mps) result.stops = true;
                if (state.vehicles.position_m[at(path.first)] >= wait_m) waits_from_s = simulation.time_s();
            }
            const LaneBlock& other = state.blocks[at(priority_)];
            if (arrives_s < 0.0 && other.count > 0 &&
                state.vehicles.position_m[at(other.first)] >= conflict->other_from_m)
                arrives_s = simulation.time_s();
        }
        EXPECT_TRUE(state.records.violations.none());
        EXPECT_GE(waits_from_s, 0.0);
        EXPECT_GE(arrives_s, 0.0);
        result.lag_s = arrives_s - waits_from_s;
        return result;
    };
    give_way.critical_gap_s = 60.0;
    std::vector<double> shortest_lags_s;
    for (const double critical_s : {4.5, 6.5}) {
        give_way.critical_lag_s = critical_s;
        double shortest_s = 1e9;
        int yields = 0;
        for (double head_start_s = 0.0; head_start_s <= 14.0; head_start_s += 0.2) {
            const Encounter encounter = meet(head_start_s);
            const bool goes_first = encounter.lag_s > 0.0;
            yields += goes_first ? 0 : 1;
            if (!goes_first) continue;
            EXPECT_FALSE(encounter.stops) << critical_s << " s, head start " << head_start_s << " s";
            shortest_s = std::min(shortest_s, encounter.lag_s);
        }
        EXPECT_GE(yields, 5) << critical_s;
        // The left-turning vehicle arrives at its waiting position later than its driver predicts, because it brakes
        // for the turn.
        constexpr double kOwnDelay_s = 1.2;
        // A right-turning vehicle with priority brakes for its turn and arrives later than predicted.
        const double late_s = GetParam() == std::string("right") ? 3.0 : 1.0;
        EXPECT_GE(shortest_s, critical_s - kOwnDelay_s);
        EXPECT_LE(shortest_s, critical_s + late_s);
        shortest_lags_s.push_back(shortest_s);
    }
    EXPECT_GT(shortest_lags_s[1] - shortest_lags_s[0], 0.8);
}

}  // namespace
}  // namespace stopline
