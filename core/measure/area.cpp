#include "measure/area.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include "base/containers/index.h"

namespace stopline {

std::vector<AreaResult> area_series(std::span<const Detector> detectors, std::span<const Crossing> crossings,
                                    double interval_s, double end_s, double lane_m) {
    std::vector<AreaResult> series;
    const auto windows = static_cast<int>(std::floor(end_s / interval_s + 1e-9));
    for (int window = 0; window < windows; ++window) {
        series.push_back({{window * interval_s, (window + 1) * interval_s}, 0, 0.0, 0.0, 0.0});
    }
    std::unordered_map<int, double> entry_s;  // [vehicle] time of entry
    int inside = 0;
    double inside_m = 0.0;  // total length of the vehicles inside
    double now_s = 0.0;
    std::size_t k = 0;  // index of the window that contains now_s
    const auto advance = [&](double to_s) {
        while (k < series.size() && now_s < to_s) {
            const double until_s = std::min(to_s, series[k].window.to_s);
            series[k].vehicles += inside * (until_s - now_s) / interval_s;
            series[k].occupied += inside_m * (until_s - now_s) / interval_s / lane_m;
            now_s = until_s;
            if (now_s >= series[k].window.to_s) ++k;
        }
    };
    for (const Crossing& crossing : crossings) {
        const Detector& detector = detectors[at(crossing.detector)];
        if (detector.kind != Detector::Kind::zone) continue;
        advance(crossing.time_s);
        if (k == series.size()) break;
        if (!detector.leaves_zone) {
            if (!entry_s.emplace(crossing.vehicle, crossing.time_s).second) continue;
            ++inside;
            inside_m += static_cast<double>(crossing.length_m);
            continue;
        }
        const auto entry = entry_s.find(crossing.vehicle);
        if (entry == entry_s.end()) continue;
        ++series[k].exited;
        series[k].travel_time_s += crossing.time_s - entry->second;
        --inside;
        inside_m -= static_cast<double>(crossing.length_m);
        entry_s.erase(entry);
    }
    advance(end_s);
    for (AreaResult& result : series) {
        result.travel_time_s =
            result.exited > 0 ? result.travel_time_s / result.exited : std::numeric_limits<double>::quiet_NaN();
    }
    return series;
}

std::vector<OriginDestinationResult> origin_destination_results(const LaneGraph& graph,
                                                                std::span<const Detector> detectors,
                                                                std::span<const Crossing> crossings,
                                                                const TimeWindow& window) {
    std::vector<OriginDestinationResult> results;
    for (int k = 0; k < 16; ++k) results.push_back({static_cast<Side>(k / 4), static_cast<Side>(k % 4), 0, 0.0});
    struct Entry {
        double time_s;
        Side side;
    };
    std::unordered_map<int, Entry> entries;  // [vehicle]
    for (const Crossing& crossing : crossings) {
        const Detector& detector = detectors[at(crossing.detector)];
        if (detector.kind != Detector::Kind::zone) continue;
        const Lane& lane = graph.lanes[at(detector.lane)];
        if (!detector.leaves_zone) {
            entries.emplace(crossing.vehicle, Entry{crossing.time_s, comes_from(lane)});
            continue;
        }
        const auto entry = entries.find(crossing.vehicle);
        if (entry == entries.end()) continue;
        if (window.contains(crossing.time_s)) {
            const int pair = static_cast<int>(entry->second.side) * 4 + static_cast<int>(goes_to(lane));
            OriginDestinationResult& result = results[at(pair)];
            ++result.exited;
            result.travel_time_s += crossing.time_s - entry->second.time_s;
        }
        entries.erase(entry);
    }
    for (OriginDestinationResult& result : results) {
        result.travel_time_s =
            result.exited > 0 ? result.travel_time_s / result.exited : std::numeric_limits<double>::quiet_NaN();
    }
    return results;
}

std::vector<std::array<int, 4>> inflow_series(const LaneGraph& graph, std::span<const Detector> detectors,
                                              std::span<const Crossing> crossings, double interval_s, double end_s) {
    std::vector<std::array<int, 4>> series(static_cast<std::size_t>(std::floor(end_s / interval_s + 1e-9)));
    std::unordered_set<int> inside;  // ids of the vehicles inside
    for (const Crossing& crossing : crossings) {
        const Detector& detector = detectors[at(crossing.detector)];
        if (detector.kind != Detector::Kind::zone) continue;
        if (detector.leaves_zone) {
            inside.erase(crossing.vehicle);
            continue;
        }
        if (!inside.insert(crossing.vehicle).second) continue;
        const auto window = static_cast<std::size_t>(crossing.time_s / interval_s);
        const Side from = comes_from(graph.lanes[at(detector.lane)]);
        if (window < series.size()) ++series[window][static_cast<std::size_t>(from)];
    }
    return series;
}

}  // namespace stopline
