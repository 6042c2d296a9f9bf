// A function of one variable, given by points.
#pragma once

#include <vector>

namespace stopline {

// Samples of y over x. The values of x must rise strictly, and x and y must have the same length.
struct SampledCurve {
    std::vector<double> x;
    std::vector<double> y;

    bool operator==(const SampledCurve&) const = default;
};

}  // namespace stopline
