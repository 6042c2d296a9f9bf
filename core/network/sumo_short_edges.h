// Short edges that only go on from another one, as netconvert makes before junctions with turn lanes, become its end: one cannot stop on
// 0.8 m.
#pragma once

#include "network/sumo_net.h"

namespace stopline {

// An edge below kShortEdge_m to which only one edge leads, which leads nowhere else, without a light between them, is joined to it: that
// grows by the way between them and the edge, and has its connections. SumoEdge::joined_to says so.
void join_short_edges(SumoNet& net);

inline constexpr double kShortEdge_m = 15.0;

}  // namespace stopline
