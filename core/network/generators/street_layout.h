// Positions and connections of the lanes of streets. street_checks.cpp checks the settings with them, and streets.cpp
// builds the lane graph from them.
//
// Sides are numbered 0 west, 1 south, 2 east, 3 north. A vehicle from side s leaves the intersection at side s + 2 if
// it goes straight on, at s + 1 after a right turn, and at s + 3 after a left turn (modulo 4). Lanes are counted from
// the left, as seen by the driver. Through lanes are as long as the approach. Turn pockets lie beside the through
// lanes; the pockets on the left lie in the median.
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
// Returns the lanes of the leg that allow the turn. For right turns the rightmost lane comes first, for other turns the
// leftmost lane.
std::vector<int> lanes_with(const StreetLeg& leg, Turn turn);

class StreetLayout {
public:
    explicit StreetLayout(const StreetSettings& streets);

    int nodes() const { return static_cast<int>(legs_.size()); }
    const StreetIntersection& node(int node) const { return streets_->intersections[static_cast<std::size_t>(node)]; }
    // Returns null if the intersection has no leg on that side.
    const StreetLeg* leg(int node, int side) const;
    // Returns the nearest intersection on the straight line from `node` toward `side`, or -1 if there is none.
    int nearest(int node, int side) const {
        return nearest_[static_cast<std::size_t>(node)][static_cast<std::size_t>(side)];
    }
    // Returns the intersection at the other end of the road on `side`, or -1 if there is none. Two neighbouring
    // intersections are joined by a road if each has a leg toward the other.
    int neighbour(int node, int side) const;

    // The next two functions return how far the centre line of a lane lies to the right of the middle of the road,
    // which separates the two directions of traffic. offset_m() is for approach lanes, exit_offset_m() for exit lanes.
    double offset_m(int node, int side, int lane) const;
    double exit_offset_m(int side, int lane) const;

    // Returns the number of turn pockets to the left of the through lanes.
    static int left_pockets(const StreetLeg& leg);
    // Returns the number of lanes that are as long as the approach.
    static int through_lanes(const StreetLeg& leg);
    // Returns the length of the through lanes of a leg, up to the stop line.
    double length_m(int node, int side) const;

    // Returns the index of the exit lane to which an approach lane leads. Left turns: the leftmost lane with a left
    // turn leads to the leftmost exit lane, the second such lane to the second exit lane, and so on. Right turns: the
    // same, counted from the right. Straight on: the lanes keep their order and lead to adjacent exit lanes. These exit
    // lanes are chosen so that the vehicles shift sideways as little as possible.
    int exit_lane(int node, int side, int lane, Turn turn) const;

    // Returns the path from the stop line to the exit lane.
    Polyline path(int node, int side, int lane, Turn turn) const;
    // Returns the centre line of an approach lane, up to its stop line.
    Polyline approach(int node, int side, int lane) const;
    // Returns the centre line of an exit lane.
    Polyline exit(int node, int side, int lane) const;

private:
    double median_m(int side) const { return side % 2 == 0 ? streets_->median_m : streets_->minor_median_m; }
    // Returns the point that lies `ahead_m` ahead of and `right_m` to the right of the centre of the intersection, as
    // seen by traffic that comes from `side`.
    Point point_at(int node, int side, double ahead_m, double right_m) const;
    // Returns the index of the exit lane to which the leftmost lane with straight traffic leads.
    int straight_shift(int node, int side) const;

    // Fills nearest_. The time grows with N log N for N intersections.
    void find_nearest();

    const StreetSettings* streets_;
    std::vector<std::array<int, 4>> legs_;     // [intersection][side] index of the leg; -1: none
    std::vector<std::array<int, 4>> nearest_;  // [intersection][side] see nearest()
};

}  // namespace stopline
