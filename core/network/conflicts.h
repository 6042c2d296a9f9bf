// Conflict areas of connections, computed from their geometry.
#pragma once

#include <optional>

#include "network/lane_graph.h"

namespace stopline {

// Returns how far two diverging paths run together: the distance along `a`, from the common start to the point where
// `a` is `clearance_m` away from `b`, or to the end of the shorter path if the paths stay closer than that.
double shared_stretch_m(const Polyline& a, const Polyline& b, double clearance_m);

// Returns the conflict area of two connections, or nothing if vehicles on them cannot touch. In the result, `one` is
// this connection and `two` is the other. The caller sets the members `other`, `yields` and `other_yields`.
std::optional<Conflict> conflict_of(const Lane& one, const Lane& two, double clearance_m);

// Returns true if a movement with the turn `one` yields to a movement with the turn `two` when both have a permissive
// green. A left turn yields to right turns and to straight traffic, and a right turn yields to straight traffic.
bool yields_by_turn(Turn one, Turn two);

// Finds the conflicts between the connections with the lane indices first .. stop - 1, and adds these conflicts to
// graph.conflicts, which must have one list per lane. Two connections conflict if their centre lines come closer than
// `clearance_m`. Connections of the same approach lane do not conflict, because their vehicles follow each other. If
// both movements have green in the same stage, a left turn yields to right turns and to straight traffic, and a right
// turn yields to straight traffic. In all other cases, neither movement yields.
void find_conflicts(LaneGraph& graph, double clearance_m, int first, int stop);

}  // namespace stopline
