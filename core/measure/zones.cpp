#include "measure/zones.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <unordered_map>

namespace stopline {

ZoneFigures zone_figures(std::span<const Detector> detectors, std::span<const Crossing> crossings, int zone,
                         const TimeWindow& window, double lane_m) {
    struct Visit {
        double since_s;
        double length_m;
    };
    std::unordered_map<int, Visit> inside;  // by vehicle
    ZoneFigures figures;
    double travel_s = 0.0;
    double vehicle_s = 0.0;
    double metre_s = 0.0;
    const auto count = [&](const Visit& visit, double until_s) {
        const double within_s = std::min(until_s, window.to_s) - std::max(visit.since_s, window.from_s);
        if (within_s <= 0.0) return;
        vehicle_s += within_s;
        metre_s += within_s * visit.length_m;
    };
    for (const Crossing& crossing : crossings) {
        const Detector& detector = detectors[static_cast<std::size_t>(crossing.detector)];
        if (detector.kind != Detector::Kind::zone || detector.zone != zone) continue;
        if (!detector.leaves) {
            inside[crossing.vehicle] = {crossing.time_s, static_cast<double>(crossing.length_m)};
            continue;
        }
        const auto visit = inside.find(crossing.vehicle);
        if (visit == inside.end()) continue;
        count(visit->second, crossing.time_s);
        if (crossing.time_s >= window.from_s && crossing.time_s < window.to_s) {
            travel_s += crossing.time_s - visit->second.since_s;
            ++figures.left;
        }
        inside.erase(visit);
    }
    // Those still inside, in the order of their numbers: a sum in the order of a hash table would not be reproducible.
    std::vector<int> remaining;
    for (const auto& [vehicle, visit] : inside) remaining.push_back(vehicle);
    std::sort(remaining.begin(), remaining.end());
    for (const int vehicle : remaining) count(inside.at(vehicle), window.to_s);
    figures.travel_time_s = figures.left > 0 ? travel_s / figures.left : std::numeric_limits<double>::quiet_NaN();
    figures.vehicles = vehicle_s / window.length_s();
    figures.occupied = metre_s / window.length_s() / lane_m;
    return figures;
}

}  // namespace stopline
