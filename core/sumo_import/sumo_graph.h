// Turns a SUMO network into a LaneGraph.
//
// - Every lane open to cars becomes a lane with SUMO's name and length. The lanes of an edge form an approach.
// - Every connection becomes one lane inside an intersection. If SUMO splits the connection into several internal
//   lanes, the import joins them.
// - Connections that begin on the same lane have a common first stretch. This stretch becomes part of the lane, as in
//   generated networks.
// - netconvert draws a U-turn directly at the end of its lane. The import extends a U-turn into the junction by a few
//   metres, if the U-turn would otherwise be shorter than the first stretch that the other connections share.
// - SUMO calls a connection through a junction a link. Conflict areas are computed from the shapes of links. They can
//   exist between links that are foes in SUMO's matrix, between links to the same lane, and between a U-turn and any
//   other link.
// - Right of way follows SUMO's matrix `response`. Between two links of the same signal it follows the letters of the
//   present phase: if both are green, a link with the letter 'g' yields to a link with the letter 'G', and the matrix
//   decides between equal letters. If not both are green, the right of way of the phase before remains. Links that are
//   never green together do not yield to each other.
// - If an approach has connections, each of its lanes has a stop line. Stop lines without a signal belong to signal
//   group 0, which is always green.
// - If a lane is too short for a vehicle to brake to a stop before the signal or the conflict area at the end of the
//   lane, the connections to this lane get a lower speed limit v, but not below 3 m/s. A vehicle that enters with v and
//   brakes with the deceleration b can stop in time: v^2 = 2 b (length - margin).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "network/lane_graph.h"
#include "signals/phase_priority.h"
#include "sumo_import/sumo_net.h"

namespace stopline {

// The link of a SUMO signal whose lights a signal group shows. If several links have the same lights in all phases,
// they share the group, and this is the first of them.
struct SumoLight {
    int signal = -1;  // index in SumoNet::signals; -1: always green
    int link = 0;     // index of the letter in SumoPhase::state
};

// The right of way between two connections of one signal, if it changes with the phases.
struct SumoPhasePriority {
    int signal = -1;                 // index in SumoNet::signals
    int first = -1;                  // lane of the graph
    int second = -1;                 // lane of the graph
    std::vector<Priority> by_phase;  // [phase]
};

struct SumoNetwork {
    SumoNet net;
    LaneGraph graph;
    std::vector<SumoLight> lights;  // [signal group]
    std::vector<SumoPhasePriority> phase_priorities;
    std::vector<std::vector<int>> lane_of;  // [edge][index] lane of the graph; -1: closed to cars, or inside a junction
    std::vector<int> approach_of;           // [edge] approach of the graph; -1: closed to cars, or inside a junction

    // Returns the longest signal cycle, or 90 s if there are no signals.
    double longest_cycle_s() const;
    // Returns the longest green time. Links that are always green are ignored. Returns 40 s if there is no green time.
    double longest_green_s() const;
};

// Builds the lane graph. Two connections can conflict only where their centre lines come closer than `clearance_m`.
// Throws InputError with file and line if the network cannot be converted.
SumoNetwork make_sumo_network(SumoNet net, double clearance_m);

// Returns true for the signal letters at which vehicles may go: G, g, s, o, O.
bool sumo_is_green(char letter);

}  // namespace stopline
