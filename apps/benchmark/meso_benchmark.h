// Cost of the mesoscale mode: the bare car-following loop, and the whole step at the reference intersection.
#pragma once

#include <string>

namespace stopline {

// Names without the number of vehicles.
std::string following_name(const std::string& kernels);
inline constexpr const char* kMesoStep = "meso_intersection_1000_steps";
inline constexpr int kFollowers =
    512;  // the engine takes lanes together until there are 128: the first-level cache holds these too

void add_meso_benchmarks();

}  // namespace stopline
