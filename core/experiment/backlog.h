// Where traffic is slow, by approach and over time: how far queues that do not clear reach back.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/simulation.h"

namespace stopline {

// One approach in one interval: means over the vehicles on it, once a second.
struct ApproachInterval {
    double vehicles = 0.0;
    double speed_mps = 0.0;           // NaN: none
    double upstream_speed_mps = 0.0;  // in its upstream third
};

// One approach.
struct ApproachSeries {
    std::string name;
    std::vector<ApproachInterval> intervals;
};

// Mean speeds over place and time: of vehicles that head along +x, or -x, in stretches of kStretch_m.
struct SpeedMap {
    static constexpr double kStretch_m = 25.0;
    double from_m = 0.0;                             // x of the first stretch's start
    std::vector<std::vector<double>> eastwards_mps;  // [interval][stretch]; NaN: nobody
    std::vector<std::vector<double>> westwards_mps;
};

struct Backlog {
    double interval_s = 60.0;
    std::vector<ApproachSeries> approaches;
    SpeedMap map;

    // A backlog has filled an approach from when on the mean speed in its upstream third stays below 12 km/h for five intervals: less
    // than half of what is driven there between two intersections without one. In seconds; nothing: never.
    std::optional<double> filled_s(std::size_t approach) const;
};

// Networks whose lanes lie side by side in approaches; for others there is nothing to see.
class BacklogWatch {
public:
    BacklogWatch(const Model& model, double interval_s);

    // Before each step.
    void look(const State& state);
    const Backlog& backlog() const { return backlog_; }

private:
    struct Sum {
        double speed_mps = 0.0;
        int vehicles = 0;

        void add(double speed) {
            speed_mps += speed;
            ++vehicles;
        }
        double mean() const;
    };
    void see(const State& state, int lane);
    void note_interval();

    const Model& model_;
    std::int64_t second_;
    std::int64_t every_;
    Backlog backlog_;
    std::vector<Sum> all_;                    // [approach] in this interval
    std::vector<Sum> upstream_;               // [approach]
    std::vector<Sum> eastwards_, westwards_;  // [stretch]
};

}  // namespace stopline
