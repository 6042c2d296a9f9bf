#include "measure/headways.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/nan.h"

namespace stopline {

namespace {

bool is_stop_line(const LaneGraph& graph, int lane) {
    return lane >= 0 && graph.lanes[static_cast<std::size_t>(lane)].signal_group >= 0;
}

}  // namespace

std::vector<LinePassage> line_passages(const LaneGraph& graph, const std::vector<Passage>& passages,
                                       double green_start_s) {
    std::vector<LinePassage> at_line;
    for (const Passage& passage : passages) {
        const double time_s = passage.time_s - green_start_s;
        if (!is_stop_line(graph, passage.from_lane) || time_s < 0.0) continue;
        at_line.push_back(
            {time_s, passage.from_lane, 1, passage.vehicle, passage.policy, double{passage.speed_mps}, kNan});
    }
    std::stable_sort(at_line.begin(), at_line.end(), [](const LinePassage& a, const LinePassage& b) {
        return a.lane != b.lane ? a.lane < b.lane : a.time_s < b.time_s;
    });
    for (std::size_t k = 1; k < at_line.size(); ++k) {
        if (at_line[k].lane != at_line[k - 1].lane) continue;
        at_line[k].position = at_line[k - 1].position + 1;
        at_line[k].headway_s = at_line[k].time_s - at_line[k - 1].time_s;
    }
    return at_line;
}

std::vector<LinePassage> within_green(const std::vector<LinePassage>& passages, double green_s) {
    std::vector<LinePassage> early;
    std::copy_if(passages.begin(), passages.end(), std::back_inserter(early),
                 [&](const LinePassage& passage) { return passage.time_s <= green_s; });
    return early;
}

LastPositionsFlow last_positions_flow(const std::vector<LinePassage>& passages, int positions) {
    std::vector<double> headways_s;
    std::vector<double> speeds_mps;
    for (std::size_t k = 0; k < passages.size(); ++k) {
        const std::size_t ahead = k + static_cast<std::size_t>(positions);
        const bool late = ahead >= passages.size() || passages[ahead].lane != passages[k].lane;
        if (!late || std::isnan(passages[k].headway_s)) continue;
        headways_s.push_back(passages[k].headway_s);
        speeds_mps.push_back(passages[k].speed_mps);
    }
    return {static_cast<int>(headways_s.size()), mean(headways_s), mean(speeds_mps)};
}

double mean(std::span<const double> values) {
    if (values.empty()) return kNan;
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

}  // namespace stopline
