// Benchmarks of one simulation step in full dynamics, with 16 to 16,000 vehicles. The vehicles drive in platoons of up
// to 80 vehicles per lane. The measurement begins about ten seconds after the start of green.
#pragma once

#include <cstdint>
#include <string>

#include <benchmark/benchmark.h>

namespace stopline {

inline constexpr const char* kBatch = "batch";    // name of the kernels that compute several vehicles at once
inline constexpr const char* kScalar = "scalar";  // name of the kernels that compute one vehicle at a time
inline constexpr const char* kCostCounter = "s_per_update";

// Returns the name of the benchmarks for `kernels` (kBatch or kScalar), without the number of vehicles.
std::string benchmark_name(const std::string& kernels);

// Sets the counters of a benchmark: updates per second, and time per update. An update is one vehicle in one step.
void set_cost(benchmark::State& state, std::int64_t updates);

void add_full_step_benchmarks();

}  // namespace stopline
