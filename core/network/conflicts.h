// Conflict areas of connections, computed from their geometry.
#pragma once

#include <optional>

#include "network/lane_graph.h"

namespace stopline {

// Returns the distance from the common start of two diverging paths to the point where `a` is `clearance_m` away from
// `b`.
double shared_stretch_m(const Polyline& a, const Polyline& b, double clearance_m);

// Returns the conflict area of two connections, seen from `one`, or nothing if vehicles on them cannot touch. The
// caller sets `other`, `yields` and `other_yields`.
std::optional<Conflict> conflict_of(const Lane& one, const Lane& two, double clearance_m);

// Adds the conflicts of the connections [first, stop) to graph.conflicts, which must have one entry per lane. Two
// connections conflict if their centre lines come closer than `clearance_m`. Connections of one approach lane do not
// conflict, because their vehicles follow each other. If both movements have green in the same stage, a left turn
// yields to right turns and to straight traffic, and a right turn yields to straight traffic.
void find_conflicts(LaneGraph& graph, double clearance_m, int first, int stop);

}  // namespace stopline
