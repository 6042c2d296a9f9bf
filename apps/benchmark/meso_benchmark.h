// Benchmarks of the mesoscale mode: the car-following equation alone, the whole kernel, and the whole simulation step
// of scenarios/intersection.yaml. In addition to the equation, the kernel looks ahead, observes speed limits and moves
// the vehicles.
#pragma once

#include <string>

namespace stopline {

// Return the names of the benchmarks for `kernels` (kBatch or kScalar), without the number of vehicles.
std::string following_name(const std::string& kernels);
std::string kernel_name(const std::string& kernels);
inline constexpr const char* kMesoStep = "meso_intersection_1000_steps";
inline constexpr int kFollowers = 512;  // number of followers; their data fit into the first-level cache

void add_meso_benchmarks();

}  // namespace stopline
