#include "measure/discharge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace stopline {

namespace {

// Number of vehicles at the front of the queue whose headways determine the lost time.
constexpr std::size_t kLostPositions = 4;

// The latest green of a lane.
struct Green {
    double start_s = -1.0;
    double last_s = 0.0;       // time of the latest passage; before the first passage, the start of green
    std::size_t position = 0;  // queue position of the vehicle that passes next
};

// Computes saturation headway, saturation flow and lost time from the mean headways.
void summarise(Discharge& result) {
    double sum_s = 0.0;
    int samples = 0;
    for (std::size_t k = kLostPositions; k < result.headway_s.size(); ++k) {
        sum_s += result.headway_s[k] * result.samples[k];
        samples += result.samples[k];
    }
    result.saturation_headway_s = samples > 0 ? sum_s / samples : std::numeric_limits<double>::quiet_NaN();
    result.saturation_flow_veh_h = 3600.0 / result.saturation_headway_s;
    if (samples == 0) result.startup_lost_time_s = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t k = 0; k < std::min(kLostPositions, result.headway_s.size()); ++k) {
        result.startup_lost_time_s += result.headway_s[k] - result.saturation_headway_s;
    }
}

}  // namespace

Discharge discharge(const LaneGraph& graph, std::span<const Detector> detectors, std::span<const Crossing> crossings,
                    const TimeWindow& window, const LatestGreenStart& latest_green_start_s, double cycle_s) {
    Discharge result;
    std::vector<Green> greens(detectors.size());
    int vehicles = 0;
    int lanes = 0;
    for (const Detector& detector : detectors) lanes += detector.kind == Detector::Kind::stop_line ? 1 : 0;
    for (const Crossing& crossing : crossings) {
        const auto d = static_cast<std::size_t>(crossing.detector);
        const Detector& detector = detectors[d];
        if (detector.kind != Detector::Kind::stop_line || !window.contains(crossing.time_s)) continue;
        const int signal_group = graph.lanes[static_cast<std::size_t>(detector.lane)].signal_group;
        ++vehicles;
        Green& green = greens[d];
        const double start_s = latest_green_start_s(signal_group, crossing.time_s);
        if (start_s > green.start_s) green = {start_s, start_s, 0};
        if (green.start_s < window.from_s) continue;
        if (result.headway_s.size() <= green.position) {
            result.headway_s.push_back(0.0);
            result.samples.push_back(0);
        }
        result.headway_s[green.position] += crossing.time_s - green.last_s;
        ++result.samples[green.position];
        ++green.position;
        green.last_s = crossing.time_s;
    }
    for (std::size_t k = 0; k < result.headway_s.size(); ++k) result.headway_s[k] /= result.samples[k];

    result.greens = static_cast<int>(std::lround(window.length_s() / cycle_s));
    result.vehicles_per_green = static_cast<double>(vehicles) / lanes / (window.length_s() / cycle_s);
    summarise(result);
    return result;
}

}  // namespace stopline
