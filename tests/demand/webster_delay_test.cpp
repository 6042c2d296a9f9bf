// The delay at a fixed-time signal with Poisson arrivals, against Webster's formula (1958). Saturation flow, capacity
// and free-flow time are measured in the same model. q is the flow in vehicles per second.
//
//     d = d1 + X^2 / (2 q (1 - X)) - 0.65 (C / q^2)^(1/3) X^(2 + 5 g/C)
//     d1 = 0.5 C (1 - g/C)^2 / (1 - min(1, X) g/C)
//
// Webster's formula holds for steady traffic. Near the capacity an hour does not suffice for that. There the random
// delay d2 of the Highway Capacity Manual, which depends on the time T, takes the place of its last two terms.
//
//     d2 = 900 T [(X - 1) + sqrt((X - 1)^2 + 8 k I X / (c T))],   k = 0.5, I = 1, T in hours, c in vehicles per hour
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "demand/demand_scenarios.h"

namespace stopline {
namespace {

constexpr double kCycle_s = 60.0;
constexpr double kHours = 1.0;  // T: the time in which vehicles arrive
constexpr double kArrivals_s = 3600.0 * kHours;
constexpr double kTolerance = 0.05;
constexpr double kSteadyDegree = 0.92;  // highest degree of saturation with steady traffic
constexpr double kTimeTolerance = 0.10;

// The longest queues fit on the approach. Behind the stop line the exit is long enough for all vehicles to reach the
// speed limit, so that the delay includes their acceleration.
Scenario light(const std::string& demand, const std::string& signal) {
    return parse_scenario(
        "{fidelity: meso, meso: {base: table2, leader_speed_share: 100 %}, network: {approach: {length: 1500 m, exit_length: 700 m}}, signal: " +
            signal + ", duration: 10000 s, populations: [CTG-Ref], demand: " + demand + "}",
        "light.yaml");
}

const std::string kSignal = "{first_green: 27 s, green: 30 s, yellow: 3 s, cycle: 60 s}";

// Returns the times at which vehicles pass from the approach to the exit, or leave the network.
std::vector<double> passages_s(const Model& model, const State& state, bool leaving) {
    std::vector<double> times_s;
    for (const Passage& passage : state.records.passages) {
        if (passage.from_lane < 0 || (passage.to_lane < 0) != leaving) continue;
        if (!leaving && model.graph.lanes[static_cast<std::size_t>(passage.from_lane)].signal_group < 0) continue;
        times_s.push_back(passage.time_s);
    }
    std::sort(times_s.begin(), times_s.end());
    return times_s;
}

struct LightCapacity {
    double saturation_1ps = 0.0;
    double capacity_1ps = 0.0;
    double free_s = 0.0;  // time from the entry to the end of the exit without signal

