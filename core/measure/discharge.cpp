#include "measure/discharge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace stopline {

namespace {

constexpr std::size_t kLostPositions = 4;

// Where a lane's present green stands.
struct Green {
    double start_s = -1.0;
    double last_s = 0.0;
    std::size_t position = 0;
};

// First tick of the green that is on or was the last one; -1: there was none.
std::int64_t last_green(const GroupProgramme& programme, std::int64_t tick) {
    while (tick >= 0 && programme.light(tick) != Light::green) tick = programme.since(tick) - 1;
    return tick < 0 ? -1 : programme.since(tick);
}

void summarise(Discharge& result) {
    double sum_s = 0.0;
    int samples = 0;
    for (std::size_t k = kLostPositions; k < result.headway_s.size(); ++k) {
        sum_s += result.headway_s[k] * result.samples[k];
        samples += result.samples[k];
    }
    result.saturation_headway_s = samples > 0 ? sum_s / samples : std::numeric_limits<double>::quiet_NaN();
    result.saturation_flow_veh_h = 3600.0 / result.saturation_headway_s;
    if (samples == 0) result.lost_time_s = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t k = 0; k < std::min(kLostPositions, result.headway_s.size()); ++k) {
        result.lost_time_s += result.headway_s[k] - result.saturation_headway_s;
    }
}

}  // namespace

Discharge discharge(const Model& model, std::span<const Crossing> crossings, const TimeWindow& window) {
    Discharge result;
    std::vector<Green> greens(model.detectors.size());
    int vehicles = 0;
    int lanes = 0;
    for (const Detector& detector : model.detectors) lanes += detector.kind == Detector::Kind::stop_line ? 1 : 0;
    for (const Crossing& crossing : crossings) {
        const auto d = static_cast<std::size_t>(crossing.detector);
        const Detector& detector = model.detectors[d];
        if (detector.kind != Detector::Kind::stop_line || !window.contains(crossing.time_s)) continue;
        const Lane& lane = model.graph.lanes[static_cast<std::size_t>(detector.lane)];
        const GroupProgramme& programme = model.signals[static_cast<std::size_t>(lane.signal_group)];
        const auto tick = static_cast<std::int64_t>(crossing.time_s / model.step_s);
        ++vehicles;
        Green& green = greens[d];
        const double start_s = model.time_s(last_green(programme, tick));
        if (start_s > green.start_s) green = {start_s, start_s, 0};
        // A green that began before the window is not whole.
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
    const double cycle_s = model.time_s(model.signals[0].cycle_ticks());
    result.greens = static_cast<int>(std::lround(window.length_s() / cycle_s));
    result.vehicles_per_green = static_cast<double>(vehicles) / lanes / (window.length_s() / cycle_s);
    summarise(result);
    return result;
}

}  // namespace stopline
