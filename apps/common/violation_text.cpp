#include "common/violation_text.h"

#include <cstddef>

#include <fmt/format.h>

#include "base/io/printable.h"

namespace stopline {

std::string first_violation_text(const std::string& population, const Violations& violations,
                                 const VehicleNames& vehicle_names, const std::vector<std::string>& lanes) {
    const Violation& first = violations.first;
    if (first.time_s < 0.0) return "";
    const std::string lane =
        first.lane < 0 ? "" : fmt::format(" on {}", printable_text(lanes[static_cast<std::size_t>(first.lane)]));
    const std::string vehicle = printable_text(vehicle_names.of(first.vehicle));
    const std::string other = printable_text(vehicle_names.of(first.other));
    std::string what = fmt::format("vehicle {} enters on red{}", vehicle, lane);
    if (first.kind == Violation::Kind::overlap)
        what = fmt::format("vehicle {}{} overlaps vehicle {}", vehicle, lane, other);
    if (first.kind == Violation::Kind::conflict)
        what = fmt::format("vehicle {}{} is in the same conflict area as vehicle {}", vehicle, lane, other);
    // The link needs the number, because recordings do not store names.
    return fmt::format(
        "First violation of {}: at {:.1f} s {}.\n"
        "To see it: run again with --record FILE, make a page with stopline-replay, open PAGE#t={:.0f}&vehicle={}\n",
        population, first.time_s, what, first.time_s, first.vehicle);
}

}  // namespace stopline
