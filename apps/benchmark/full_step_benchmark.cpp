#include "benchmark/full_step_benchmark.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include <benchmark/benchmark.h>

#include "base/io/data_directory.h"
#include "common/program.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {

namespace {

constexpr int kVehiclesPerLane = 80;
constexpr double kGreen_s = 120.0;  // start of green; all queues have formed by then
constexpr double kHeadway_s = 0.9;
constexpr double kDriving_s = 10.0;  // from the start of green to the warm-up steps; by then all vehicles move
constexpr int kWarmUpSteps = 10;
constexpr int kSteps = 100;  // number of measured steps, 1 s in total; during them no vehicle leaves the network

Model queue_model(int vehicles) {
    Scenario scenario = load_scenario(scenario_directory() / "single_light.yaml");
    scenario.network.approach.lanes = std::max(1, vehicles / kVehiclesPerLane);
    scenario.network.approach.length_m = 800.0;
    scenario.network.approach.exit_length_m = 2000.0;
    scenario.demand.vehicles = std::min(vehicles, kVehiclesPerLane);
    scenario.signal.first_green_s = kGreen_s;
    Model model = build_model(scenario, 0);
    model.demand.entry_headway_s = kHeadway_s;
    return model;
}

// A simulation of moving platoons. There is one for each combination of vehicle count and kernels (batch or scalar).
struct DrivingPlatoons {
    explicit DrivingPlatoons(int vehicles, bool scalar) : model(queue_model(vehicles)), simulation(model) {
        simulation.run_until(kGreen_s + kDriving_s);
        model.scalar_kernels = scalar;
    }
    Model model;
    Simulation simulation;
};

const DrivingPlatoons& driving_platoons(int vehicles, bool scalar) {
    static std::map<std::pair<int, bool>, std::unique_ptr<DrivingPlatoons>> by_size;
    std::unique_ptr<DrivingPlatoons>& platoons = by_size[{vehicles, scalar}];
    if (!platoons) platoons = std::make_unique<DrivingPlatoons>(vehicles, scalar);
    return *platoons;
}

// Measures the same second of simulated time in every iteration. The measured time includes neither the copying of the
// simulation nor the warm-up steps.
void full_dynamics(benchmark::State& state, bool scalar) {
    const DrivingPlatoons& initial = driving_platoons(static_cast<int>(state.range(0)), scalar);
    std::int64_t updates = 0;
    for (auto iteration : state) {
        if (interrupted()) return state.SkipWithError("interrupted");
        Simulation simulation = initial.simulation;
        for (int step = 0; step < kWarmUpSteps; ++step) simulation.step();
        const std::int64_t updates_before = simulation.state().records.updates;
        const auto start = std::chrono::steady_clock::now();
        for (int step = 0; step < kSteps; ++step) simulation.step();
        state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        updates += simulation.state().records.updates - updates_before;
    }
    set_cost(state, updates);
}

void add(const char* kernels, int vehicles, int iterations) {
    const bool scalar = std::string(kernels) == kScalar;
    benchmark::RegisterBenchmark(benchmark_name(kernels).c_str(), full_dynamics, scalar)
        ->Unit(benchmark::kMicrosecond)
        ->UseManualTime()
        ->Repetitions(7)
        ->Arg(vehicles)
        ->Iterations(iterations);
}

}  // namespace

void set_cost(benchmark::State& state, std::int64_t updates) {
    state.counters["updates_per_s"] = benchmark::Counter(static_cast<double>(updates), benchmark::Counter::kIsRate);
    state.counters[kCostCounter] =
        benchmark::Counter(static_cast<double>(updates), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

std::string benchmark_name(const std::string& kernels) { return "full_dynamics_100_steps/" + kernels; }

void add_full_step_benchmarks() {
    add(kBatch, 16, 100);
    add(kBatch, 160, 40);
    add(kBatch, 1600, 8);
    add(kBatch, 16000, 1);
    add(kScalar, 160, 20);
}

}  // namespace stopline
