// Conflict areas between lanes inside intersections, from their geometry alone.
#pragma once

#include <optional>

#include "network/lane_graph.h"

namespace stopline {

// The distance along two paths that leave the same point from which on their vehicles are clear of each other.
double shared_stretch_m(const Polyline& a, const Polyline& b, double clearance_m);

// Where bodies on two lanes inside intersections can touch, as areas of `one`; `yields` are left for the caller. None: nowhere.
std::optional<Conflict> conflict_of(const Lane& one, const Lane& two, double clearance_m);

// Adds to graph.conflicts, which must have a place for each lane: the pairs of lanes from `first` on and before `stop`, all with an
// origin, whose centre lines come nearer to each other than `clearance_m`, except pairs with the same origin, which follow each other. Of two movements in the
// same stage of the signals the one that turns gives way: left to right and straight, right to straight.
void find_conflicts(LaneGraph& graph, double clearance_m, int first, int stop);

}  // namespace stopline
