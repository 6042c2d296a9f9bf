// Cost of the full-dynamics step: ns a vehicle update and vehicle updates a second, at 16 to 16,000 vehicles. The vehicles stand
// in queues of up to 80 a lane when the light turns green; all are computed in every step, moving or not.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include "experiment/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/simulation.h"

namespace {

using stopline::Model;
using stopline::Scenario;
using stopline::Simulation;

constexpr int kQueue = 80;
constexpr double kGreen_s = 120.0;  // all queues have formed by then
constexpr double kHeadway_s = 0.9;

Model queue_model(int vehicles) {
    Scenario scenario = stopline::load_scenario(stopline::data_directory() / "../scenarios/single_light.yaml");
    scenario.network.approach.lanes = std::max(1, vehicles / kQueue);
    scenario.network.approach.length_m = 800.0;
    scenario.network.approach.exit_length_m = 2000.0;
    scenario.demand.vehicles = std::min(vehicles, kQueue);
    scenario.signal.first_green_s = kGreen_s;
    Model model = stopline::build_model(scenario, 0);
    model.demand.entry_headway_s = kHeadway_s;
    return model;
}

// A model and a simulation of it whose queues stand at the start of green; made once for each number of vehicles.
struct Queued {
    explicit Queued(int vehicles, bool scalar) : model(queue_model(vehicles)), simulation(model) {
        simulation.run_until(kGreen_s);
        model.scalar_kernels = scalar;
    }
    Model model;
    Simulation simulation;
};

void full_dynamics_step(benchmark::State& state, bool scalar) {
    static std::map<std::pair<std::int64_t, bool>, std::unique_ptr<Queued>> queues;
    std::unique_ptr<Queued>& queued = queues[{state.range(0), scalar}];
    if (!queued) queued = std::make_unique<Queued>(static_cast<int>(state.range(0)), scalar);
    Simulation simulation = queued->simulation;
    const std::int64_t before = simulation.state().updates;
    for (auto step : state) simulation.step();
    const auto updates = static_cast<double>(simulation.state().updates - before);
    state.counters["updates_per_s"] = benchmark::Counter(updates, benchmark::Counter::kIsRate);
    state.counters["s_per_update"] =
        benchmark::Counter(updates, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// Steps are few enough that no vehicle leaves the network within them.
void sizes(benchmark::internal::Benchmark* run) { run->Unit(benchmark::kMicrosecond)->Repetitions(7); }
BENCHMARK_CAPTURE(full_dynamics_step, batch, false)->Apply(sizes)->Arg(16)->Iterations(5000);
BENCHMARK_CAPTURE(full_dynamics_step, batch, false)->Apply(sizes)->Arg(160)->Iterations(2000);
BENCHMARK_CAPTURE(full_dynamics_step, batch, false)->Apply(sizes)->Arg(1600)->Iterations(500);
BENCHMARK_CAPTURE(full_dynamics_step, batch, false)->Apply(sizes)->Arg(16000)->Iterations(60);
BENCHMARK_CAPTURE(full_dynamics_step, scalar, true)->Apply(sizes)->Arg(160)->Iterations(1000);

}  // namespace

BENCHMARK_MAIN();
