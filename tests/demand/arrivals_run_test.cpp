// Runs with arrival times: the same arrivals for all policies, fidelities and threads; exact totals of traffic files;
// paths of an origin-destination matrix; departure delays; conservation of vehicles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/containers/index.h"
#include "demand/demand_scenarios.h"
#include "scenario/demand/plan_arrivals.h"
#include "sim/insertion/insert_vehicles.h"

namespace stopline {
namespace {

std::string grid_text(const std::string& demand, const std::string& lanes =
                                                     "[{movements: straight+left}, "
                                                     "{movements: straight+right}]") {
    return "{fidelity: meso, network: {kind: grid, intersection: {lanes: " + lanes +
           "}, grid: {columns: 3, rows: 2}}, signal: {first_green: 1 s, green: 20 s}, duration: 900 s, "
           "measure: {window: 600 s, departure_delay: on}, populations: [CTG-Ref, CDG], demand: " +
           demand + "}";
}

constexpr const char* kPoisson =
    "{kind: rate, inflow: 700 veh/h, arrivals: poisson, left: 10 %, right: 10 %, profile: [{from: 0 min, inflow: 40 %}, "
    "{from: 5 min, inflow: 100 %}, {from: 10 min, inflow: 0 %}]}";

TEST(Arrivals, AreTheSameForAllPoliciesAndFidelities) {
    const Scenario meso = parse_scenario(grid_text(kPoisson), "test.yaml");
    const Scenario full = parse_scenario(grid_text(kPoisson), "test.yaml", {"fidelity=full"});
    const Model first = build_model(meso, 0);
    std::size_t arrivals = 0;
    for (const auto& [scenario, population] : {std::pair{&meso, 1U}, {&full, 0U}, {&full, 1U}}) {
        const Model other = build_model(*scenario, population);
        ASSERT_EQ(other.demand.inlets.size(), first.demand.inlets.size());
        for (std::size_t k = 0; k < first.demand.inlets.size(); ++k) {
            EXPECT_EQ(other.demand.inlets[k].arrivals_s, first.demand.inlets[k].arrivals_s) << k;
            arrivals += first.demand.inlets[k].arrivals_s.size();
        }
    }
    EXPECT_GT(arrivals, 1000U);
}

// 10 legs with 700 veh/h x (40 % of 300 s + 300 s) = 81.7 vehicles each.
TEST(Arrivals, HaveTheRateOfTheProfile) {
    const Model model = build_model(parse_scenario(grid_text(kPoisson), "test.yaml"), 0);
    double early = 0.0;
    double late = 0.0;
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        for (const double time_s : inlet.arrivals_s) {
            EXPECT_LT(time_s, 600.0);
            (time_s < 300.0 ? early : late) += 1.0;
        }
    }
    EXPECT_NEAR(early, 233.3, 4.0 * std::sqrt(233.3));
    EXPECT_NEAR(late, 583.3, 4.0 * std::sqrt(583.3));
}

TEST(Arrivals, ScaleWithDemandScale) {
    const Scenario scenario =
        parse_scenario(grid_text(kPoisson), "test.yaml", {"demand.arrivals=even", "demand.scale=50 %"});
    std::size_t arrivals = 0;
    for (const DemandPlan::Inlet& inlet : build_model(scenario, 0).demand.inlets) arrivals += inlet.arrivals_s.size();
    EXPECT_NEAR(static_cast<double>(arrivals), 408.3, 20.0);  // each of the 20 lanes rounds
}

TEST(Arrivals, GiveTheSameBitsForAnyNumberOfThreads) {
    const Model model = build_model(parse_scenario(grid_text(kPoisson), "test.yaml"), 0);
    Simulation one(model, 1);
    Simulation three(model, 3);
    one.run_until(400.0);
    three.run_until(400.0);
    EXPECT_GT(one.state().records.entered, 100);
    EXPECT_EQ(one.state_hash(), three.state_hash());
}

// A queue stands at a red signal. Vehicles that arrive far upstream of its end enter at their entry speed.
TEST(Arrivals, EnterAtTheirEntrySpeedUpstreamOfAQueue) {
    constexpr double kFreeRoad_m = 80.0;
    for (const std::string fidelity : {"meso", "full"}) {
        for (const std::string policy : {"CTG-Ref", "CDG"}) {
            const Scenario scenario = parse_scenario(
                "{network: {approach: {length: 200 m}}, signal: {first_green: 900 s, green: 20 s}, duration: 950 s, "
                "demand: {kind: rate, inflow: 150 veh/h, entry_speed: 50 km/h}}",
                "test.yaml", {"fidelity=" + fidelity, "populations=[" + policy + "]"});
            const Model model = build_model(scenario, 0);
            Simulation simulation(model);
            const State& state = simulation.state();
            int far_upstream = 0;
            int near_queue = 0;
            while (model.time_s(state.tick) < 850.0) {
                const auto entered = state.records.entered;
                simulation.step();
                const LaneBlock& block = state.blocks[0];
                if (state.records.entered == entered || block.count < 2) continue;
                const std::size_t last = at(block.last());
                const double rear_m = state.vehicles.position_m[last - 1] - state.vehicles.length_m[last - 1];
                if (state.vehicles.speed_mps[last - 1] > 0.1) continue;
                ++(rear_m > kFreeRoad_m ? far_upstream : near_queue);
                const double short_of_mps = 50.0 / 3.6 - state.vehicles.speed_mps[last];
                EXPECT_TRUE(rear_m < kFreeRoad_m || short_of_mps < 0.5) << short_of_mps;
                EXPECT_TRUE(rear_m > 0.25 * kFreeRoad_m || short_of_mps > 0.5) << short_of_mps;
            }
            EXPECT_GT(far_upstream, 10) << fidelity << ", " << policy;
            EXPECT_GT(near_queue, 2) << fidelity << ", " << policy;
            EXPECT_TRUE(state.records.violations.none()) << fidelity << ", " << policy;
        }
    }
}

// Vehicles are conserved: all that arrived have entered or wait, and all that entered have left or are present.
TEST(Arrivals, AreConserved) {
    for (const char* const arrivals : {"even", "poisson", "platooned"}) {
        const Scenario scenario = parse_scenario(
            grid_text(kPoisson), "test.yaml",
            {std::string("demand.arrivals=") + arrivals, "demand.inflow=3000 veh/h", "signal.green=10 s"});
        const Model model = build_model(scenario, 0);
        Simulation simulation(model);
        simulation.run_until(500.0);
        const State& state = simulation.state();
        std::int64_t arrived = 0;
        for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
            arrived +=
                std::upper_bound(inlet.arrivals_s.begin(), inlet.arrivals_s.end(), 500.0) - inlet.arrivals_s.begin();
        }
        const std::int64_t backlog = insertion_backlog(model, state);
        EXPECT_GT(backlog, 50) << "no vehicle waits";
        EXPECT_EQ(arrived, state.records.entered + backlog);
        EXPECT_EQ(departure_delays(model, state).vehicles, arrived);
        EXPECT_EQ(state.records.entered, state.records.exited + state.present());
        EXPECT_EQ(state.records.violations.lost_vehicles, 0);
    }
}

