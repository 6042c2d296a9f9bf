#include "record/lane_names.h"

#include <algorithm>

#include "base/containers/index.h"
#include "base/io/escape.h"
#include "record/xml_file.h"

namespace stopline {

LaneNames::LaneNames(const LaneGraph& graph, Style style) {
    for (const Lane& lane : graph.lanes) {
        Entry& entry = lanes_.emplace_back();
        entry.has_stop_line = lane.signal_group >= 0;
        entry.start_m = lane.origin >= 0 ? lane.shape_start_m : 0.0;
        entry.length_m = lane.length_m;
        entry.end_m = entry.has_stop_line ? lane.stop_line_m : lane.length_m;
        if (lane.origin >= 0) entry.exit = lane.next.front();
        for (const LanePart& part : lane.parts) {
            entry.parts.push_back(
                {style == Style::sumo ? escape_xml(part.name) : part.name, part.end_m, part.length_m});
        }
        if (!entry.parts.empty()) continue;
        const double length_m = entry.start_m + entry.end_m;
        entry.parts.push_back({style == Style::sumo ? sumo_lane_name(lane) : lane.name, length_m, length_m});
    }
}

LaneNames::Place LaneNames::place(int lane, double position_m) const {
    const std::vector<Part>& parts = lanes_[at(lane)].parts;
    double start_m = 0.0;
    std::size_t k = 0;
    for (; k + 1 < parts.size() && position_m > parts[k].end_m; ++k) start_m = parts[k].end_m;
    const double extent_m = parts[k].end_m - start_m;
    const double scale = extent_m > 0.0 ? parts[k].length_m / extent_m : 0.0;
    return {parts[k].name, std::clamp((position_m - start_m) * scale, 0.0, parts[k].length_m)};
}

LaneNames::Place LaneNames::front(const State& state, int lane, std::size_t slot) const {
    const Entry& entry = lanes_[at(lane)];
    const double position_m = state.vehicles.position_m[slot];
    const int next = state.vehicles.next_lane[slot];
    if (entry.has_stop_line && position_m > entry.end_m && next >= 0) return place(next, position_m - entry.end_m);
    return place(lane, entry.start_m + position_m);
}

LaneNames::Place LaneNames::end(int lane) const {
    const int last = lanes_[at(lane)].exit >= 0 ? lanes_[at(lane)].exit : lane;
    return place(last, lanes_[at(last)].end_m);
}

double LaneNames::to_end_m(int lane, double position_m) const {
    const Entry& entry = lanes_[at(lane)];
    if (entry.exit < 0) return entry.end_m - position_m;
    return entry.length_m - position_m + lanes_[at(entry.exit)].end_m;
}

}  // namespace stopline
