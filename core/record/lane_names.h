// Names of lanes and positions on them, for result files.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "network/lane_graph.h"
#include "sim/state/state.h"

namespace stopline {

// Finds the name of a lane and the position on it for result files. In an imported network, the names are those of the
// lanes in the SUMO file. The import can join several lanes of this file to one lane of the lane graph; Lane::parts
// lists them. A vehicle beyond the stop line of its lane counts as being on its connection.
class LaneNames {
public:
    // plain: names of the lane graph and of the imported file. sumo: as in SUMO's files, where the name of a connection
    // begins with a colon; escaped for XML.
    enum class Style { plain, sumo };
    LaneNames(const LaneGraph& graph, Style style);

    // A position on a named lane, from the start of that lane, m. It is not beyond the end of the lane.
    struct Place {
        const std::string& lane;
        double position_m;
    };
    // Returns the place of the front of a vehicle on `lane`. `slot` is the index of the vehicle in the arrays of the
    // state.
    Place front(const State& state, int lane, std::size_t slot) const;
    // Returns the place at which a trip ends if `lane` is its last lane: the stop line, or the end of a lane without
    // stop line. For a connection, returns the stop line or the end of its exit lane.
    Place end(int lane) const;
    // Returns the distance from a position on `lane` to the place that end() returns, m.
    double to_end_m(int lane, double position_m) const;

private:
    struct Part {
        std::string name;
        // End of the part, from the start of the lane. For a connection: from the stop line before the connection.
        double end_m;
        double length_m;  // length of the named lane
    };
    struct Entry {
        std::vector<Part> parts;
        double start_m = 0.0;   // connection: distance from the stop line before it to its start; else 0
        double end_m = 0.0;     // position of the stop line, or the end of a lane without stop line
        double length_m = 0.0;  // length of the lane in the lane graph
        int exit = -1;          // connection: its exit lane
        bool has_stop_line = false;
    };
    Place place(int lane, double position_m) const;

    std::vector<Entry> lanes_;  // [lane]
};

}  // namespace stopline
