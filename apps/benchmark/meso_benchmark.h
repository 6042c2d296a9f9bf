// Cost of the mesoscale mode: the bare car-following equation, the kernel that also looks ahead, keeps to limits and moves vehicles, and
// the whole step at the reference intersection.
#pragma once

#include <string>

namespace stopline {

// Names without the number of vehicles.
std::string following_name(const std::string& kernels);
std::string moving_name(const std::string& kernels);
inline constexpr const char* kMesoStep = "meso_intersection_1000_steps";
inline constexpr int kFollowers = 512;  // the first-level cache holds these

void add_meso_benchmarks();

}  // namespace stopline
