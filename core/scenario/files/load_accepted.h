// Loads a file of differences that a user accepts. Each entry names a detector at which full dynamics and the mesoscale
// mode give different passages, and the reason why the user accepts this difference (the subjective criterion in
// Section V.B of the paper).
//
//     accepted:
//     - permutation: green = 15 s, offset = 0 s, population = CDG
//       detector: c1r2_south_in_0 middle
//       reason: the 15th vehicle stops on the detector in one mode and in front of it in the other
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stopline {

struct AcceptedDifference {
    std::string permutation;  // axis values, as text in the report of stopline-calibrate
    std::string detector;     // name of the detector in this report
    std::string reason;       // reason why the difference is accepted
    // Positions in the file of the permutation and of the detector, "file:line:column".
    std::string permutation_place = {};
    std::string detector_place = {};
};

struct AcceptedFile {
    std::vector<AcceptedDifference> accepted;
};

AcceptedFile load_accepted(const std::filesystem::path& file);

}  // namespace stopline
