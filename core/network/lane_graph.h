// The network as the engine sees it: lanes, the lanes that follow each, and routes over them. Generators and importers build
// it; it is constant afterwards. A lane with a signal group has a stop line.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "network/geometry.h"
#include "network/network_settings.h"

namespace stopline {

// What a lane inside an intersection does. From an edge of an imported network there can be more ways than these: the further ones
// are numbered on.
enum class Turn : std::uint8_t { none, straight, right, left };
inline constexpr int kMostTurns = 12;  // `none` included

struct Lane {
    std::string name = {};
    double length_m = 0.0;
    double limit_mps = 0.0;
    double gradient = 0.0;       // rise over run, positive uphill in driving direction
    int signal_group = -1;       // of its stop line; -1: no stop line
    std::vector<int> next = {};  // lanes that can follow; none: vehicles leave the network here
    Polyline shape = {};         // centre line, from shape_start_m before the lane's start
    double stop_line_m = 0.0;    // from the lane's start; behind it the lane may go on, shared by its movements
    double shape_start_m = 0.0;  // length of `shape` that belongs to the lane before: the shared stretch
    double shape_scale = 1.0;    // metres of `shape` to one of the lane, where they differ: of imported networks
    double clear_m = 0.0;    // of a lane inside an intersection: rears beyond it are clear of the origin's other ways
    Turn turn = Turn::none;  // of a lane inside an intersection
    int origin = -1;         // of such a lane: the entry lane that leads to it
    int left = -1;           // lane beside it to which one may change, up to the stop line; -1: none
    int right = -1;
    double begin_m = 0.0;  // where it begins, from where the longest lanes of its approach do: pockets
    int approach = -1;     // the one that it belongs to
    // Of a lane inside an intersection, if its movement has a light of its own; -1: that of the stop line.
    int light = -1;
    // Of such a lane: whoever gives way waits before the place where ways meet, not before the stop line.
    bool waits_inside = true;
    bool keeps_clear = true;  // of such a lane: nobody enters it without room in the exit (HindranceRules)
};

// Where the bodies of vehicles on two lanes inside an intersection can touch. All distances along the lanes, of points of
// their centre lines: a lane's vehicle is in the area from when its front is beyond `from_m` until its rear is beyond `to_m`.
struct Conflict {
    int other = -1;
    double from_m = 0.0;  // on this lane; below 0: on the stretch that its origin shares among movements
    double to_m = 0.0;
    double other_from_m = 0.0;
    double other_to_m = 0.0;
    bool yields = false;        // this lane gives way to the other
    bool other_yields = false;  // the other gives way to this one
};

// A sequence of lanes from an entry to an exit, or to a lane where other routes begin: there a vehicle gets its next one.
struct Route {
    std::string name;
    std::vector<int> lanes;
};

// Lanes side by side that lead to an intersection from one side. Vehicles may change between them, and draw which way to turn from
// the shares of the approach.
struct Approach {
    std::string name;
    std::vector<int> lanes;  // from the left
    double right = 0.0;      // shares of the turns, the rest goes straight on
    double left = 0.0;
};

struct LaneGraph {
    std::vector<Lane> lanes;
    std::vector<Route> routes;
    std::vector<Approach> approaches;  // none where nobody changes lanes
    std::vector<int> entries;          // lanes where vehicles enter
    std::vector<int> links;            // lanes from one intersection to the next; routes start at entries and links
    int signal_groups = 0;
    std::vector<int>
        stage_of;  // [signal group] groups of one stage have green together: turns give way; empty: each its own
    std::vector<std::vector<Conflict>> conflicts;  // [lane], in the order of from_m; empty where no lane has any

    const std::vector<Conflict>& conflicts_of(int lane) const;
};

// The point of a lane's shape at a distance from where the shape begins, counted as the lane counts.
inline Pose place_along(const Lane& lane, double distance_m) {
    return place_at(lane.shape, distance_m * lane.shape_scale);
}

// Straight lanes side by side, each with a stop line (signal group 0) and the road behind it. Entry lane k is lane 2 k, its
// continuation lane 2 k + 1, its route k.
LaneGraph make_approach(const ApproachSettings& settings);

// Four arms that meet at a right angle, each with the same lanes; arms 0 .. 3 are those that traffic comes from in the west,
// south, east and north. Signal group 0 is west and east, group 1 south and north. Entry lanes end where their movements part,
// lanes inside lead from there to the exit lanes, which begin at `radius_m` from the centre.
LaneGraph make_intersection(const IntersectionSettings& settings);

// The same at every crossing of a grid: signal groups 2 n and 2 n + 1 at intersection n, counted row by row from the south-west.
// Lanes between two intersections are exits of one and approaches of the other. Names of lanes begin with column and row, such as
// c1r0_south_in_0; those of a single intersection do not.
LaneGraph make_grid(const GridSettings& grid, const IntersectionSettings& settings);

// Column and row of intersection n.
struct GridPlace {
    int column;
    int row;
};
std::vector<GridPlace> grid_places(const GridSettings& grid);

// Intersections as the user describes them, each with three signal groups: 3 n is the major street of intersection n, 3 n + 1 its
// lanes that only turn left and have a green of their own, 3 n + 2 the minor street; the first two are one stage. Names of lanes
// begin with that of the intersection: suarezstr_west_in_0, counted from the left, pockets included; suarezstr_east_out_0. Exits
// that lead to another intersection are its lanes and have their names. Throws InputError where the streets have a problem
// (street_checks.h).
LaneGraph make_streets(const StreetSettings& streets);

// That of the kind that is chosen.
LaneGraph make_network(const NetworkSettings& network);
// Of the intersection that a lane with a stop line leads to.
double radius_beyond_m(const NetworkSettings& network, const Lane& lane);

// Throws InputError where lanes, routes or signal groups do not fit together.
void check(const LaneGraph& graph);

}  // namespace stopline
