// The causes of delay that the delay watch finds for whole queues, in a run with gridlocks.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"
#include "sim/congestion/delay_causes.h"
#include "sim/state/queries/stopped_vehicles.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

// Follows the rule for single vehicles: a stopped vehicle has the cause that stops it itself. It has the cause of its
// blocker if nothing else stops it, or if its blocker is blocked by a gridlock.
class CausesOfVehicles {
public:
    explicit CausesOfVehicles(const State& state) {
        for_each_stopped_vehicle(state, [&](const StoppedVehicle& stopped) { stopped_[stopped.vehicle] = stopped; });
        for (const auto& [id, stopped] : stopped_) find_cause(id);
    }
    const std::map<int, StoppedVehicle>& stopped() const { return stopped_; }
    DelayCause cause(int vehicle) const { return causes_.at(vehicle); }

private:
    // Returns the cause of a vehicle; none: the vehicle moves, or there is no such vehicle.
    DelayCause find_cause(int vehicle) {
        const auto stopped = stopped_.find(vehicle);
        if (stopped == stopped_.end()) return DelayCause::none;
        if (causes_.contains(vehicle)) return causes_[vehicle];
        if (is_in_ring(vehicle)) return causes_[vehicle] = DelayCause::gridlock;
        const DelayCause ahead = find_cause(stopped->second.waits_for);
        const bool inherits = stopped->second.direct_cause == DelayCause::none || ahead == DelayCause::gridlock;
        const DelayCause cause = inherits ? ahead : stopped->second.direct_cause;
        return causes_[vehicle] = cause == DelayCause::none ? DelayCause::queue_discharge : cause;
    }

    bool is_in_ring(int vehicle) const {
        std::set<int> visited;
        int ahead = vehicle;
        while (visited.insert(ahead).second) {
            const auto stopped = stopped_.find(ahead);
            if (stopped == stopped_.end()) return false;
            ahead = stopped->second.waits_for;
        }
        return ahead == vehicle;
    }

    std::map<int, StoppedVehicle> stopped_;  // by vehicle id
    std::map<int, DelayCause> causes_;       // by vehicle id
};

// The delay watch finds the causes of whole queues. They must agree with the rule for single vehicles.
TEST(QueueCauses, AgreeWithTheRuleForSingleVehicles) {
    // Without the keep-clear rule, queues block intersections, and gridlocks form.
    const Scenario scenario =
        load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                      {"network.grid.columns=3", "network.grid.rows=3", "rules.keep_clear=off", "demand.left=25 %"});
    const Model model = network_model(scenario, 2);
    Simulation simulation(model);
    std::map<DelayCause, int> observed;
    std::set<int> gridlocked;
    while (simulation.time_s() < 600.0) {
        const State& state = simulation.state();
        const bool is_due = delay_watch_is_due(model, state);
        simulation.step();
        if (!is_due) continue;
        const CausesOfVehicles expected(state);
        for (const auto& [id, stopped] : expected.stopped()) {
            ASSERT_EQ(stopped.cause, expected.cause(id)) << "vehicle " << id << " at " << simulation.time_s() << " s";
            ++observed[stopped.cause];
            if (stopped.cause == DelayCause::gridlock) gridlocked.insert(id);
        }
    }
    bool ring_contains_queue = false;  // true: some gridlock contains several vehicles of one lane
    for (const Gridlock& gridlock : simulation.state().congestion.delays.gridlocks) {
        const std::set<int> lanes(gridlock.lanes.begin(), gridlock.lanes.end());
        ring_contains_queue = ring_contains_queue || lanes.size() < gridlock.lanes.size();
        for (const int id : gridlock.vehicles) EXPECT_TRUE(gridlocked.contains(id)) << id;
    }
    EXPECT_TRUE(ring_contains_queue);
    EXPECT_GT(observed[DelayCause::junction_blocking], 0);
    EXPECT_GT(observed[DelayCause::gridlock], 0);
}

}  // namespace
}  // namespace stopline
