#include "benchmark/meso_benchmark.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/simd.h"
#include "benchmark/full_step_benchmark.h"
#include "common/program.h"
#include "experiment/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/meso_dynamics.h"
#include "sim/simulation.h"
#include "sim/vehicle_arrays.h"

namespace stopline {

namespace {

constexpr int kPasses = 1600;      // over all followers, an iteration
constexpr int kSteps = 1000;       // of the intersection: 100 s, about two cycles
constexpr double kFilled_s = 100;  // by then the arms are full

Model intersection_model() {
    return build_model(load_scenario(data_directory() / "../scenarios/intersection.yaml", {"fidelity=meso"}), 0);
}

// The kernel alone, over arrays: a step of vehicles that follow one another.
void following(benchmark::State& state, bool scalar) {
    const Model model = intersection_model();
    const MesoKernels& kernels = meso_kernels(scalar);
    VehicleArrays v;
    v.grow(kSimdWidth + kFollowers);
    std::vector<int> blocks;
    for (int k = 0; k < kFollowers; ++k) {
        const int slot = kSimdWidth + k;
        const auto i = static_cast<std::size_t>(slot);
        if (k % kernels.size == 0) blocks.push_back(slot / kernels.size);
        v.speed_mps[i] = 13.0 + 0.01 * (k % 50);
        v.position_m[i] = -18.5 * k - 0.02 * (k % 90);
        v.length_m[i] = 4.5F;
        v.limit_mps[i] = 14.6;
        v.end_speed_mps[i] = 1e3F;
        v.id[i] = k;
    }
    const MesoStreams streams = meso_streams(v);
    MesoStep step = meso_step(model, 0);
    std::int64_t updates = 0;
    for (auto iteration : state) {
        if (interrupted()) return state.SkipWithError("interrupted");
        const auto start = std::chrono::steady_clock::now();
        for (int pass = 0; pass < kPasses; ++pass) {
            ++step.tick;
            benchmark::DoNotOptimize(kernels.step(streams, blocks, model.krauss, nullptr, step));
            benchmark::ClobberMemory();
        }
        state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        updates += static_cast<std::int64_t>(kPasses) * kFollowers;
    }
    set_cost(state, updates);
}

void intersection(benchmark::State& state) {
    const Model model = intersection_model();
    Simulation begin(model);
    begin.run_until(kFilled_s);
    std::int64_t updates = 0;
    for (auto iteration : state) {
        if (interrupted()) return state.SkipWithError("interrupted");
        Simulation simulation = begin;
        const std::int64_t before = simulation.state().updates;
        const auto start = std::chrono::steady_clock::now();
        for (int k = 0; k < kSteps; ++k) simulation.step();
        state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        updates += simulation.state().updates - before;
    }
    set_cost(state, updates);
}

void add_following(const char* kernels) {
    const bool scalar = std::string(kernels) == kScalar;
    benchmark::RegisterBenchmark(following_name(kernels).c_str(), following, scalar)
        ->Unit(benchmark::kMicrosecond)
        ->UseManualTime()
        ->Repetitions(7)
        ->Arg(kFollowers)
        ->Iterations(10);
}

}  // namespace

std::string following_name(const std::string& kernels) { return "meso_following_1600_passes/" + kernels; }

void add_meso_benchmarks() {
    add_following(kBatch);
    add_following(kScalar);
    benchmark::RegisterBenchmark(kMesoStep, intersection)
        ->Unit(benchmark::kMicrosecond)
        ->UseManualTime()
        ->Repetitions(7)
        ->Arg(0)
        ->Iterations(20);
}

}  // namespace stopline
