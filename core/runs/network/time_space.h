// Positions of the vehicles of one street over time, with its red signals: the time-space diagrams of Fig. 16.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "sim/step/simulation.h"

namespace stopline {

// Time between two samples of a vehicle.
inline constexpr double kTimeSpaceSample_s = 1.0;

// A sample of one vehicle. Distances are measured along the street from the start of its first lane.
struct StreetPoint {
    double time_s;
    double position_m;  // of the front
    int vehicle;        // number
    int policy;         // index into StreetTrace::policies
};

// A red phase at one stop line.
struct RedPhase {
    double stop_line_m;
    double from_s;
    double to_s;
};

struct StreetTrace {
    std::vector<StreetPoint> points;  // in the order of time
    std::vector<RedPhase> reds;
    std::vector<std::string> policies;
    std::string first_lane;
    double from_s = 0.0;
    double to_s = 0.0;
    double length_m = 0.0;     // 0: no street leads through the network
    bool reaches_exit = true;  // false: no lane leads straight through the network; this is the longest one
};

// Samples one street during the last measure.time_space of a run. The street begins on the side
// measure.time_space_side; in a grid it is the middle row or column. The tracer follows its rightmost lane that leads
// straight through the network.
class StreetTracer {
public:
    StreetTracer(const Scenario& scenario, const Model& model);

    // Call before each step.
    void sample(const State& state);
    const StreetTrace& trace() const { return trace_; }

private:
    struct Piece {
        int lane;
        double from_m;  // start of the lane along the street
        int red;        // index into trace_.reds of the current red phase; -1: not red
    };
    const Model& model_;
    std::vector<Piece> pieces_;
    StreetTrace trace_;
};

// Returns the text of time_space.csv.
std::string time_space_csv(const std::vector<std::string>& populations, const std::vector<StreetTrace>& traces);

}  // namespace stopline
