// Samples speeds by approach, place and time. The speeds show which queues do not clear and how far upstream these
// queues reach.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/step/simulation.h"

namespace stopline {

// The traffic on one approach in one interval, sampled once a second.
struct ApproachInterval {
    double vehicles = 0.0;            // mean number of vehicles
    double speed_mps = 0.0;           // mean speed; NaN: no vehicle
    double upstream_speed_mps = 0.0;  // mean speed in the upstream third of the approach; NaN: no vehicle
};

struct ApproachSeries {
    std::string name;
    std::vector<ApproachInterval> intervals;
};

// Mean speeds by interval, stretch of road and heading. The x axis is divided into stretches of kStretch_m.
struct SpeedMap {
    static constexpr double kStretch_m = 25.0;
    double from_m = 0.0;                             // x coordinate of the start of the first stretch
    std::vector<std::vector<double>> eastwards_mps;  // [interval][stretch] vehicles that head east (+x); NaN: none
    std::vector<std::vector<double>> westwards_mps;  // [interval][stretch] vehicles that head west (-x); NaN: none
};

struct Congestion {
    double interval_s = 60.0;
    std::vector<ApproachSeries> approaches;
    SpeedMap map;

    // Returns the time at which an approach becomes congested, s; std::nullopt if it is never congested. An approach is
    // congested if the mean speed in its upstream third is below 12 km/h for five successive intervals. Without a
    // queue, the mean speed there is more than twice this limit.
    std::optional<double> congested_from_s(std::size_t approach) const;
};

// Samples the speeds of a run. The result is empty if LaneGraph::approaches is empty.
class CongestionSampler {
public:
    CongestionSampler(const Model& model, double interval_s);

    // Takes a sample once a second. Must be called before each step and after the last step.
    void sample(const State& state);
    const Congestion& congestion() const { return congestion_; }

private:
    struct SpeedSum {
        double speed_mps = 0.0;
        int vehicles = 0;

        void add(double vehicle_speed_mps) {
            speed_mps += vehicle_speed_mps;
            ++vehicles;
        }
        double mean_mps() const;
    };
    void sample_lane(const State& state, int lane);
    void finish_interval();

    const Model& model_;
    std::int64_t second_ticks_;
    std::int64_t interval_ticks_;
    Congestion congestion_;
    // Sums over the current interval.
    std::vector<SpeedSum> approach_;               // [approach] all vehicles on the approach
    std::vector<SpeedSum> upstream_;               // [approach] vehicles in the upstream third of the approach
    std::vector<SpeedSum> eastwards_, westwards_;  // [stretch] vehicles with this heading
};

}  // namespace stopline