// The light is red, so the lane fills and later vehicles wait until the end. Vehicle k arrives at (k + offset) x 10 s.
// The vehicles that enter find room at once.
TEST(DepartureDelay, OfABlockedApproachIsTheTimeSinceTheArrival) {
    for (const std::string arrivals : {"demand.profile=[]", "demand.profile=[{from: 0 min, inflow: 100 %}]"}) {
        const Scenario scenario = parse_scenario(
            "{fidelity: meso, network: {approach: {length: 120 m}}, signal: {first_green: 600 s, green: 20 s}, duration: "
            "700 s, populations: [CTG-Ref], demand: {kind: rate, inflow: 360 veh/h}}",
            "test.yaml", {arrivals});
        const Model model = build_model(scenario, 0);
        Simulation simulation(model);
        constexpr double kEnd_s = 500.0;
        simulation.run_until(kEnd_s);
        const auto entered = static_cast<double>(simulation.state().records.entered);
        const DepartureDelays delays = departure_delays(model, simulation.state());
        ASSERT_GT(entered, 5.0);
        ASSERT_EQ(delays.vehicles, 50);
        EXPECT_EQ(insertion_backlog(model, simulation.state()), 50 - delays.vehicles + 50 - static_cast<int>(entered));
        // The longest delay belongs to the first vehicle that waits. It tells the offset of the arrivals.
        const double offset = (kEnd_s - delays.max_s) / 10.0 - entered;
        EXPECT_GE(offset, 0.0);
        EXPECT_LT(offset, 1.0);
        double sum_s = 0.0;
        for (int k = static_cast<int>(entered); k < 50; ++k) sum_s += kEnd_s - 10.0 * (k + offset);
        const double step_s = model.step_s;
        EXPECT_NEAR(delays.sum_s, sum_s, entered * step_s);
        EXPECT_NEAR(delays.mean_s(), sum_s / 50.0, step_s);
    }
}

