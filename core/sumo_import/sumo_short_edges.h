// Merges short edges into the edge before them. netconvert makes edges of less than 1 m before junctions with turn
// lanes, and no vehicle can stop on such an edge.
#pragma once

#include "sumo_import/sumo_net.h"

namespace stopline {

// Merges every edge shorter than kShortEdge_m into the edge before it. The edge before must be its only predecessor,
// must have no other successor, and there must be no signal in between. Every connection of the short edge needs a
// `via` lane. The edge before grows by the connecting lanes and the short edge, and takes over its connections and
// detectors. SumoEdge::merged_into of the short edge then names the edge before.
void merge_short_edges(SumoNet& net);

inline constexpr double kShortEdge_m = 15.0;

}  // namespace stopline
