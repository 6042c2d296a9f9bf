#include "network/lane_graph.h"

#include <algorithm>
#include <cmath>

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
    static const std::vector<Conflict> kNoConflicts;
    return conflicts.empty() ? kNoConflicts : conflicts[static_cast<std::size_t>(lane)];
}

namespace {

// Throws InputError unless the lanes of the approach are linked as neighbours in the order of Approach::lanes, their
// stop lines lie side by side, and the turn shares are valid.
void check_approach(const LaneGraph& graph, int index) {
    const Approach& approach = graph.approaches[static_cast<std::size_t>(index)];
    const auto count = static_cast<int>(graph.lanes.size());
    int left = -1;
    double end_m = 0.0;
    for (std::size_t k = 0; k < approach.lanes.size(); ++k) {
        const int number = approach.lanes[k];
        if (number < 0 || number >= count) {
            throw InputError(fmt::format("approach '{}' has lane {}, which does not exist", approach.name, number));
        }
        const Lane& lane = graph.lanes[static_cast<std::size_t>(number)];
        if (k == 0) end_m = lane.start_offset_m + lane.stop_line_m;
        const bool last = k + 1 == approach.lanes.size();
        if (lane.approach != index || lane.left != left || lane.right != (last ? -1 : approach.lanes[k + 1])) {
            throw InputError(fmt::format("approach '{}': the neighbours of lane '{}' are not those of its approach",
                                         approach.name, lane.name));
        }
        if (!(lane.start_offset_m >= 0.0) || std::abs(lane.start_offset_m + lane.stop_line_m - end_m) > 1e-6) {
            throw InputError(fmt::format("approach '{}': the stop line of lane '{}' is not beside the others",
                                         approach.name, lane.name));
        }
        left = number;
    }
    const bool shares = approach.right_share >= 0.0 && approach.left_share >= 0.0 &&
                        approach.right_share + approach.left_share <= 1.0 + 1e-9;
    if (!shares) {
        throw InputError(
            fmt::format("approach '{}': turn shares must be at least 0 and sum to at most 1", approach.name));
    }
}

void check_approaches(const LaneGraph& graph) {
    const auto approaches = static_cast<int>(graph.approaches.size());
    for (int index = 0; index < approaches; ++index) check_approach(graph, index);
    for (int number = 0; number < static_cast<int>(graph.lanes.size()); ++number) {
        const Lane& lane = graph.lanes[static_cast<std::size_t>(number)];
        const bool beside = lane.left >= 0 || lane.right >= 0;
        if (lane.approach < 0 && !beside) continue;
        const bool known = lane.approach >= 0 && lane.approach < approaches;
        const std::vector<int> none;
        const std::vector<int>& lanes = known ? graph.approaches[static_cast<std::size_t>(lane.approach)].lanes : none;
        if (std::find(lanes.begin(), lanes.end(), number) == lanes.end()) {
            throw InputError(fmt::format("lane '{}' is not among the lanes of its approach", lane.name));
        }
    }
    const auto groups = static_cast<std::size_t>(graph.signal_groups);
    if (!graph.stage_of.empty() && graph.stage_of.size() != groups) {
        throw InputError("either every signal group has a stage, or none");
    }
}

}  // namespace

void check(const LaneGraph& graph) {
    const auto lanes = static_cast<int>(graph.lanes.size());
    const auto known = [lanes](int lane) { return lane >= 0 && lane < lanes; };
    std::vector<bool> is_link(graph.lanes.size(), false);
    for (const int link : graph.links) {
        if (!known(link)) throw InputError(fmt::format("link lane {} does not exist", link));
        is_link[static_cast<std::size_t>(link)] = true;
    }
    for (const Lane& lane : graph.lanes) {
        const bool sound = lane.length_m > 0.0 && lane.limit_mps > 0.0 && lane.signal_group < graph.signal_groups &&
                           lane.stop_line_m <= lane.length_m && std::all_of(lane.next.begin(), lane.next.end(), known);
        if (!sound) {
            throw InputError(fmt::format(
                "lane '{}': the length, speed limit, signal group, stop line or a successor is invalid", lane.name));
        }
    }
    for (const Route& route : graph.routes) {
        if (route.lanes.empty()) throw InputError(fmt::format("route '{}' is empty", route.name));
        if (!std::all_of(route.lanes.begin(), route.lanes.end(), known)) {
            throw InputError(fmt::format("route '{}' has a lane that does not exist", route.name));
        }
        const int last = route.lanes.back();
        const bool ends_on_link = is_link[static_cast<std::size_t>(last)];
        if (!graph.lanes[static_cast<std::size_t>(last)].next.empty() && !ends_on_link) {
            throw InputError(fmt::format("route '{}' ends on a lane that has successors and is no link", route.name));
        }
        for (std::size_t k = 1; k < route.lanes.size(); ++k) {
            const Lane& from = graph.lanes[static_cast<std::size_t>(route.lanes[k - 1])];
            if (std::find(from.next.begin(), from.next.end(), route.lanes[k]) == from.next.end()) {
                throw InputError(fmt::format("route '{}': lane '{}' does not lead to lane {}", route.name, from.name,
                                             route.lanes[k]));
            }
        }
    }
    check_approaches(graph);
}

}  // namespace stopline
