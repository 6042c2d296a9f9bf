#include "network/lane_graph.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/input_error.h"

namespace stopline {

LaneGraph make_approach(const ApproachSettings& s) {
    constexpr double kLaneWidth_m = 3.5;
    LaneGraph graph;
    graph.signal_groups = 1;
    for (int k = 0; k < s.lanes; ++k) {
        const double y = -k * kLaneWidth_m;
        const int entry = 2 * k;
        Lane in;
        in.name = fmt::format("approach_{}", k);
        in.length_m = in.stop_line_m = s.length_m;
        in.limit_mps = s.speed_limit_mps;
        in.gradient = s.gradient;
        in.signal_group = 0;
        in.next = {entry + 1};
        in.shape = {{-s.length_m, y}, {0.0, y}};
        Lane out;
        out.name = fmt::format("exit_{}", k);
        out.length_m = s.exit_length_m;
        out.limit_mps = s.speed_limit_mps;
        out.gradient = s.gradient;
        out.shape = {{0.0, y}, {s.exit_length_m, y}};
        graph.lanes.push_back(in);
        graph.lanes.push_back(out);
        graph.routes.push_back({fmt::format("straight_{}", k), {entry, entry + 1}});
        graph.entries.push_back(entry);
    }
    return graph;
}

const std::vector<Conflict>& LaneGraph::conflicts_of(int lane) const {
    static const std::vector<Conflict> kNone;
    return conflicts.empty() ? kNone : conflicts[static_cast<std::size_t>(lane)];
}

void check(const LaneGraph& graph) {
    const auto lanes = static_cast<int>(graph.lanes.size());
    const auto known = [lanes](int lane) { return lane >= 0 && lane < lanes; };
    for (const Lane& lane : graph.lanes) {
        const bool sound = lane.length_m > 0.0 && lane.limit_mps > 0.0 && lane.signal_group < graph.signal_groups &&
                           lane.stop_line_m <= lane.length_m && std::all_of(lane.next.begin(), lane.next.end(), known);
        if (!sound)
            throw InputError(fmt::format("lane '{}': length, limit, signal or next lane is not usable", lane.name));
    }
    for (const Route& route : graph.routes) {
        if (route.lanes.empty()) throw InputError(fmt::format("route '{}' is empty", route.name));
        if (!std::all_of(route.lanes.begin(), route.lanes.end(), known)) {
            throw InputError(fmt::format("route '{}' names a lane that does not exist", route.name));
        }
        const int last = route.lanes.back();
        const bool goes_on = std::find(graph.links.begin(), graph.links.end(), last) != graph.links.end();
        if (!graph.lanes[static_cast<std::size_t>(last)].next.empty() && !goes_on) {
            throw InputError(fmt::format("route '{}' ends on a lane that leads on", route.name));
        }
        for (std::size_t k = 1; k < route.lanes.size(); ++k) {
            const Lane& from = graph.lanes[static_cast<std::size_t>(route.lanes[k - 1])];
            if (std::find(from.next.begin(), from.next.end(), route.lanes[k]) == from.next.end()) {
                throw InputError(fmt::format("route '{}': lane '{}' does not lead to lane {}", route.name, from.name,
                                             route.lanes[k]));
            }
        }
    }
}

}  // namespace stopline
