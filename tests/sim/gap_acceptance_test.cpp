// Left turners between vehicles that come from the opposite arm one by one, at chosen times: who goes when, from what is there.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {
namespace {

constexpr double kEnd_s = 400.0;
// Between vehicles with priority as they enter: shorter and longer than the critical gap.
constexpr double kHeadways_s[] = {2.5, 8.0, 3.5, 6.0, 4.5, 10.0, 4.0, 7.0, 5.5, 4.8, 9.0};

struct Arrival {
    double time_s;
    bool awaited;  // a left turner waited throughout the time since the one before
};

struct Oncoming {
    int id;
    double distance_m;  // of the front from the area, negative beyond it
    double speed_mps;
};

// Arms with one lane each: left turners from the west, from the east one other movement.
class GapAcceptance : public testing::TestWithParam<const char*> {
protected:
    GapAcceptance()
        : model_(make_model()), turner_(lane("west_0_left")), other_(lane(std::string("east_0_") + GetParam())) {}

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

    // The inlet of a lane inside; its vehicles shall all go there.
    DemandPlan::Inlet& inlet_to(int inside) {
        auto inlet = model_.demand.inlets.begin();
        while (inlet->lane != model_.graph.lanes[at(inside)].origin) ++inlet;
        std::erase_if(inlet->routes, [&](int route) { return model_.graph.routes[at(route)].lanes[1] != inside; });
        inlet->shares = {1.0};
        return *inlet;
    }

    // The vehicles with priority, from the front.
    std::vector<Oncoming> oncoming(const State& state, double area_m) const {
        std::vector<Oncoming> all;
        const int origin = model_.graph.lanes[at(other_)].origin;
        for (const int on : {other_, origin}) {
            const double to_m = area_m + (on == origin ? model_.graph.lanes[at(origin)].length_m : 0.0);
            const VehicleArrays& v = state.vehicles;
            for (int slot = state.blocks[at(on)].first; slot < state.blocks[at(on)].past_last(); ++slot) {
                all.push_back({v.id[at(slot)], to_m - v.position_m[at(slot)], v.speed_mps[at(slot)]});
            }
        }
        return all;
    }

    // A left turner before the area; that may be on the stretch which its entry lane shares among movements.
    bool waits(const State& state) const {
        return state.junctions.yield_stops[at(turner_)].count > 0 || state.junctions.yield_stops[at(model_.graph.lanes[at(turner_)].origin)].count > 0;
    }

    Model model_;
    int turner_;
    int other_;
};

INSTANTIATE_TEST_SUITE_P(To, GapAcceptance, testing::Values("straight", "right"),
                         [](const auto& movement) { return std::string(movement.param); });

TEST_P(GapAcceptance, TakesTheLongGapsAndRefusesTheShortOnes) {
    double area_m = 1e9;
    for (const Conflict& c : model_.graph.conflicts_of(turner_)) {
        if (c.other == other_) area_m = c.other_from_m;
    }
    ASSERT_LT(area_m, 1e9) << "the paths do not meet";
    const double critical_s = model_.give_way.critical_gap_s;
    inlet_to(turner_).vehicles = 1000;
    std::int64_t& released = inlet_to(other_).vehicles;
    double next_s = 20.0;
    bool awaited = false;
    int last_id = -1;
    std::vector<double> accepted_s;
    int between = 0;                // of these, with a vehicle that comes undisturbed
    std::vector<Arrival> arrivals;  // of vehicles with priority at the area
    Simulation simulation(model_);
    const State& state = simulation.state();
    while (simulation.time_s() < kEnd_s) {
        if (simulation.time_s() >= next_s) next_s += kHeadways_s[at(static_cast<int>(released++)) % 11];
        const std::size_t decided = state.records.gaps_accepted.size();
        const double time_s = simulation.time_s();
        const std::vector<Oncoming> seen = oncoming(state, area_m);
        simulation.step();
        awaited = awaited && waits(state) && state.records.gaps_accepted.size() == decided;
        if (state.records.gaps_accepted.size() > decided) {
            accepted_s.push_back(time_s);
            const auto next = std::find_if(seen.begin(), seen.end(), [](auto& one) { return one.distance_m > 0.0; });
            // One that has braked for the turner before may still gain speed: it says nothing here.
            if (next != seen.end() && next->speed_mps > 0.97 * model_.graph.lanes[at(other_)].limit_mps) {
                EXPECT_GE(next->distance_m / next->speed_mps, critical_s) << "at " << time_s << " s";
                ++between;
            }
        }
        for (const Oncoming& one : seen) {  // ids rise from front to back
            if (one.distance_m > 0.0 || one.id <= last_id) continue;
            last_id = one.id;
            arrivals.push_back({time_s, awaited});
            awaited = true;
        }
    }
    EXPECT_TRUE(state.records.violations.none());
    EXPECT_GE(between, 15);
    for (const double went_s : accepted_s) {
        const auto next = std::find_if(arrivals.begin(), arrivals.end(), [&](auto& a) { return a.time_s > went_s; });
        EXPECT_TRUE(next == arrivals.end() || next->time_s - went_s >= critical_s) << "at " << went_s << " s";
    }
    // A vehicle takes a second to pass the area. Who turns right slows down for it, and so comes later than expected.
    const double late_s = GetParam() == std::string("right") ? 3.0 : 1.5;
    int refused = 0;
    for (std::size_t k = 1; k < arrivals.size(); ++k) {
        if (!arrivals[k].awaited) continue;
        const double gap_s = arrivals[k].time_s - arrivals[k - 1].time_s;
        refused += gap_s < critical_s ? 1 : 0;
        EXPECT_LT(gap_s, critical_s + late_s) << "long enough to go, up to " << arrivals[k].time_s << " s";
    }
    EXPECT_GE(refused, 10);
}

}  // namespace
}  // namespace stopline
