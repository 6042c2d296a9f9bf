// What measures Section VI for the scorecard and what reads its rows share.
#pragma once

#include <string>

#include <fmt/format.h>

namespace stopline::section6 {

// Names of the experiments.
inline constexpr const char* kPlatoons = "arterial_platoons";
inline constexpr const char* kArterial = "arterial";
inline constexpr const char* kGrid = "grid";
inline constexpr const char* kStability = "grid_stability";

// One run's place among the others. `traffic`: free (no turns on the street), turns; in the stability sweep saturated_5, saturated_10
// and rate_10, by the share that turns left.
inline std::string place_of(const std::string& traffic, int green_s, int offset_s, const std::string& population) {
    return fmt::format("{} {} {} {}", traffic, green_s, offset_s, population);
}

}  // namespace stopline::section6
