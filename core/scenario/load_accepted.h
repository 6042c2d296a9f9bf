// Loads the file of accepted differences between full dynamics and the mesoscale mode. A user has reviewed and accepted
// them, which is the paper's subjective criterion (Section V.B).
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
    std::string permutation;  // values of the axes, as in the report
    std::string detector;
    std::string reason;
};

struct AcceptedFile {
    std::vector<AcceptedDifference> accepted;
};

AcceptedFile load_accepted(const std::filesystem::path& file);

}  // namespace stopline
