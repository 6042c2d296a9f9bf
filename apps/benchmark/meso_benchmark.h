// Benchmarks of the mesoscale mode: the car-following equation alone, the kernel of a step, and the whole step at the
// reference intersection. The kernel also looks ahead, keeps speed limits and moves the vehicles.
#pragma once

#include <string>

namespace stopline {

// These functions return the names of benchmarks without the number of vehicles.
std::string following_name(const std::string& kernels);
std::string kernel_name(const std::string& kernels);
inline constexpr const char* kMesoStep = "meso_intersection_1000_steps";
inline constexpr int kFollowers = 512;  // fits into the first-level cache

void add_meso_benchmarks();

}  // namespace stopline
