// Where the lanes of streets lie, and which of them meet: what the checks and the builder of the lane graph both need.
//
// Sides are counted as arms are in a grid: 0 west, 1 south, 2 east, 3 north. Traffic that comes from side s heads away from it; its
// straight way out is side s + 2, to the right s + 1, to the left s + 3. Lanes are counted from the left, as their drivers see it.
// Pockets lie outside of the lanes that are as long as the approach, those on the left in the median.
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
// The side on which one leaves that came from `side`.
int side_after(int side, Turn turn);
inline int opposite(int side) { return (side + 2) % 4; }
// How the lanes of an arm that allow a turn are counted: for rights from the right, else from the left.
std::vector<int> lanes_with(const StreetArm& arm, Turn turn);

class StreetLayout {
public:
    explicit StreetLayout(const StreetSettings& streets);

    int nodes() const { return static_cast<int>(arms_.size()); }
    const StreetIntersection& node(int node) const { return streets_->intersections[static_cast<std::size_t>(node)]; }
    // Null where the intersection has no arm on that side.
    const StreetArm* arm(int node, int side) const;
    // The nearest intersection on that side, within kSameLine_m of the line; -1: none.
    int nearest(int node, int side) const;
    // The same if it has an arm that faces this one: then both are ends of one road.
    int neighbour(int node, int side) const;

    // To the right of the line in the middle between the two directions.
    double offset_m(int node, int side, int lane) const;
    double exit_offset_m(int side, int lane) const;

    // Lanes of an arm that are pockets, on the left of the others.
    static int left_pockets(const StreetArm& arm);
    static int through_lanes(const StreetArm& arm);
    // From where the longest lanes to the intersection begin to their stop line.
    double length_m(int node, int side) const;

    // Exit that a lane leads to, on the side where the turn ends: turning lanes to those next to them, counted from the side that they
    // turn to; straight lanes keep their order, to the exits that are nearest in sum.
    int target(int node, int side, int lane, Turn turn) const;

    // From the stop line to the exit, in the plane.
    Polyline path(int node, int side, int lane, Turn turn) const;
    // From where the lane begins to its stop line.
    Polyline approach(int node, int side, int lane) const;
    Polyline exit(int node, int side, int lane) const;

private:
    double median_m(int side) const { return side % 2 == 0 ? streets_->median_m : streets_->minor_median_m; }
    Point placed(int node, int side, double ahead_m, double right_m) const;
    int straight_shift(int node, int side) const;

    const StreetSettings* streets_;
    std::vector<std::array<int, 4>> arms_;  // [intersection][side] index of the arm; -1: none
};

}  // namespace stopline
