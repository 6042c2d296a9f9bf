// The capacity of a permissive left turn over the opposing flow, against the formula of the Highway Capacity Manual for
// random arrivals:
//
//     s = q exp(-q tc / 3600) / (1 - exp(-q tf / 3600))
//
// tc is the critical gap, tf the follow-up time. Both are measured in the same model with evenly spaced opposing
// vehicles: the critical gap is the shortest headway that a left-turning vehicle uses, and the follow-up time is the
// headway of the queue without opposing vehicles.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "demand/demand_scenarios.h"

namespace stopline {
namespace {

constexpr double kFrom_s = 300.0;

double hcm_veh_h(double opposing_veh_h, double critical_gap_s, double follow_up_s) {
    if (opposing_veh_h == 0.0) return 3600.0 / follow_up_s;
    return opposing_veh_h * std::exp(-opposing_veh_h * critical_gap_s / 3600.0) /
           (1.0 - std::exp(-opposing_veh_h * follow_up_s / 3600.0));
}

// Returns the flow of left-turning vehicles from the west, which always queue. The opposing vehicles go straight on.
double left_veh_h(double opposing_veh_h, const std::string& arrivals, double to_s, std::uint64_t seed) {
    const auto per_run = [&](double veh_h) { return std::to_string(std::lround(veh_h * to_s / 3600.0)); };
    const std::string end = "0," + std::to_string(std::lround(to_s)) + ",";
    const std::string left = per_run(1900.0);
    const std::string opposing = per_run(opposing_veh_h);
    const TrafficFile file("begin,end,approach,vehicles,left,straight,right\n" + end + "west," + left + "," + left +
                           ",0,0\n" + end + "east," + opposing + ",0," + opposing + ",0\n");
    Scenario scenario = file.scenario(
        "{fidelity: meso, network: {kind: intersection, intersection: {lanes: [{movements: left}, {movements: straight}], "
        "approach_length: 300 m}}, signal: {first_green: 1 s, green: 7200 s}, populations: [CTG-Ref], demand: {kind: "
        "counts, counts: traffic.csv, arrivals: " +
        arrivals + "}}");
    scenario.seed = seed;
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    simulation.run_until(to_s);
    EXPECT_TRUE(simulation.state().records.violations.none());
    double turned = 0.0;
    for (const Passage& passage : simulation.state().records.passages) {
        if (passage.from_lane < 0 || passage.time_s < kFrom_s) continue;
        turned += model.graph.lanes[static_cast<std::size_t>(passage.from_lane)].turn == Turn::left ? 1.0 : 0.0;
    }
    return turned * 3600.0 / (to_s - kFrom_s);
}

// Returns the shortest headway of evenly spaced opposing vehicles at which left-turning vehicles pass.
double critical_gap_s() {
    double closed_s = 2.0;
    double open_s = 12.0;
    while (open_s - closed_s > 0.05) {
        const double middle_s = 0.5 * (closed_s + open_s);
        // Where a vehicle passes in each headway, the flow is the opposing flow.
        const bool passes = left_veh_h(3600.0 / middle_s, "even", 1200.0, 1) > 0.5 * 3600.0 / middle_s;
        (passes ? open_s : closed_s) = middle_s;
    }
    return open_s;
}

void compare(const std::vector<double>& opposing_veh_h, double to_s, int seeds) {
    const double follow_up_s = 3600.0 / left_veh_h(0.0, "even", 1800.0, 1);
    const double critical_s = critical_gap_s();
    std::printf("critical gap %.2f s, follow-up time %.2f s\n", critical_s, follow_up_s);
    for (const double opposing : opposing_veh_h) {
        double sum = 0.0;
        double squares = 0.0;
        for (int seed = 1; seed <= seeds; ++seed) {
            const double flow = left_veh_h(opposing, "poisson", to_s, static_cast<std::uint64_t>(seed));
            sum += flow;
            squares += flow * flow;
        }
        const double mean = sum / seeds;
        const double error = std::sqrt(std::max(squares / seeds - mean * mean, 0.0) / (seeds - 1));
        const double expected = hcm_veh_h(opposing, critical_s, follow_up_s);
        std::printf("opposing %.0f veh/h: measured %.0f +- %.0f veh/h, formula %.0f (%+.1f %%), formula with 4.5 s and 2.5 s "
                    "%.0f (%+.1f %%)\n",
                    opposing, mean, error, expected, 100.0 * (mean / expected - 1.0), hcm_veh_h(opposing, 4.5, 2.5),
                    100.0 * (mean / hcm_veh_h(opposing, 4.5, 2.5) - 1.0));
        EXPECT_LT(error, 0.02 * expected) << "too few seeds";
        EXPECT_NEAR(mean, expected, 0.1 * expected) << "opposing flow " << opposing;
    }
}

TEST(PermissiveLeft, HasTheCapacityOfRandomGaps) { compare({200.0, 600.0}, 2100.0, 6); }

TEST(SlowPermissiveLeft, HasTheCapacityOfRandomGaps) {
    compare({0.0, 200.0, 400.0, 600.0, 800.0, 1000.0, 1200.0}, 3900.0, 20);
}

}  // namespace
}  // namespace stopline
