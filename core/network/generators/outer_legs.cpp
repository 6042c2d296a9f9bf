#include "network/generators/outer_legs.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "network/generators/street_layout.h"

namespace stopline {

namespace {

std::vector<OuterLeg> street_legs(const StreetSettings& streets) {
    const StreetLayout layout(streets);
    std::vector<OuterLeg> legs;
    for (int n = 0; n < layout.nodes(); ++n) {
        const StreetIntersection& node = layout.node(n);
        for (std::size_t k = 0; k < node.legs.size(); ++k) {
            const StreetLeg& leg = node.legs[k];
            const auto* const side = std::find(kSides.begin(), kSides.end(), leg.from);
            if (layout.neighbour(n, static_cast<int>(side - kSides.begin())) >= 0) continue;
            const std::string field = fmt::format("network.streets.intersections[{}].legs[{}]", node.name, k);
            legs.push_back({field + ".length", field + ".exit_length", leg.speed_limit_mps,
                            leg.lanes.empty() ? 0.0 : leg.length_m, leg.exits == 0 ? 0.0 : leg.exit_length_m});
        }
    }
    return legs;
}

}  // namespace

std::vector<OuterLeg> outer_legs(const NetworkSettings& network) {
    if (network.is_sumo()) return {};
    if (network.is_streets()) return street_legs(network.streets);
    if (network.kind == "approach") {
        const ApproachSettings& road = network.approach;
        return {{"network.approach.length", "network.approach.exit_length", road.speed_limit_mps, road.length_m,
                 road.exit_length_m}};
    }
    const IntersectionSettings& layout = network.intersection;
    return {{"network.intersection.approach_length", "network.intersection.exit_length", layout.speed_limit_mps,
             layout.approach_length_m, layout.exit_length_m}};
}

}  // namespace stopline
