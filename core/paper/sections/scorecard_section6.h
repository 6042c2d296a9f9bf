// Names of the measurements of Section VI, shared by the experiments and the row functions.
#pragma once

#include <string>

#include <fmt/format.h>

namespace stopline::section6 {

// Names of the experiments.
inline constexpr const char* kPlatoons = "arterial_platoons";
inline constexpr const char* kArterial = "arterial";
inline constexpr const char* kGrid = "grid";
inline constexpr const char* kStability = "grid_stability";

// Returns the name of one combination of a sweep's settings. `traffic` is "free" (no turns; on the arterial, no turns
// from the major street) or "turns". In the stability sweep, `traffic` is the demand kind with the share of left turns
// in percent: "saturated_5", "saturated_10" or "rate_10".
inline std::string point_name(const std::string& traffic, int green_s, int offset_s, const std::string& population) {
    return fmt::format("{} {} {} {}", traffic, green_s, offset_s, population);
}

}  // namespace stopline::section6
