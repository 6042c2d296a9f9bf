// Merges short edges into the edge before them. netconvert makes edges of less than 1 m before junctions with turn
// lanes, and no vehicle can stop on such an edge.
#pragma once

#include "sumo_import/sumo_net.h"

namespace stopline {

// Merges edges shorter than kShortEdge_m into the edge before them. A short edge is merged only if it has a single
// predecessor, this predecessor has no other successor, and neither a signal nor a U-turn is between the two edges. No
// other car traffic may cross in the junction between them, because the merged lane has no conflict areas. Every
// connection that leaves the short edge must have an internal lane (`via`). It must also begin on a lane that the
// predecessor leads to, because the predecessor could not take it over otherwise. The internal lanes to the short edge
// and the short edge itself become the last part of the predecessor. The predecessor also takes over the connections
// and detectors of the short edge. SumoEdge::merged_into of the short edge is set to the index of the predecessor.
void merge_short_edges(SumoNet& net);

inline constexpr double kShortEdge_m = 15.0;

}  // namespace stopline
