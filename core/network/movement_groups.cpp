#include "network/movement_groups.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "network/side.h"

namespace stopline {

namespace {

constexpr int kGroupsBefore = 2;  // signal groups of an intersection in a new graph
constexpr std::array kTurns{Turn::straight, Turn::right, Turn::left};

const char* turn_name(Turn turn) { return turn == Turn::left ? "left" : turn == Turn::right ? "right" : "straight"; }

std::string name_of(Side side, Turn turn) {
    return fmt::format("{}_{}", kSideNames[static_cast<std::size_t>(side)], turn_name(turn));
}

}  // namespace

std::string movement_name(const LaneGraph& graph, int connection) {
    const Lane& lane = graph.lanes[at(connection)];
    return name_of(comes_from(graph.lanes[at(lane.origin)]), lane.turn);
}

std::vector<std::string> movement_names(const IntersectionSettings& intersection) {
    std::vector<std::string> names;
    for (const Side side : {Side::west, Side::south, Side::east, Side::north}) {
        for (const Turn turn : kTurns) {
            const bool exists = std::any_of(intersection.lanes.begin(), intersection.lanes.end(),
                                            [&](const auto& lane) { return lane.allows(turn_name(turn)); });
            if (exists) names.push_back(name_of(side, turn));
        }
    }
    return names;
}

void assign_movement_groups(LaneGraph& graph, const std::vector<std::string>& movements,
                            const std::vector<int>& groups) {
    const int count = *std::max_element(groups.begin(), groups.end()) + 1;
    graph.signal_groups = graph.signal_groups / kGroupsBefore * count;
    const auto group_of = [&](int connection, int intersection) {
        const auto found = std::find(movements.begin(), movements.end(), movement_name(graph, connection));
        return intersection * count + groups[static_cast<std::size_t>(found - movements.begin())];
    };
    for (Lane& lane : graph.lanes) {
        if (lane.signal_group < 0) continue;
        const int intersection = lane.signal_group / kGroupsBefore;
        std::vector<int> of_lane;
        for (const int connection : lane.next) of_lane.push_back(group_of(connection, intersection));
        lane.signal_group = of_lane.front();
        if (std::count(of_lane.begin(), of_lane.end(), of_lane.front()) == std::ssize(of_lane)) continue;
        for (std::size_t k = 0; k < of_lane.size(); ++k) {
            graph.lanes[at(lane.next[k])].movement_signal_group = of_lane[k];
        }
    }
}

}  // namespace stopline
