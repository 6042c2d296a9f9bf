#include "measure/discharge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/nan.h"

namespace stopline {

namespace {

// Number of vehicles at the front of the queue whose headways determine the lost time.
constexpr std::size_t kLostPositions = 4;

// The headways of the queue of one green.
struct Green {
    double start_s = -1.0;
    double last_s = 0.0;  // time of the last passage, or the start of green
    bool queue_ended = false;
    std::vector<double> headways_s;

    bool is_saturated() const { return headways_s.size() > kLostPositions; }
};

// Sums over saturated greens, which are greens with a queue of five vehicles or more.
struct SaturatedSums {
    double later_s = 0.0;  // headways from the fifth vehicle on
    int later = 0;         // number of these headways
    double first_s = 0.0;  // headways of the first four vehicles
    int greens = 0;

    void add(const Green& green) {
        if (!green.is_saturated()) return;
        ++greens;
        for (std::size_t k = 0; k < green.headways_s.size(); ++k) {
            (k < kLostPositions ? first_s : later_s) += green.headways_s[k];
            later += k < kLostPositions ? 0 : 1;
        }
    }
    double saturation_headway_s() const { return later > 0 ? later_s / later : kNan; }
    double lost_time_s() const { return first_s / greens - kLostPositions * saturation_headway_s(); }
};

LaneDischarge lane_discharge(const std::string& name, const std::vector<Green>& greens, SaturatedSums& all) {
    LaneDischarge result;
    result.lane = name;
    SaturatedSums sums;
    for (const Green& green : greens) {
        const std::size_t positions = std::max(result.samples.size(), green.headways_s.size());
        result.headway_s.resize(positions, 0.0);
        result.samples.resize(positions, 0);
        for (std::size_t k = 0; k < green.headways_s.size(); ++k) {
            result.headway_s[k] += green.headways_s[k];
            ++result.samples[k];
        }
        sums.add(green);
        all.add(green);
    }
    for (std::size_t k = 0; k < result.headway_s.size(); ++k) result.headway_s[k] /= result.samples[k];
    result.saturated_greens = sums.greens;
    result.saturation_headway_s = sums.saturation_headway_s();
    result.startup_lost_time_s = sums.greens > 0 ? sums.lost_time_s() : kNan;
    return result;
}

// Sets the values of `result` that describe all lanes together. `all` holds the sums over all lanes, and result.lanes
// holds the values of each single lane.
void summarise(const SaturatedSums& all, Discharge& result) {
    result.saturated_greens = all.greens;
    result.saturation_headway_s = all.saturation_headway_s();
    result.saturation_flow_veh_h = 3600.0 / result.saturation_headway_s;
    result.startup_lost_time_s = all.greens > 0 ? 0.0 : kNan;
    for (const LaneDischarge& lane : result.lanes) {
        if (lane.saturated_greens == 0) continue;
        result.startup_lost_time_s += lane.startup_lost_time_s * lane.saturated_greens / all.greens;
    }
}

}  // namespace

Discharge discharge(const LaneGraph& graph, std::span<const Detector> detectors, std::span<const Crossing> crossings,
                    const TimeWindow& window, const LatestGreenStart& latest_green_start_s, double cycle_s,
                    const HasQueued& has_queued) {
    Discharge result;
    std::vector<std::vector<Green>> greens_of(detectors.size());
    int vehicles = 0;
    for (const Crossing& crossing : crossings) {
        const auto d = static_cast<std::size_t>(crossing.detector);
        const Detector& detector = detectors[d];
        if (detector.kind != Detector::Kind::stop_line || !window.contains(crossing.time_s)) continue;
        ++vehicles;
        const int signal_group = graph.lanes[static_cast<std::size_t>(detector.lane)].signal_group;
        const double start_s = latest_green_start_s(signal_group, crossing.time_s);
        if (start_s < window.from_s) continue;
        std::vector<Green>& greens = greens_of[d];
        if (greens.empty() || start_s > greens.back().start_s) greens.push_back({start_s, start_s, false, {}});
        Green& green = greens.back();
        green.queue_ended = green.queue_ended || !has_queued(crossing.vehicle);
        if (green.queue_ended) continue;
        green.headways_s.push_back(crossing.time_s - green.last_s);
        green.last_s = crossing.time_s;
    }
    SaturatedSums all;
    for (std::size_t d = 0; d < detectors.size(); ++d) {
        if (detectors[d].kind != Detector::Kind::stop_line) continue;
        result.lanes.push_back(
            lane_discharge(graph.lanes[static_cast<std::size_t>(detectors[d].lane)].name, greens_of[d], all));
    }
    result.greens = static_cast<int>(std::lround(window.length_s() / cycle_s));
    result.vehicles_per_green =
        static_cast<double>(vehicles) / static_cast<double>(result.lanes.size()) / (window.length_s() / cycle_s);
    summarise(all, result);
    return result;
}

}  // namespace stopline
