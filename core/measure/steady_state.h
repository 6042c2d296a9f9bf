// Detection of the warm-up and of a later collapse in a time series.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace stopline {

// For fewer values, the end of the warm-up cannot be found.
inline constexpr std::size_t kMinWarmUpValues = 15;

// Returns the number of values at the beginning that belong to the warm-up: a multiple of 5. Returns 0 for fewer than
// kMinWarmUpValues values.
//
// The method is the marginal standard error rule with means of five values (MSER-5: White 1997, Simulation 69(6);
// White, Cobb and Spratt 2000, Winter Simulation Conference). It tries each position in the first half of the series
// as the end of the warm-up. For each position it divides the sum of squared deviations of the later values by the
// square of their number. The position with the smallest ratio wins, because it gives the best estimate of the mean.
std::size_t warm_up(std::span<const double> values);

// Returns the end of the initial rise: the index of the first value that is at least 90 % of the highest value.
std::size_t rise_end(std::span<const double> values);

// A lasting drop of the level of a series.
struct Collapse {
    std::size_t index = 0;  // first value of the lower level
    double before = 0.0;    // mean before the drop
    double after = 0.0;     // mean after the drop
};
inline constexpr std::size_t kMinCollapseValues = 10;

// Finds a collapse. The series is cut into two parts, so that the squared deviations from the means of the two parts
// have the smallest sum. The mean of the second part must be lower than the mean of the first part: by at least `share`
// of the first mean, and by more than three standard errors. The mean of the last tenth of the series (at least five
// values) must also be lower than the first mean by at least this share. Returns nothing if there is no collapse, or
// for fewer than kMinCollapseValues values.
std::optional<Collapse> find_collapse(std::span<const double> values, double share);

}  // namespace stopline
