// Benchmarks of the step in full dynamics with 16 to 16,000 vehicles. The vehicles are platoons of up to 80 per lane,
// ten seconds after the signal turned green.
#pragma once

#include <cstdint>
#include <string>

#include <benchmark/benchmark.h>

namespace stopline {

inline constexpr const char* kBatch = "batch";    // several vehicles at once
inline constexpr const char* kScalar = "scalar";  // one vehicle at a time
inline constexpr const char* kCostCounter = "s_per_update";

// Returns the name of the benchmarks with these kernels, without the number of vehicles.
std::string benchmark_name(const std::string& kernels);

// Sets the counters of a benchmark: vehicle updates per second, and time per update.
void set_cost(benchmark::State& state, std::int64_t updates);

void add_full_step_benchmarks();

}  // namespace stopline
