// Where the vehicles of one street are over time, with its lights: the time-space diagrams of Fig. 16.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiment/gnuplot.h"
#include "scenario/scenario.h"
#include "sim/simulation.h"

namespace stopline {

// One second of one vehicle. Distances are along the street, from the start of its first lane.
struct StreetPoint {
    double time_s;
    double front_m;
    int vehicle;
    int policy;
};

// Time in which a stop line may not be passed.
struct RedTime {
    double line_m;
    double from_s;
    double to_s;
};

struct StreetTrace {
    std::vector<StreetPoint> points;  // by time
    std::vector<RedTime> reds;
    std::vector<std::string> policies;
    std::string lane;  // by which it begins
    double from_s = 0.0;
    double to_s = 0.0;
    double length_m = 0.0;  // 0: no such street
    bool goes_through =
        true;  // to where vehicles leave the network; false: all lanes of its inlet end before, and this one ends last
};

// Follows a street from the side measure.time_space_from, in the middle row or column of a grid, over the last measure.time_space of the
// run: of its inlet's lanes the one furthest right from which one gets straight on through the whole street.
class StreetWatch {
public:
    StreetWatch(const Scenario& scenario, const Model& model);

    // Before each step.
    void look(const State& state);
    const StreetTrace& trace() const { return trace_; }

private:
    struct Piece {
        int lane;
        double from_m;
        int light;  // index into trace_.reds of the red that goes on; -1: none
    };
    const Model& model_;
    std::vector<Piece> pieces_;
    StreetTrace trace_;
};

// A panel for each population.
Figure time_space_figure(const Scenario& scenario, const std::vector<std::string>& populations,
                         const std::vector<StreetTrace>& traces);
std::string time_space_csv(const std::vector<std::string>& populations, const std::vector<StreetTrace>& traces);

}  // namespace stopline
