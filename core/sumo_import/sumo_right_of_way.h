// Conflict areas and right of way of an imported network, from the junctions' matrices, the signal programmes and the
// shapes. Used by sumo_graph.cpp.
#pragma once

#include <vector>

#include "sumo_import/sumo_graph.h"

namespace stopline {

// A connection between two edges while it is turned into a lane inside an intersection.
struct BuiltConnection {
    const SumoConnection* source = nullptr;
    Polyline shape = {};
    double speed_mps = 0.0;
    int junction = -1;  // index in SumoNet::junctions; -1: unknown
    int link = -1;      // row in the matrices of the junction; -1: unknown
    Turn turn = Turn::none;
    int lane = -1;  // index in the lane graph
};

// Fills graph.conflicts and the right-of-way members of the connections' lanes, which must be in the graph.
void find_sumo_conflicts(SumoNetwork& network, std::vector<BuiltConnection>& connections, double clearance_m);

}  // namespace stopline
