// Centre lines of lanes in the plane. Metres; angles in quarter turns counter-clockwise.
#pragma once

#include <vector>

namespace stopline {

struct Point {
    double x_m = 0.0;
    double y_m = 0.0;
};

using Polyline = std::vector<Point>;

double length_m(const Polyline& line);

// The point at a distance along the line, continued straight beyond its ends, and the direction there.
struct Pose {
    Point point;
    double cosine = 1.0;
    double sine = 0.0;
};
Pose place_at(const Polyline& line, double distance_m);

// Smallest distance of a point to the line.
double distance_m(const Polyline& line, const Point& point);

// A quarter turn from `from`, heading along +x, to `to`, heading along +y (dy > 0) or -y: a circle where both legs are
// equal, an ellipse else.
Polyline quarter_turn(const Point& from, const Point& to);

Polyline rotated(const Polyline& line, int quarter_turns);

}  // namespace stopline
