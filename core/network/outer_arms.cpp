#include "network/outer_arms.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "network/street_layout.h"

namespace stopline {

namespace {

std::vector<OuterArm> arms_of_streets(const StreetSettings& streets) {
    const StreetLayout layout(streets);
    std::vector<OuterArm> arms;
    for (int n = 0; n < layout.nodes(); ++n) {
        const StreetIntersection& node = layout.node(n);
        for (std::size_t a = 0; a < node.arms.size(); ++a) {
            const StreetArm& arm = node.arms[a];
            const auto* const side = std::find(kSides.begin(), kSides.end(), arm.from);
            if (layout.neighbour(n, static_cast<int>(side - kSides.begin())) >= 0) continue;
            const std::string field = fmt::format("network.streets.intersections[{}].arms[{}]", node.name, a);
            arms.push_back({field + ".length", field + ".exit_length", arm.speed_limit_mps,
                            arm.lanes.empty() ? 0.0 : arm.length_m, arm.exits == 0 ? 0.0 : arm.exit_length_m});
        }
    }
    return arms;
}

}  // namespace

std::vector<OuterArm> outer_arms(const NetworkSettings& network) {
    if (network.is_sumo()) return {};
    if (network.is_streets()) return arms_of_streets(network.streets);
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
