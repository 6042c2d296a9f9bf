#include "benchmark/meso_benchmark.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/io/data_directory.h"
#include "base/simd/simd.h"
#include "benchmark/full_step_benchmark.h"
#include "common/program.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/mesoscale/meso_dynamics.h"
#include "sim/state/vehicles/vehicle_arrays.h"
#include "sim/step/simulation.h"

namespace stopline {

namespace {

constexpr int kPasses = 1600;      // number of passes over all followers in one iteration
constexpr int kSteps = 1000;       // number of measured steps: 100 s, about two signal cycles
constexpr double kWarmUp_s = 100;  // by then vehicles fill all legs of the intersection

Model intersection_model() {
    return build_model(load_scenario(scenario_directory() / "intersection.yaml", {"fidelity=meso"}), 0);
}

// A platoon of kFollowers vehicles. The benchmarks compute its step again and again.
struct Platoon {
    Platoon(const Model& model, int block_size) : step(meso_step(model, 0)) {
        v.grow(kSimdWidth + kFollowers);
        for (int k = 0; k < kFollowers; ++k) {
            const int slot = kSimdWidth + k;
            const auto i = static_cast<std::size_t>(slot);
            if (k % block_size == 0) blocks.push_back(slot / block_size);
            v.speed_mps[i] = 13.0 + 0.01 * (k % 50);
            v.position_m[i] = -18.5 * k - 0.02 * (k % 90);
            v.length_m[i] = 4.5F;
            v.limit_mps[i] = 14.6;
            v.end_speed_mps[i] = kNoLowerLimit_mps;
            v.id[i] = k;
        }
    }

    VehicleArrays v;
    std::vector<int> blocks;
    MesoStep step;
};

template <class Pass>
void repeat(benchmark::State& state, Platoon& platoon, Pass pass) {
    std::int64_t updates = 0;
    for (auto iteration : state) {
        if (interrupted()) return state.SkipWithError("interrupted");
        const auto start = std::chrono::steady_clock::now();
        for (int k = 0; k < kPasses; ++k) {
            ++platoon.step.tick;
            pass();
            benchmark::ClobberMemory();
        }
        state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        updates += static_cast<std::int64_t>(kPasses) * kFollowers;
    }
    set_cost(state, updates);
}

void kernel_step(benchmark::State& state, bool scalar) {
    const Model model = intersection_model();
    Platoon platoon(model, meso_block_size(scalar));
    const MesoStreams streams = meso_streams(platoon.v);
    repeat(state, platoon, [&] {
        benchmark::DoNotOptimize(step_blocks(scalar, streams, platoon.blocks, model.following, nullptr, platoon.step));
    });
}

// Measures the car-following equation alone: it computes the speeds of the next step from gaps and speeds of this step.
void following(benchmark::State& state, bool scalar) {
    const Model model = intersection_model();
    const MesoKernels& kernels = model.following[0].family().kernels(scalar);
    Platoon platoon(model, kernels.size);
    const LargeArray<double> gap_m(kFollowers, 14.5);
    const LargeArray<double> none(kFollowers, 0.0);
    const LargeArray<double> cap_mps(kFollowers, 14.6);
    LargeArray<double> next_mps(kFollowers, 0.0);
    const double* const speed = platoon.v.speed_mps.data() + kSimdWidth;
    const std::span<const int> ids(platoon.v.id.data() + kSimdWidth, kFollowers);
    repeat(state, platoon, [&] {
        kernels.follow(model.following[0], platoon.step,
                       {speed, gap_m.data(), speed, none.data(), none.data(), cap_mps.data(), cap_mps.data()}, ids,
                       next_mps.data());
        benchmark::DoNotOptimize(next_mps.data());
    });
}

void intersection(benchmark::State& state) {
    const Model model = intersection_model();
    Simulation initial(model);
    initial.run_until(kWarmUp_s);
    std::int64_t updates = 0;
    for (auto iteration : state) {
        if (interrupted()) return state.SkipWithError("interrupted");
        Simulation simulation = initial;
        const std::int64_t updates_before = simulation.state().records.updates;
        const auto start = std::chrono::steady_clock::now();
        for (int k = 0; k < kSteps; ++k) simulation.step();
        state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        updates += simulation.state().records.updates - updates_before;
    }
    set_cost(state, updates);
}

void add(const std::string& name, void (*measure)(benchmark::State&, bool), bool scalar) {
    benchmark::RegisterBenchmark(name.c_str(), measure, scalar)
        ->Unit(benchmark::kMicrosecond)
        ->UseManualTime()
        ->Repetitions(7)
        ->Arg(kFollowers)
        ->Iterations(10);
}

}  // namespace

std::string following_name(const std::string& kernels) { return "meso_following_1600_passes/" + kernels; }

std::string kernel_name(const std::string& kernels) { return "meso_kernel_1600_passes/" + kernels; }

void add_meso_benchmarks() {
    for (const char* const kernels : {kBatch, kScalar}) {
        add(following_name(kernels), following, std::string(kernels) == kScalar);
        add(kernel_name(kernels), kernel_step, std::string(kernels) == kScalar);
    }
    benchmark::RegisterBenchmark(kMesoStep, intersection)
        ->Unit(benchmark::kMicrosecond)
        ->UseManualTime()
        ->Repetitions(7)
        ->Arg(0)
        ->Iterations(20);
}

}  // namespace stopline
