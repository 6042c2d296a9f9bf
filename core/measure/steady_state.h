// When a series has settled, and whether it breaks down later.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace stopline {

// Values to leave out at the beginning: the marginal standard error rule with means of five (MSER-5: White 1997, Simulation 69(6);
// White, Cobb and Spratt 2000, Winter Simulation Conference). Of all cuts within the first half it takes the one after which the
// mean of the rest is known best, the smallest variance over the square of the count. A multiple of 5; 0 for short series.
std::size_t warm_up(std::span<const double> values);

// The first value that is 90 % of the highest or more: the rise before it is over.
std::size_t first_full(std::span<const double> values);

// A drop to another level for good: the cut that explains most of the variance (least squares, one change), where the mean behind it is
// lower by `share` of that before or more, and by more than three standard errors, and that of the last tenth (five values at least) is as
// low. Nothing where there is none, and for less than kCollapseNeeds values.
inline constexpr std::size_t kCollapseNeeds = 10;
struct Collapse {
    std::size_t at = 0;  // first value of the lower level
    double before = 0.0;
    double after = 0.0;
};
std::optional<Collapse> find_collapse(std::span<const double> values, double share);

}  // namespace stopline