constexpr const char* kCounts =
    "begin,end,approach,vehicles,left,straight,right\n"
    "0,120,c0r0_west,40,5,30,5\n"
    "120,300,c0r0_west,31,0,20,11\n"
    "0,120,c2r1_north,0,0,0,0\n"
    "120,300,c2r1_north,25,25,0,0\n";

TEST(Counts, GiveExactTotalsOfIntervalsAndTurns) {
    const TrafficFile file(kCounts);
    for (const char* const arrivals : {"even", "poisson", "platooned"}) {
        const Scenario scenario =
            file.scenario(grid_text("{kind: counts, counts: traffic.csv, arrivals: " + std::string(arrivals) + "}"));
        const Model model = build_model(scenario, 0);
        std::map<std::pair<std::string, int>, std::map<Turn, int>> turns;  // [leg, interval][turn]
        for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
            ASSERT_EQ(inlet.paths.size(), inlet.arrivals_s.size());
            EXPECT_TRUE(std::is_sorted(inlet.arrivals_s.begin(), inlet.arrivals_s.end()));
            for (std::size_t k = 0; k < inlet.arrivals_s.size(); ++k) {
                const int route = model.demand.path_routes[static_cast<std::size_t>(inlet.paths[k])];
                const std::vector<int>& lanes = model.graph.routes[static_cast<std::size_t>(route)].lanes;
                EXPECT_EQ(lanes[0], inlet.lane);
                const int interval = inlet.arrivals_s[k] < 120.0 ? 0 : 1;
                const std::string leg = leg_name(model.graph.lanes[static_cast<std::size_t>(inlet.lane)].name);
                ++turns[{leg, interval}][model.graph.lanes[static_cast<std::size_t>(lanes[1])].turn];
            }
        }
        EXPECT_EQ(turns.size(), 3U);
        EXPECT_EQ((turns[{"c0r0_west", 0}]),
                  (std::map<Turn, int>{{Turn::left, 5}, {Turn::straight, 30}, {Turn::right, 5}}));
        EXPECT_EQ((turns[{"c0r0_west", 1}]), (std::map<Turn, int>{{Turn::straight, 20}, {Turn::right, 11}}));
        EXPECT_EQ((turns[{"c2r1_north", 1}]), (std::map<Turn, int>{{Turn::left, 25}}));
    }
}

// At a single intersection the vehicles leave where their turns lead.
TEST(Counts, AreDrivenInBothFidelities) {
    const TrafficFile file(
        "begin,end,approach,vehicles,left,straight,right\n0,200,west,34,4,20,10\n0,200,south,9,9,0,0\n");
    for (const char* const fidelity : {"meso", "full"}) {
        const Scenario scenario = file.scenario(
            "{network: {kind: intersection}, signal: {first_green: 1 s, green: 20 s}, populations: [CTG-Ref], duration: "
            "600 s, demand: {kind: counts, counts: traffic.csv, arrivals: poisson}, step: 20 ms}",
            {std::string("fidelity=") + fidelity});
        const Model model = build_model(scenario, 0);
        Simulation simulation(model);
        simulation.run_until(500.0);
        ASSERT_EQ(simulation.state().present(), 0);
        const std::map<std::pair<std::string, std::string>, std::int64_t> expected{
            {{"west", "north"}, 4}, {{"west", "east"}, 20}, {{"west", "south"}, 10}, {{"south", "west"}, 9}};
        EXPECT_EQ(trips_by_legs(model, simulation.state()), expected);
    }
}

