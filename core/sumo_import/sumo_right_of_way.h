// Finds conflict areas and right of way of an imported network from the shapes of connections, the right-of-way
// matrices of junctions, and the signal programmes. Only sumo_graph.cpp uses it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sumo_import/sumo_graph.h"

namespace stopline {

// A connection between two edges, and the data from which the import makes its lane inside an intersection.
struct BuiltConnection {
    const SumoConnection* source = nullptr;
    Polyline shape = {};
    std::vector<std::pair<std::string, double>> internal_lanes = {};  // ids and lengths, in driving order
    double speed_mps = 0.0;
    int junction = -1;  // index in SumoNet::junctions; -1: unknown
    int link = -1;      // row in the right-of-way matrices of the junction; -1: unknown
    Turn turn = Turn::none;
    int lane = -1;  // index in the lane graph
};

// Sets graph.conflicts and network.phase_priorities, and `waits_inside`, `stop_rule` and `keep_clear` of the lanes of
// all connections. These lanes must be in the graph already. Also sets junction and link of connections without
// internal lanes.
void find_sumo_conflicts(SumoNetwork& network, std::vector<BuiltConnection>& connections, double clearance_m);

}  // namespace stopline
