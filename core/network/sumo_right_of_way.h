// Conflicts of an imported network, from the junctions' matrices, the programmes and the shapes. Used by sumo_graph.cpp.
#pragma once

#include <vector>

#include "network/sumo_graph.h"

namespace stopline {

// A connection between two edges on its way to become a lane inside an intersection.
struct SumoWay {
    const SumoConnection* connection = nullptr;
    Polyline shape = {};
    double speed_mps = 0.0;
    int junction = -1;  // of SumoNet::junctions, and link of its matrix; -1: unknown
    int link = -1;
    Turn turn = Turn::none;
    int lane = -1;  // of the graph
};

// Fills graph.conflicts of all ways, whose lanes are in the graph.
void find_sumo_conflicts(SumoNetwork& made, std::vector<SumoWay>& ways, double clearance_m);

}  // namespace stopline
