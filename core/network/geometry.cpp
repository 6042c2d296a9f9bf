#include "network/geometry.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace stopline {

double length_m(const Polyline& line) {
    double sum_m = 0.0;
    for (std::size_t k = 1; k < line.size(); ++k) {
        sum_m += std::hypot(line[k].x_m - line[k - 1].x_m, line[k].y_m - line[k - 1].y_m);
    }
    return sum_m;
}

Pose pose_at(const Polyline& line, double distance_m) {
    double remaining_m = distance_m;
    for (std::size_t k = 1; k < line.size(); ++k) {
        const double dx = line[k].x_m - line[k - 1].x_m;
        const double dy = line[k].y_m - line[k - 1].y_m;
        const double segment_m = std::hypot(dx, dy);
        if (remaining_m <= segment_m || k + 1 == line.size()) {
            const Pose place{{}, dx / segment_m, dy / segment_m};
            return {{line[k - 1].x_m + place.cosine * remaining_m, line[k - 1].y_m + place.sine * remaining_m},
                    place.cosine,
                    place.sine};
        }
        remaining_m -= segment_m;
    }
    return {line.empty() ? Point{} : line.front()};
}

double distance_m(const Polyline& line, const Point& point) {
    double nearest2 = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k < line.size(); ++k) {
        const double dx = line[k].x_m - line[k - 1].x_m;
        const double dy = line[k].y_m - line[k - 1].y_m;
        const double px = point.x_m - line[k - 1].x_m;
        const double py = point.y_m - line[k - 1].y_m;
        const double along = std::clamp((px * dx + py * dy) / (dx * dx + dy * dy), 0.0, 1.0);
        const double rx = px - along * dx;
        const double ry = py - along * dy;
        nearest2 = std::min(nearest2, rx * rx + ry * ry);
    }
    return std::sqrt(nearest2);
}

Polyline quarter_turn(const Point& from, const Point& to) {
    constexpr int kSegments = 24;
    const double dx = to.x_m - from.x_m;
    const double dy = to.y_m - from.y_m;
    Polyline line;
    for (int k = 0; k <= kSegments; ++k) {
        const double angle = 0.5 * std::numbers::pi * k / kSegments;
        line.push_back({from.x_m + dx * std::sin(angle), from.y_m + dy * (1.0 - std::cos(angle))});
    }
    return line;
}

Polyline rotated(const Polyline& line, int quarter_turns) {
    Polyline turned;
    for (Point p : line) {
        for (int k = 0; k < quarter_turns; ++k) p = {-p.y_m, p.x_m};
        turned.push_back(p);
    }
    return turned;
}

}  // namespace stopline
