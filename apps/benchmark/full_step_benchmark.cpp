#include "benchmark/full_step_benchmark.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <ctime>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

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

// A V2V channel. `v2v`: value of the field driver.v2v; empty: the default channel.
struct RadioCase {
    const char* name;
    const char* v2v;
};
constexpr RadioCase kDefaultRadio{"", ""};
// With the channel `interval`, no message is lost, but vehicles send only once in an interval.
constexpr std::array kRadioCases{RadioCase{"interval", "{interval: 100 ms}"},
                                 RadioCase{"bernoulli", "{channel: bernoulli, loss: 10 %}"},
                                 RadioCase{"gilbert", "{channel: gilbert, loss: 10 %, burst: 4}"}};

Model queue_model(int vehicles, const RadioCase& radio) {
    std::vector<std::string> overrides;
    if (*radio.v2v != 0) overrides.push_back(std::string("driver.v2v=") + radio.v2v);
    Scenario scenario = load_scenario(scenario_directory() / "single_light.yaml", overrides);
    scenario.network.approach.lanes = std::max(1, vehicles / kVehiclesPerLane);
    scenario.network.approach.length_m = 800.0;
    scenario.network.approach.exit_length_m = 2000.0;
    scenario.demand.vehicles = std::min(vehicles, kVehiclesPerLane);
    scenario.signal.first_green_s = kGreen_s;
    Model model = build_model(scenario, 0);
    model.demand.entry_headway_s = kHeadway_s;
    return model;
}

// A simulation of moving platoons. There is one for each combination of vehicle count, kernels (batch or scalar) and
// channel.
struct DrivingPlatoons {
    DrivingPlatoons(int vehicles, bool scalar, const RadioCase& radio)
        : model(queue_model(vehicles, radio)), simulation(model) {
        simulation.run_until(kGreen_s + kDriving_s);
        model.scalar_kernels = scalar;
    }
    Model model;
    Simulation simulation;
};

const DrivingPlatoons& driving_platoons(int vehicles, bool scalar, const RadioCase& radio) {
    static std::map<std::tuple<int, bool, std::string>, std::unique_ptr<DrivingPlatoons>> by_case;
    std::unique_ptr<DrivingPlatoons>& platoons = by_case[{vehicles, scalar, radio.name}];
    if (!platoons) platoons = std::make_unique<DrivingPlatoons>(vehicles, scalar, radio);
    return *platoons;
}

// Returns the time that the processor has spent on this program. Unlike the elapsed time, it does not grow while other
// programs use the processor.
double processor_time_s() {
    std::timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Measures the same second of simulated time in every iteration. The measured time includes neither the copying of the
// simulation nor the warm-up steps.
void full_dynamics(benchmark::State& state, bool scalar, const RadioCase& radio) {
    const DrivingPlatoons& initial = driving_platoons(static_cast<int>(state.range(0)), scalar, radio);
    std::int64_t updates = 0;
    for (auto iteration : state) {
        if (interrupted()) return state.SkipWithError("interrupted");
        Simulation simulation = initial.simulation;
        for (int step = 0; step < kWarmUpSteps; ++step) simulation.step();
        const std::int64_t updates_before = simulation.state().records.updates;
        const double start_s = processor_time_s();
        for (int step = 0; step < kSteps; ++step) simulation.step();
        state.SetIterationTime(processor_time_s() - start_s);
        updates += simulation.state().records.updates - updates_before;
    }
    set_cost(state, updates);
}

void add(const std::string& kernels, int vehicles, int iterations, const RadioCase& radio = kDefaultRadio) {
    const bool scalar = kernels == kScalar;
    benchmark::RegisterBenchmark(benchmark_name(kernels).c_str(), full_dynamics, scalar, radio)
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
    for (const RadioCase& radio : kRadioCases) {
        add(radio.name, 160, 40, radio);
        add(radio.name, 1600, 8, radio);
        add(radio.name, 16000, 1, radio);
    }
}

}  // namespace stopline
