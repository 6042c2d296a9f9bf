// Plane geometry of centre lines. Lengths are in metres. Rotations are counter-clockwise, in quarter turns.
#pragma once

#include <vector>

namespace stopline {

struct Point {
    double x_m = 0.0;
    double y_m = 0.0;
};

using Polyline = std::vector<Point>;

double length_m(const Polyline& line);

// A point and a direction. The direction is given by the cosine and sine of its angle from the x axis.
struct Pose {
    Point point;
    double cosine = 1.0;
    double sine = 0.0;
};

// Returns the point at a distance along the line, and the direction of the line at this point. The line continues
// straight beyond its ends.
Pose pose_at(const Polyline& line, double distance_m);

// Returns the smallest distance between the point and the line.
double distance_m(const Polyline& line, const Point& point);

// Returns a curve of a quarter turn from `from` to `to`. The curve starts in direction +x. It ends in direction +y if
// `to` has the larger y, else in direction -y. The curve is a quarter of an ellipse, or of a circle if the distances in
// x and y are equal.
Polyline quarter_turn(const Point& from, const Point& to);

// Returns the line rotated about the origin. `quarter_turns` must not be negative.
Polyline rotated(const Polyline& line, int quarter_turns);

}  // namespace stopline
