// Speeds by approach, place and time: they show where queues do not clear and how far back they reach.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/step/simulation.h"

namespace stopline {

// One approach in one interval. The values are means over its vehicles, sampled once a second.
struct ApproachInterval {
    double vehicles = 0.0;
    double speed_mps = 0.0;           // NaN: no vehicle
    double upstream_speed_mps = 0.0;  // in the upstream third of the approach; NaN: no vehicle
};

struct ApproachSeries {
    std::string name;
    std::vector<ApproachInterval> intervals;
};

// Mean speeds over place and time, by heading. The places are stretches of kStretch_m along the x axis.
struct SpeedMap {
    static constexpr double kStretch_m = 25.0;
    double from_m = 0.0;                             // x at the start of the first stretch
    std::vector<std::vector<double>> eastwards_mps;  // [interval][stretch] heading along +x; NaN: no vehicle
    std::vector<std::vector<double>> westwards_mps;  // [interval][stretch] heading along -x; NaN: no vehicle
};

struct Congestion {
    double interval_s = 60.0;
    std::vector<ApproachSeries> approaches;
    SpeedMap map;

    // Returns the time from which an approach is congested, s; nothing if it never is. An approach is congested once
    // the mean speed in its upstream third is below 12 km/h for five intervals. Without a queue it is more than twice
    // as high.
    std::optional<double> congested_from_s(std::size_t approach) const;
};

// Samples the speeds of a run. Networks without approaches give an empty result.
class CongestionSampler {
public:
    CongestionSampler(const Model& model, double interval_s);

    // Call before each step and after the last one.
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
    // Sums of the current interval.
    std::vector<SpeedSum> approach_;               // [approach]
    std::vector<SpeedSum> upstream_;               // [approach]
    std::vector<SpeedSum> eastwards_, westwards_;  // [stretch]
};

}  // namespace stopline