    double effective_green_share() const { return capacity_1ps / saturation_1ps; }
    double d1_s(double degree) const {
        const double share = effective_green_share();
        return 0.5 * kCycle_s * (1.0 - share) * (1.0 - share) / (1.0 - std::min(degree, 1.0) * share);
    }
    double d2_s(double degree) const {
        const double excess = degree - 1.0;
        const double capacity_veh_h = 3600.0 * capacity_1ps;
        return 900.0 * kHours * (excess + std::sqrt(excess * excess + 4.0 * degree / (capacity_veh_h * kHours)));
    }
};

double webster_s(const LightCapacity& light, double degree) {
    const double flow_1ps = degree * light.capacity_1ps;
    const double exponent = 2.0 + 5.0 * light.effective_green_share();
    return light.d1_s(degree) + degree * degree / (2.0 * flow_1ps * (1.0 - degree)) -
           0.65 * std::cbrt(kCycle_s / (flow_1ps * flow_1ps)) * std::pow(degree, exponent);
}

// Measures the capacity of the light with a queue that never ends, its saturation flow from the fifth vehicle of a long
// green on, and the free-flow time of vehicles at green.
LightCapacity measured_capacity() {
    LightCapacity measured;
    {
        const Model model = build_model(light("{kind: saturated, start: queued}", kSignal), 0);
        Simulation simulation(model);
        constexpr int kFirst = 5;
        constexpr int kCycles = 40;
        const double from_s = 27.0 + kFirst * kCycle_s;
        simulation.run_until(from_s + kCycles * kCycle_s);
        const std::vector<double> times_s = passages_s(model, simulation.state(), false);
        const auto passed = times_s.end() - std::lower_bound(times_s.begin(), times_s.end(), from_s);
        measured.capacity_1ps = static_cast<double>(passed) / (kCycles * kCycle_s);
    }
    {
        const Model model =
            build_model(light("{kind: saturated, start: queued}", "{first_green: 27 s, green: 90 s, cycle: 0 s}"), 0);
        Simulation simulation(model);
        simulation.run_until(27.0 + 90.0);
        const std::vector<double> times_s = passages_s(model, simulation.state(), false);
        measured.saturation_1ps = static_cast<double>(times_s.size() - 4) / (times_s.back() - times_s[3]);
    }
    const Model model = build_model(light("{kind: rate, inflow: 60 veh/h, profile: [{from: 0 min, inflow: 100 %}]}",
                                          "{first_green: 1 s, green: 7000 s, cycle: 0 s}"),
                                    0);
    Simulation simulation(model);
    simulation.run_until(1800.0);
    const std::vector<double> left_s = passages_s(model, simulation.state(), true);
    double sum_s = 0.0;
    for (std::size_t k = 0; k < left_s.size(); ++k) sum_s += left_s[k] - model.demand.inlets[0].arrivals_s[k];
    measured.free_s = sum_s / static_cast<double>(left_s.size());
    return measured;
}

// Returns the mean delay of all vehicles that arrive within an hour, from their arrival to the end of the exit. The run
// goes on until all of them have left.
double delay_s(const LightCapacity& capacity, double degree, std::uint64_t seed) {
    Scenario scenario =
        light("{kind: rate, inflow: " + std::to_string(3600.0 * degree * capacity.capacity_1ps) +
                  " veh/h, arrivals: poisson, profile: [{from: 0 min, inflow: 100 %}, {from: 60 min, inflow: 0 %}]}",
              kSignal);
    scenario.seed = seed;
    const Model model = build_model(scenario, 0);
    Simulation simulation(model);
    simulation.run_until(kArrivals_s + 300.0);
    while (simulation.state().present() > 0) simulation.step();
    const std::vector<double> left_s = passages_s(model, simulation.state(), true);
    const std::vector<double>& arrivals_s = model.demand.inlets[0].arrivals_s;
    EXPECT_EQ(left_s.size(), arrivals_s.size());
    double sum_s = 0.0;
    for (std::size_t k = 0; k < left_s.size(); ++k) sum_s += left_s[k] - arrivals_s[k] - capacity.free_s;
    return sum_s / static_cast<double>(left_s.size());
}

void compare(const std::vector<double>& degrees, int seeds) {
    const LightCapacity capacity = measured_capacity();
    std::printf("saturation flow %.0f veh/h, capacity %.0f veh/h, effective green %.1f s of %.0f s, free flow %.1f s\n",
                3600.0 * capacity.saturation_1ps, 3600.0 * capacity.capacity_1ps,
                kCycle_s * capacity.effective_green_share(), kCycle_s, capacity.free_s);
    for (const double degree : degrees) {
        double sum_s = 0.0;
        double squares = 0.0;
        for (int seed = 1; seed <= seeds; ++seed) {
            const double delay = delay_s(capacity, degree, static_cast<std::uint64_t>(seed));
            sum_s += delay;
            squares += delay * delay;
        }
        const double mean_s = sum_s / seeds;
        const double error_s = std::sqrt((squares / seeds - mean_s * mean_s) / (seeds - 1));
        const bool is_steady = degree <= kSteadyDegree;
        const double manual_s = capacity.d1_s(degree) + capacity.d2_s(degree);
        const double expected_s = is_steady ? webster_s(capacity, degree) : manual_s;
        const double tolerance_s = (is_steady ? kTolerance : kTimeTolerance) * expected_s;
        std::printf("X %.2f: expected %.2f s (d1 + d2: %.2f s), measured %.2f +- %.2f s (%+.1f %%)\n", degree,
                    expected_s, manual_s, mean_s, error_s, 100.0 * (mean_s / expected_s - 1.0));
        EXPECT_LT(error_s, 0.02 * expected_s) << "too few seeds";
        EXPECT_NEAR(mean_s, expected_s, tolerance_s) << "degree of saturation " << degree;
    }
}

TEST(WebsterDelay, HoldsForPoissonArrivals) { compare({0.4, 0.6}, 12); }

TEST(SlowWebsterDelay, HoldsForPoissonArrivals) { compare({0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95}, 400); }

}  // namespace
}  // namespace stopline
