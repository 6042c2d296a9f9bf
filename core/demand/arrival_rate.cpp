#include "demand/arrival_rate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stopline {

double ArrivalRate::Piece::expected_within(double time_s) const {
    const double elapsed_s = std::clamp(time_s, from_s, to_s) - from_s;
    return (begin_1ps + 0.5 * slope_1ps2() * elapsed_s) * elapsed_s;
}

void ArrivalRate::append(double until_s, double begin_1ps, double end_1ps) {
    const double before = pieces_.empty() ? 0.0 : expected(end_s());
    pieces_.push_back({end_s(), until_s, begin_1ps, end_1ps, before});
}

double ArrivalRate::rate_1ps(double time_s) const {
    for (const Piece& piece : pieces_) {
        if (time_s < piece.from_s || time_s >= piece.to_s) continue;
        return piece.begin_1ps + piece.slope_1ps2() * (time_s - piece.from_s);
    }
    return 0.0;
}

double ArrivalRate::highest_1ps() const {
    double highest_1ps = 0.0;
    for (const Piece& piece : pieces_) highest_1ps = std::max({highest_1ps, piece.begin_1ps, piece.end_1ps});
    return highest_1ps;
}

double ArrivalRate::expected(double time_s) const {
    const auto later =
        std::partition_point(pieces_.begin(), pieces_.end(), [&](const Piece& piece) { return piece.from_s < time_s; });
    if (later == pieces_.begin()) return 0.0;
    const Piece& piece = *std::prev(later);
    return piece.expected_before + piece.expected_within(time_s);
}

double ArrivalRate::time_of_s(double expected) const {
    // The piece sought is the first one at whose end that many arrivals are expected.
    const auto piece = std::partition_point(pieces_.begin(), pieces_.end(), [&](const Piece& one) {
        return one.expected_before + one.expected_within(one.to_s) < expected;
    });
    if (piece == pieces_.end()) return std::numeric_limits<double>::infinity();
    // Solves begin t + slope t^2 / 2 = rest. This form of the solution also holds for the slope 0.
    const double rest = std::max(expected - piece->expected_before, 0.0);
    const double root_1ps =
        std::sqrt(std::max(piece->begin_1ps * piece->begin_1ps + 2.0 * piece->slope_1ps2() * rest, 0.0));
    const double sum_1ps = piece->begin_1ps + root_1ps;
    return sum_1ps > 0.0 ? std::min(piece->from_s + 2.0 * rest / sum_1ps, piece->to_s) : piece->from_s;
}

}  // namespace stopline
