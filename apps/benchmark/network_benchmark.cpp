#include "benchmark/network_benchmark.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <memory>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "base/io/data_directory.h"
#include "benchmark/full_step_benchmark.h"
#include "common/program.h"
#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"

namespace stopline {

namespace {

constexpr double kWarmUp_s = 600.0;    // by then the grid is in steady state
constexpr double kMeasured_s = 120.0;  // more than two signal cycles
constexpr int kQueuedVehicles = 12;    // queued vehicles on each lane between two intersections
// Measured time of the large grids: one signal cycle. All signals change together, so only whole cycles are comparable.
constexpr double kSignalCycle_s = 46.0;

Scenario grid_scenario(int side) {
    return load_scenario(scenario_directory() / "grid.yaml",
                         {fmt::format("network.grid.columns={}", side), fmt::format("network.grid.rows={}", side)});
}

double resident_bytes() {
    std::ifstream file("/proc/self/statm");
    double total_pages = 0.0;
    double resident_pages = 0.0;
    file >> total_pages >> resident_pages;
    return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

void measure(benchmark::State& state, Simulation& simulation, double duration_s) {
    std::int64_t updates = 0;
    for (auto iteration : state) {
        if (interrupted()) return state.SkipWithError("interrupted");
        const std::int64_t updates_before = simulation.state().records.updates;
        const auto start = std::chrono::steady_clock::now();
        simulation.run_until(simulation.time_s() + duration_s);
        state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        updates += simulation.state().records.updates - updates_before;
    }
    set_cost(state, updates);
    state.counters[kVehiclesCounter] = simulation.state().present();
    if (!simulation.state().records.violations.none())
        state.SkipWithError("vehicles overlap, enter on red or are lost");
}

// A simulation that all repetitions of a benchmark share and continue. Filling the network anew would take longer than
// the measurement.
struct KeptRun {
    std::unique_ptr<Model> model;
    std::unique_ptr<Simulation> simulation;
    double bytes = 0.0;
};
KeptRun& kept_run(const std::string& name) {
    static std::map<std::string, KeptRun> runs;
    if (!runs.contains(name)) runs.clear();  // frees the memory of the previous benchmark
    return runs[name];
}

void grid(benchmark::State& state, int population) {
    KeptRun& run = kept_run(grid_name(kGridPopulations[static_cast<std::size_t>(population)]));
    if (!run.model) {
        run.model = std::make_unique<Model>(network_model(grid_scenario(5), static_cast<std::size_t>(population)));
        run.simulation = std::make_unique<Simulation>(*run.model);
        run.simulation->run_until(kWarmUp_s);
    }
    measure(state, *run.simulation, kMeasured_s);
}

// Returns the model of a grid that starts with queues on all roads, as in a saturated network.
Model queued_model(int side) {
    Model model = network_model(grid_scenario(side), 0);
    model.demand.starts_queued = true;
    for (DemandPlan::Inlet& inlet : model.demand.inlets) {
        const std::vector<int>& entries = model.graph.entries;
        if (!std::binary_search(entries.begin(), entries.end(), inlet.lane)) inlet.vehicles = kQueuedVehicles;
    }
    return model;
}

void large_grid(benchmark::State& state, int side, int threads) {
    KeptRun& run = kept_run(large_grid_name(side, threads));
    if (!run.model) {
        run.model = std::make_unique<Model>(queued_model(side));
        const double before_bytes = resident_bytes();
        run.simulation = std::make_unique<Simulation>(*run.model, threads);
        run.simulation->run_until(40.0);
        run.bytes = resident_bytes() - before_bytes;
    }
    measure(state, *run.simulation, kSignalCycle_s);
    state.counters[kBytesCounter] = run.bytes / run.simulation->state().present();
}

void configure(benchmark::internal::Benchmark* added) {
    added->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(1)->Repetitions(7);
}

}  // namespace

std::string grid_name(const char* population) { return fmt::format("{}/{}", kGrid, population); }
std::string large_grid_name(int side, int threads) {
    return fmt::format("{}/{}x{}/threads_{}", kLargeGrid, side, side, threads);
}

void add_network_benchmarks() {
    for (int k = 0; k < static_cast<int>(kGridPopulations.size()); ++k) {
        configure(
            benchmark::RegisterBenchmark(grid_name(kGridPopulations[static_cast<std::size_t>(k)]).c_str(), grid, k));
    }
    for (const int side : kGridSides) {
        configure(benchmark::RegisterBenchmark(large_grid_name(side, 1).c_str(), large_grid, side, 1));
        if (side != kTwoThreadSide) continue;
        configure(benchmark::RegisterBenchmark(large_grid_name(side, 2).c_str(), large_grid, side, 2));
    }
}

}  // namespace stopline
