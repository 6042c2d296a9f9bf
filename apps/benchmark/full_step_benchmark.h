// Cost of the full-dynamics step at 16 to 16,000 vehicles, in platoons of up to 80 a lane that have driven for ten seconds since
// the light turned green.
#pragma once

#include <cstdint>
#include <string>

#include <benchmark/benchmark.h>

namespace stopline {

inline constexpr const char* kBatch = "batch";    // several vehicles at once
inline constexpr const char* kScalar = "scalar";  // one vehicle at a time
inline constexpr const char* kCostCounter = "s_per_update";

// Of the benchmarks with these kernels, without the number of vehicles.
std::string benchmark_name(const std::string& kernels);

// Counters of all benchmarks: updates a second, and the cost of one.
void set_cost(benchmark::State& state, std::int64_t updates);

void add_full_step_benchmarks();

}  // namespace stopline
