#include "scenario/make_network.h"

#include <cstddef>

#include "sumo_import/sumo_graph.h"

namespace stopline {

LaneGraph make_network(const NetworkSettings& network) {
    if (network.is_sumo()) return network.sumo->graph;
    if (network.is_streets()) return make_streets(network.streets);
    if (network.kind == "grid") return make_grid(network.grid, network.intersection);
    if (network.kind == "intersection") return make_intersection(network.intersection);
    return make_approach(network.approach);
}

double radius_beyond_m(const NetworkSettings& network, const Lane& lane) {
    if (network.is_sumo()) return 0.0;
    constexpr int kGroupsPerIntersection = 3;  // signal groups of one intersection of streets, see make_streets()
    if (!network.is_streets()) return network.intersection.radius_m;
    return network.streets.intersections[static_cast<std::size_t>(lane.signal_group / kGroupsPerIntersection)].radius_m;
}

}  // namespace stopline
