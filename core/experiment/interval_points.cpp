#include "experiment/interval_points.h"

#include <fmt/format.h>

namespace stopline {

std::size_t intervals_of_a_point(std::size_t intervals) {
    constexpr std::size_t kTogether = 5;
    return intervals < 2 * kTogether ? 1 : kTogether;
}

std::string points_text(std::size_t intervals, double interval_s) {
    const std::size_t together = intervals_of_a_point(intervals);
    if (together == 1) return fmt::format("one for each interval of {:g} s", interval_s);
    return fmt::format("means of {} intervals of {:g} s", together, interval_s);
}

std::string no_interval_text(const Scenario& scenario) {
    return fmt::format("the run of {:g} s has no whole interval of {:g} s (measure.interval)", scenario.duration_s,
                       scenario.measure.interval_s);
}

std::string line_of(std::size_t points) {
    constexpr std::size_t kFew = 10;
    return points < kFew ? "linespoints pt 7 ps 0.4" : "lines";
}

}  // namespace stopline
