#include "figures/interval_points.h"

#include <fmt/format.h>

namespace stopline {

std::size_t intervals_per_point(std::size_t intervals) {
    constexpr std::size_t kGroup = 5;
    return intervals < 2 * kGroup ? 1 : kGroup;
}

std::string points_text(std::size_t intervals, double interval_s) {
    const std::size_t group = intervals_per_point(intervals);
    if (group == 1) return fmt::format("one per interval of {:g} s", interval_s);
    return fmt::format("means of {} intervals of {:g} s", group, interval_s);
}

std::string no_interval_text(const Scenario& scenario) {
    return fmt::format("the run of {:g} s has no whole interval of {:g} s (measure.interval)", scenario.duration_s,
                       scenario.measure.interval_s);
}

std::string curve_style(std::size_t points) {
    constexpr std::size_t kFew = 10;
    return points < kFew ? "linespoints pt 7 ps 0.4" : "lines";
}

}  // namespace stopline
