// The network for the simulation: lanes, their successors, routes and conflict areas. A generator or the SUMO import
// builds the lane graph. The graph does not change during a run.
//
// There are three kinds of lanes. An approach lane leads to a stop line. The lane ends where its movements diverge;
// this point can lie beyond the stop line. A connection leads through an intersection, from one approach lane to one
// exit lane. An exit lane leads away from an intersection. A link lane leads from one intersection to the next, so it
// is both an exit lane and an approach lane.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "network/geometry.h"
#include "network/network_settings.h"

namespace stopline {

// The movement of a connection. An approach of an imported network can have more than three movements. The additional
// movements have the values left + 1 .. kMaxTurns - 1.
enum class Turn : std::uint8_t { none, straight, right, left };
inline constexpr int kMaxTurns = 12;  // number of values of Turn, including `none`

// One lane of a SUMO network file. The import can join consecutive lanes of the file to one lane of the lane graph. The
// lanes of the file are then the parts of the joined lane.
struct LanePart {
    std::string name;       // name of the lane in the file
    double end_m = 0.0;     // end of the part, from the start of the lane; on a connection, from the stop line
    double length_m = 0.0;  // length of the lane in the file
};

// The rule that vehicles follow at a stop line without a signal.
enum class StopRule : std::uint8_t {
    none,          // nothing
    stop,          // stop, then go as right of way allows (stop sign)
    all_way_stop,  // stop, then go in the order in which the vehicles of all approaches have stopped
};

struct Lane {
    std::string name = {};
    double length_m = 0.0;
    double limit_mps = 0.0;
    double gradient = 0.0;       // slope as height over distance; positive: uphill in driving direction
    int signal_group = -1;       // signal group of the stop line; -1: no stop line
    std::vector<int> next = {};  // successor lanes; empty: vehicles leave the network at the end
    Polyline shape = {};         // centre line; it begins shape_start_m before the start of the lane
    double stop_line_m = 0.0;    // position of the stop line
    // Connection: distance from the stop line, where `shape` begins, to the end of the approach lane, where the
    // connection begins.
    double shape_start_m = 0.0;
    double shape_scale = 1.0;  // metres of `shape` per metre of the lane; 1 except in imported networks
    // Connection: a vehicle whose rear is beyond this position is clear of the other connections of its approach lane.
    double diverge_end_m = 0.0;
    // Connection, [index in `next` of its approach lane]: the same position for that other connection alone. Empty:
    // diverge_end_m applies to all of them.
    std::vector<double> diverge_ends_m = {};
    Turn turn = Turn::none;          // connection: its movement; else none
    int origin = -1;                 // connection: the approach lane that leads to it
    int left = -1;                   // adjacent lane on the left to which vehicles may change; -1: none
    int right = -1;                  // adjacent lane on the right to which vehicles may change; -1: none
    double start_offset_m = 0.0;     // distance of the lane's start from the approach's start; > 0: turn pocket
    int approach = -1;               // index in LaneGraph::approaches; -1: none
    int movement_signal_group = -1;  // connection: signal group of its movement; -1: group of the stop line
    // Connection. True: yielding vehicles wait before the conflict area. False: they wait at the stop line.
    bool waits_inside = true;
    // Connection. True: the rule TrafficRules::keep_clear applies, so vehicles enter only if the exit lane has room.
    bool keep_clear = true;
    // Imported lane: its parts in driving order; on an approach lane, up to the stop line. Empty: the lane is a single
    // part.
    std::vector<LanePart> parts = {};
    StopRule stop_rule = StopRule::none;  // connection
};

// A conflict area: the parts of two connections where vehicles on one can touch vehicles on the other.
// LaneGraph::conflicts lists the area for each of the two, which is then called "this connection". The bounds of the
// area are distances from the start of the connection. A vehicle occupies the area while its front is beyond `from_m`
// and its rear is before `to_m`.
struct Conflict {
    int other = -1;  // lane index of the other connection
    // Start of the area on this connection. < 0: the area begins before the connection, on the piece of the approach
    // lane between its stop line and its end.
    double from_m = 0.0;
    double to_m = 0.0;          // end of the area on this connection
    double other_from_m = 0.0;  // start of the area on the other connection
    double other_to_m = 0.0;    // end of the area on the other connection
    bool yields = false;        // true: this connection gives way to the other
    bool other_yields = false;  // true: the other connection gives way to this one
    // True: both connections lead to the same lane, and their vehicles merge in the order of arrival.
    bool zipper = false;
};

// A sequence of lanes that a vehicle follows. A route begins on an entry lane or a link lane. The route ends at the
// border of the network, or on the next link lane, where the vehicle gets its next route.
struct Route {
    std::string name;
    std::vector<int> lanes;
};

// Adjacent lanes that lead to an intersection from one side. Vehicles change lanes within an approach, and its turn
// ratios apply to all of its lanes together.
struct Approach {
    std::string name;
    std::vector<int> lanes;    // from the left
    double right_share = 0.0;  // share of right turns, 0 .. 1
    double left_share = 0.0;   // share of left turns, 0 .. 1; the remaining vehicles go straight on
};

struct LaneGraph {
    std::vector<Lane> lanes;
    std::vector<Route> routes;
    std::vector<Approach> approaches;  // empty in a network without lane changes
    std::vector<int> entries;          // lanes where vehicles enter the network
    std::vector<int> links;            // lanes from one intersection to the next; routes begin on entries and links
    int signal_groups = 0;
    // [signal group] number of its stage. Groups of the same stage can have green at the same time. Empty: every group
    // has a stage of its own.
    std::vector<int> stage_of;
    std::vector<std::vector<Conflict>> conflicts;  // [lane] conflicts sorted by from_m; empty if no lane has conflicts

