#include "common/violation_text.h"

#include <cstddef>

#include <fmt/format.h>

namespace stopline {

std::string first_violation_text(const std::string& population, const Violations& violations,
                                 const std::vector<std::string>& lanes) {
    const Violation& first = violations.first;
    if (first.time_s < 0.0) return "";
    const std::string lane = first.lane < 0 ? "" : fmt::format(" on {}", lanes[static_cast<std::size_t>(first.lane)]);
    std::string what = fmt::format("vehicle {} enters on red{}", first.vehicle, lane);
    if (first.kind == Violation::Kind::overlap)
        what = fmt::format("vehicle {}{} overlaps vehicle {}", first.vehicle, lane, first.other);
    if (first.kind == Violation::Kind::conflict)
        what = fmt::format("vehicle {}{} is in the same conflict area as vehicle {}", first.vehicle, lane, first.other);
    return fmt::format(
        "First violation of {}: at {:.1f} s {}.\n"
        "To see it: run again with --record FILE, make a page with stopline-replay, open PAGE#t={:.0f}&vehicle={}\n",
        population, first.time_s, what, first.time_s, first.vehicle);
}

}  // namespace stopline