TEST(Counts, CarryRoundedVehiclesOverToTheNextInterval) {
    const TrafficFile file(
        "begin,end,approach,vehicles\n0,60,c0r0_west,1\n60,120,c0r0_west,1\n120,180,c0r0_west,1\n"
        "180,240,c0r0_west,1\n");
    const Scenario scenario = file.scenario(grid_text("{kind: counts, counts: traffic.csv, scale: 150 %}"));
    std::vector<double> times_s;
    for (const DemandPlan::Inlet& inlet : build_model(scenario, 0).demand.inlets) {
        times_s.insert(times_s.end(), inlet.arrivals_s.begin(), inlet.arrivals_s.end());
    }
    EXPECT_EQ(times_s.size(), 6U);
}

// The matrix names all pairs of legs of a grid whose lanes each allow several turns, so vehicles must change lanes.
TEST(Matrix, BringsAllVehiclesToTheirDestinations) {
    const Scenario plain = parse_scenario(grid_text("{kind: saturated}"), "test.yaml");
    LaneGraph graph = build_model(plain, 0).graph;
    add_approaches(graph);
    std::string text = "begin,end,origin,destination,vehicles\n";
    std::map<std::pair<std::string, std::string>, std::int64_t> expected;
    for (const std::string& origin : entry_legs(graph)) {
        for (const std::string& destination : exit_legs(graph)) {
            if (origin == destination) continue;
            const auto vehicles = static_cast<std::int64_t>((expected.size() % 3) + 1);
            expected[{origin, destination}] = vehicles;
            text += "0,600," + origin + "," + destination + "," + std::to_string(vehicles) + "\n";
        }
    }
    ASSERT_EQ(expected.size(), 90U);
    const TrafficFile file(text);
    for (const char* const fidelity : {"meso", "full"}) {
        const Scenario scenario = file.scenario(grid_text("{kind: od, od: traffic.csv, arrivals: poisson}"),
                                                {std::string("fidelity=") + fidelity, "step=20 ms"});
        const Model model = build_model(scenario, 0);
        Simulation simulation(model);
        simulation.run_until(1500.0);
        ASSERT_EQ(simulation.state().present(), 0) << fidelity;
        EXPECT_TRUE(simulation.state().records.violations.none());
        EXPECT_EQ(trips_by_legs(model, simulation.state()), expected) << fidelity;
    }
}

// An independent search: the free-flow time of the fastest way with at most `depth` intersections.
double fastest_s(const LaneGraph& graph, int approach, const std::string& leg, int depth) {
    double best_s = 1e9;
    for (const Route& route : graph.routes) {
        const auto lane = [&](std::size_t k) { return graph.lanes[static_cast<std::size_t>(route.lanes[k])]; };
        if (lane(0).approach != approach || depth == 0) continue;
        double time_s = 0.0;
        for (std::size_t k = 0; k + 1 < route.lanes.size(); ++k) time_s += lane(k).length_m / lane(k).limit_mps;
        const Lane last = lane(route.lanes.size() - 1);
        if (last.approach >= 0) {
            best_s = std::min(best_s, time_s + fastest_s(graph, last.approach, leg, depth - 1));
        } else if (leg_name(last.name) == leg) {
            best_s = std::min(best_s, time_s + last.length_m / last.limit_mps);
        }
    }
    return best_s;
}

TEST(Matrix, TakesTheFastestWays) {
    LaneGraph graph = build_model(parse_scenario(grid_text("{kind: saturated}"), "test.yaml"), 0).graph;
    add_approaches(graph);
    int pairs = 0;
    for (const std::string& origin : entry_legs(graph)) {
        const auto entry = std::find_if(graph.entries.begin(), graph.entries.end(), [&](int lane) {
            return leg_name(graph.lanes[static_cast<std::size_t>(lane)].name) == origin;
        });
        const int approach = graph.lanes[static_cast<std::size_t>(*entry)].approach;
        const ShortestPaths paths(graph, approach);
        for (const std::string& destination : exit_legs(graph)) {
            if (origin == destination) continue;
            const auto path = paths.to(destination);
            ASSERT_TRUE(path) << origin << " " << destination;
            EXPECT_NEAR(path->time_s, fastest_s(graph, approach, destination, 5), 1e-9) << origin << " " << destination;
            ++pairs;
        }
    }
    EXPECT_EQ(pairs, 90);
}

}  // namespace
}  // namespace stopline