    const std::vector<Conflict>& conflicts_of(int lane) const;
};

// Returns the pose at a distance from the start of the lane's shape. The distance is in metres of the lane, which
// shape_scale converts to metres of the shape.
inline Pose pose_along(const Lane& lane, double distance_m) {
    return pose_at(lane.shape, distance_m * lane.shape_scale);
}

// Builds a straight road of adjacent lanes without lane changes. All stop lines have signal group 0. Entry lane k
// (k = 0, 1, ...) has the lane index 2 k. Its exit lane has the lane index 2 k + 1, and its route has the index k.
LaneGraph make_approach(const ApproachSettings& settings);

// Builds an intersection of four equal legs at right angles. Legs 0 .. 3 lie in the west, south, east and north. Signal
// group 0 serves the traffic from west and east, group 1 that from south and north. Entry lanes end where their
// movements diverge. Connections lead from there to the exit lanes, which begin `radius_m` from the centre.
LaneGraph make_intersection(const IntersectionSettings& settings);

// Builds a grid of equal intersections, as make_intersection() builds a single one. Intersections are numbered row by
// row from the south-west. Intersection n has the signal groups 2 n and 2 n + 1. Names of lanes begin with column and
// row of the intersection, such as c1r0_south_in_0. In a grid of one intersection, the names omit this prefix.
LaneGraph make_grid(const GridSettings& grid, const IntersectionSettings& settings);

// The position of an intersection in the grid. Column 0 is in the west and row 0 in the south.
struct GridPosition {
    int column;
    int row;
};
// Returns the positions of all intersections, in the order of their numbers.
std::vector<GridPosition> grid_positions(const GridSettings& grid);

// Builds the streets that the user describes. Intersection n has three signal groups: 3 n for the major street, 3 n + 1
// for its lanes that only turn left, and 3 n + 2 for the minor street. If the programme has no protected left turn, the
// lanes that only turn left belong to group 3 n. The groups 3 n and 3 n + 1 form one stage.
//
// A lane name begins with the name of its intersection, such as suarezstr_west_in_0 or suarezstr_east_out_0. Lanes are
// counted from the left, turn pockets included. An exit lane that leads to another intersection is named as an approach
// lane of that intersection. Throws InputError if street_problems() finds a problem (street_checks.h).
LaneGraph make_streets(const StreetSettings& streets);

// Throws InputError if lanes, approaches, routes or signal groups are inconsistent.
void check(const LaneGraph& graph);

}  // namespace stopline
