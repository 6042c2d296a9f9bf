#include "measure/area.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <unordered_set>

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// 0: east, 1: north, 2: west, 3: south.
int heading(const Lane& lane) {
    const Point from = lane.shape.front();
    const Point to = lane.shape.back();
    const double x_m = to.x_m - from.x_m;
    const double y_m = to.y_m - from.y_m;
    if (std::abs(x_m) >= std::abs(y_m)) return x_m >= 0.0 ? 0 : 2;
    return y_m >= 0.0 ? 1 : 3;
}

constexpr std::array<Side, 4> kBehind{Side::west, Side::south, Side::east, Side::north};

}  // namespace

Side comes_from(const Lane& lane) { return kBehind[at(heading(lane))]; }
Side goes_to(const Lane& lane) { return kBehind[at((heading(lane) + 2) % 4)]; }

std::vector<AreaFigures> area_series(std::span<const Detector> detectors, std::span<const Crossing> crossings,
                                     double interval_s, double end_s, double lane_m) {
    std::vector<AreaFigures> series;
    const auto windows = static_cast<int>(std::floor(end_s / interval_s + 1e-9));
    for (int window = 0; window < windows; ++window) {
        series.push_back({{window * interval_s, (window + 1) * interval_s}, 0, 0.0, 0.0, 0.0});
    }
    std::unordered_map<int, double> since_s;  // by vehicle
    int inside = 0;
    double metres = 0.0;
    double now_s = 0.0;
    std::size_t k = 0;  // the window that now_s is in
    const auto advance = [&](double to_s) {
        while (k < series.size() && now_s < to_s) {
            const double until_s = std::min(to_s, series[k].window.to_s);
            series[k].vehicles += inside * (until_s - now_s) / interval_s;
            series[k].occupied += metres * (until_s - now_s) / interval_s / lane_m;
            now_s = until_s;
            if (now_s >= series[k].window.to_s) ++k;
        }
    };
    for (const Crossing& crossing : crossings) {
        const Detector& detector = detectors[at(crossing.detector)];
        if (detector.kind != Detector::Kind::zone) continue;
        advance(crossing.time_s);
        if (k == series.size()) break;
        if (!detector.leaves) {
            if (!since_s.emplace(crossing.vehicle, crossing.time_s).second) continue;
            ++inside;
            metres += static_cast<double>(crossing.length_m);
            continue;
        }
        const auto visit = since_s.find(crossing.vehicle);
        if (visit == since_s.end()) continue;
        ++series[k].left;
        series[k].travel_time_s += crossing.time_s - visit->second;
        --inside;
        metres -= static_cast<double>(crossing.length_m);
        since_s.erase(visit);
    }
    advance(end_s);
    for (AreaFigures& each : series) {
        each.travel_time_s = each.left > 0 ? each.travel_time_s / each.left : std::numeric_limits<double>::quiet_NaN();
    }
    return series;
}

std::vector<WayFigures> way_figures(const Model& model, std::span<const Crossing> crossings, const TimeWindow& window) {
    std::vector<WayFigures> ways;
    for (int way = 0; way < 16; ++way) ways.push_back({static_cast<Side>(way / 4), static_cast<Side>(way % 4), 0, 0.0});
    struct Entry {
        double time_s;
        Side side;
    };
    std::unordered_map<int, Entry> entries;  // by vehicle
    for (const Crossing& crossing : crossings) {
        const Detector& detector = model.detectors[at(crossing.detector)];
        if (detector.kind != Detector::Kind::zone) continue;
        const Lane& lane = model.graph.lanes[at(detector.lane)];
        if (!detector.leaves) {
            entries.emplace(crossing.vehicle, Entry{crossing.time_s, comes_from(lane)});
            continue;
        }
        const auto entry = entries.find(crossing.vehicle);
        if (entry == entries.end()) continue;
        if (window.contains(crossing.time_s)) {
            WayFigures& way = ways[at(static_cast<int>(entry->second.side) * 4 + static_cast<int>(goes_to(lane)))];
            ++way.left;
            way.travel_time_s += crossing.time_s - entry->second.time_s;
        }
        entries.erase(entry);
    }
    for (WayFigures& way : ways) {
        way.travel_time_s = way.left > 0 ? way.travel_time_s / way.left : std::numeric_limits<double>::quiet_NaN();
    }
    return ways;
}

std::vector<std::array<int, 4>> inflow_series(const Model& model, std::span<const Crossing> crossings,
                                              double interval_s, double end_s) {
    std::vector<std::array<int, 4>> series(static_cast<std::size_t>(std::floor(end_s / interval_s + 1e-9)));
    std::unordered_set<int> inside;  // vehicles
    for (const Crossing& crossing : crossings) {
        const Detector& detector = model.detectors[at(crossing.detector)];
        if (detector.kind != Detector::Kind::zone) continue;
        if (detector.leaves) {
            inside.erase(crossing.vehicle);
            continue;
        }
        if (!inside.insert(crossing.vehicle).second) continue;
        const auto window = static_cast<std::size_t>(crossing.time_s / interval_s);
        const Side from = comes_from(model.graph.lanes[at(detector.lane)]);
        if (window < series.size()) ++series[window][static_cast<std::size_t>(from)];
    }
    return series;
}

}  // namespace stopline
