// Positions and connections of the lanes of streets, for the checks and for the builder of the lane graph.
//
// Sides are numbered 0 west, 1 south, 2 east, 3 north. A vehicle from side s leaves straight on at side s + 2, after a
// right turn at side s + 1 and after a left turn at side s + 3 (modulo 4). Lanes are counted from the left, as seen by
// their drivers. Turn pockets lie beside the through lanes, which are as long as the approach; left pockets lie in the
// median.
#pragma once

#include <array>
#include <vector>

#include "network/geometry.h"
#include "network/lane_graph.h"
#include "network/street_settings.h"

namespace stopline {

inline constexpr std::array<const char*, 4> kSides{"west", "south", "east", "north"};
inline constexpr std::array<Turn, 3> kTurns{Turn::straight, Turn::right, Turn::left};

const char* name_of(Turn turn);
bool allows(const StreetLane& lane, Turn turn);
// Returns the side where a vehicle from `side` leaves the intersection after the turn.
int exit_side(int side, Turn turn);
inline int opposite(int side) { return (side + 2) % 4; }
// Returns the lanes of the leg that allow the turn. They are in order from the right for right turns, else from the
// left.
std::vector<int> lanes_with(const StreetLeg& leg, Turn turn);

class StreetLayout {
public:
    explicit StreetLayout(const StreetSettings& streets);

    int nodes() const { return static_cast<int>(legs_.size()); }
    const StreetIntersection& node(int node) const { return streets_->intersections[static_cast<std::size_t>(node)]; }
    // Returns null if the intersection has no leg on that side.
    const StreetLeg* leg(int node, int side) const;
    // Returns the nearest intersection straight ahead on that side, or -1.
    int nearest(int node, int side) const;
    // Returns the intersection at the other end of the road on that side, or -1. It is the nearest one, and it must
    // have a leg that faces this one.
    int neighbour(int node, int side) const;

    // Return the distance of a lane's centre line to the right of the line between the two directions of traffic.
    double offset_m(int node, int side, int lane) const;
    double exit_offset_m(int side, int lane) const;

    // Returns the number of turn pockets to the left of the through lanes.
    static int left_pockets(const StreetLeg& leg);
    // Returns the number of lanes that are as long as the approach.
    static int through_lanes(const StreetLeg& leg);
    // Returns the length of the through lanes, up to the stop line.
    double length_m(int node, int side) const;

    // Returns the index of the exit lane that a lane leads to. Turning lanes lead to the exit lanes nearest to them,
    // counted from the side that they turn to. Straight lanes keep their order and have the smallest sum of sideways
    // shifts.
    int exit_lane(int node, int side, int lane, Turn turn) const;

    // Returns the path from the stop line to the exit lane.
    Polyline path(int node, int side, int lane, Turn turn) const;
    // Returns the centre line of an approach lane, up to its stop line.
    Polyline approach(int node, int side, int lane) const;
    // Returns the centre line of an exit lane.
    Polyline exit(int node, int side, int lane) const;

private:
    double median_m(int side) const { return side % 2 == 0 ? streets_->median_m : streets_->minor_median_m; }
    // Returns the point of the plane that lies `ahead_m` ahead and `right_m` to the right of the centre, for traffic
    // that comes from `side`.
    Point point_at(int node, int side, double ahead_m, double right_m) const;
    // Returns the number of exit lanes to the left of the one that the leftmost straight lane leads to.
    int straight_shift(int node, int side) const;

    const StreetSettings* streets_;
    std::vector<std::array<int, 4>> legs_;  // [intersection][side] index of the leg; -1: none
};

}  // namespace stopline
