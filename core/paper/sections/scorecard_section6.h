// Names of the measurements of Section VI, and the settings of its sweeps.
#pragma once

#include <array>
#include <string>

#include <fmt/format.h>

namespace stopline::section6 {

// Names of the experiments.
inline constexpr const char* kPlatoons = "arterial_platoons";
inline constexpr const char* kArterial = "arterial";
inline constexpr const char* kGrid = "grid";
inline constexpr const char* kStability = "grid_stability";

// Settings of the signals in the sweeps. On the arterial, the green time is that of the major street.
inline constexpr std::array<int, 3> kArterialGreens_s{25, 30, 35};
inline constexpr std::array<int, 2> kArterialOffsets_s{0, 15};
inline constexpr std::array<int, 4> kGridGreens_s{5, 10, 15, 20};
inline constexpr std::array<int, 4> kGridOffsets_s{0, 5, 10, 15};

// Returns the name of one combination of a sweep's settings. `traffic` is "free" (no turns; on the arterial, no turns
// from the major street) or "turns". In the stability sweep, `traffic` is the demand kind with the share of left turns
// in percent: "saturated_5", "saturated_10" or "rate_10".
inline std::string point_name(const std::string& traffic, int green_s, int offset_s, const std::string& population) {
    return fmt::format("{} {} {} {}", traffic, green_s, offset_s, population);
}

}  // namespace stopline::section6
