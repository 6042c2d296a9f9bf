#include "measure/zones.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <unordered_map>

namespace stopline {

ZoneResult measure_zone(std::span<const Detector> detectors, std::span<const Crossing> crossings, int zone,
                        const TimeWindow& window, double lane_m) {
    struct Visit {
        double entry_s;
        double length_m;
    };
    std::unordered_map<int, Visit> inside;  // [vehicle]
    ZoneResult result;
    double travel_s = 0.0;
    double vehicle_s = 0.0;
    double metre_s = 0.0;
    const auto count = [&](const Visit& visit, double until_s) {
        const double within_s = std::min(until_s, window.to_s) - std::max(visit.entry_s, window.from_s);
        if (within_s <= 0.0) return;
        vehicle_s += within_s;
        metre_s += within_s * visit.length_m;
    };
    for (const Crossing& crossing : crossings) {
        const Detector& detector = detectors[static_cast<std::size_t>(crossing.detector)];
        if (detector.kind != Detector::Kind::zone || detector.zone != zone) continue;
        if (!detector.leaves_zone) {
            inside[crossing.vehicle] = {crossing.time_s, static_cast<double>(crossing.length_m)};
            continue;
        }
        const auto visit = inside.find(crossing.vehicle);
        if (visit == inside.end()) continue;
        count(visit->second, crossing.time_s);
        if (crossing.time_s >= window.from_s && crossing.time_s < window.to_s) {
            travel_s += crossing.time_s - visit->second.entry_s;
            ++result.exited;
        }
        inside.erase(visit);
    }
    // Vehicles still inside are added in the order of their ids, because the order of a hash table is not reproducible.
    std::vector<int> remaining;
    for (const auto& [vehicle, visit] : inside) remaining.push_back(vehicle);
    std::sort(remaining.begin(), remaining.end());
    for (const int vehicle : remaining) count(inside.at(vehicle), window.to_s);
    result.travel_time_s = result.exited > 0 ? travel_s / result.exited : std::numeric_limits<double>::quiet_NaN();
    result.vehicles = vehicle_s / window.length_s();
    result.occupied = metre_s / window.length_s() / lane_m;
    return result;
}

}  // namespace stopline
