// Records the positions of the vehicles on one street and the red phases of its signals, for the time-space diagrams
// (Fig. 16 of the paper).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "sim/step/simulation.h"

namespace stopline {

// Time between two samples of a vehicle, s.
inline constexpr double kTimeSpaceSample_s = 1.0;

// A sample of one vehicle. In this file, positions are measured along the street from the start of its first lane.
struct StreetPoint {
    double time_s;
    double position_m;  // position of the front
    int vehicle;        // number of the vehicle
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
    double length_m = 0.0;     // length of the sampled lanes; 0: there is no street to sample
    bool reaches_exit = true;  // false: no straight path reaches an exit, so the longest path is sampled
};

// Samples one street during the last part of a run. This part has the length measure.time_space. The street begins on
// the side measure.time_space_side; in a grid this street is the middle row or column. Of the lanes that lead straight
// through the network, the tracer samples the rightmost lane.
class StreetTracer {
public:
    StreetTracer(const Scenario& scenario, const Model& model);

    // Takes a sample every kTimeSpaceSample_s. Must be called before each step.
    void sample(const State& state);
    const StreetTrace& trace() const { return trace_; }

private:
    // A lane of the traced street.
    struct Piece {
        int lane;
        double from_m;  // position of the start of the lane along the street
        int red;        // index of the current red phase in trace_.reds; -1: the signal is not red
    };
    const Model& model_;
    std::vector<Piece> pieces_;
    StreetTrace trace_;
};

// Returns the text of time_space.csv.
std::string time_space_csv(const std::vector<std::string>& populations, const std::vector<StreetTrace>& traces);

}  // namespace stopline
