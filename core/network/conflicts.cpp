#include "network/conflicts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "base/containers/index.h"

namespace stopline {

namespace {

constexpr double kSample_m = 0.25;

struct Stretch {
    double from_m;
    double to_m;
};

// Samples points along `a`. Returns the stretch of `a` from the first to the last sample that is closer to `b` than the
// clearance. A step along `a` changes the distance to `b` by at most the length of the step. So the search can skip the
// samples next to a sample that is far from `b`.
std::optional<Stretch> near_part(const Polyline& a, const Polyline& b, double clearance_m) {
    const double end_m = length_m(a);
    const int samples = static_cast<int>(std::ceil(end_m / kSample_m));
    const auto position_m = [&](int k) { return std::min(k * kSample_m, end_m); };
    const auto excess_m = [&](int k) { return distance_m(b, pose_at(a, position_m(k)).point) - clearance_m; };
    // Returns the first sample that is closer to `b` than the clearance. The search starts at sample k and has the
    // direction +1 or -1. The result is outside 0 .. samples if there is no such sample.
    const auto search = [&](int k, int direction) {
        while (k >= 0 && k <= samples) {
            const double too_far_m = excess_m(k);
            if (!(too_far_m >= 0.0)) break;
            k += direction * std::max(static_cast<int>(too_far_m / kSample_m), 1);
        }
        return k;
    };
    const int first = search(0, 1);
    if (first > samples) return std::nullopt;
    return Stretch{position_m(first), position_m(search(samples, -1))};
}

struct Box {
    Point low;
    Point high;
};

Box box_of(const Polyline& line) {
    Box box{line.front(), line.front()};
    for (const Point& p : line) {
        box.low = {std::min(box.low.x_m, p.x_m), std::min(box.low.y_m, p.y_m)};
        box.high = {std::max(box.high.x_m, p.x_m), std::max(box.high.y_m, p.y_m)};
    }
    return box;
}

// Returns true if the gap between the boxes, in x or in y, exceeds the clearance.
bool apart(const Box& a, const Box& b, double clearance_m) {
    const auto beyond = [&](const Box& one, const Box& other) {
        return one.low.x_m > other.high.x_m + clearance_m || one.low.y_m > other.high.y_m + clearance_m;
    };
    return beyond(a, b) || beyond(b, a);
}

// Returns the conflict area of two connections, or nothing if there is none. Sets only the four positions, which are
// measured from the starts of the lanes.
std::optional<Conflict> areas_of(const Lane& one, const Lane& two, double clearance_m) {
    const auto on_one = near_part(one.shape, two.shape, clearance_m);
    const auto on_two = on_one ? near_part(two.shape, one.shape, clearance_m) : std::nullopt;
    if (!on_one || !on_two) return std::nullopt;
    const auto position_m = [](const Lane& lane, double along_shape_m) {
        return along_shape_m / lane.shape_scale - lane.shape_start_m;
    };
    return Conflict{-1, position_m(one, on_one->from_m), position_m(one, on_one->to_m), position_m(two, on_two->from_m),
                    position_m(two, on_two->to_m)};
}

// Returns a number for the right of way of a movement. Of two movements, the one with the larger number yields.
int rank(Turn turn) { return turn == Turn::left ? 2 : turn == Turn::right ? 1 : 0; }

}  // namespace

bool yields_by_turn(Turn one, Turn two) { return rank(one) > rank(two); }

double shared_stretch_m(const Polyline& a, const Polyline& b, double clearance_m) {
    const double end_m = std::min(length_m(a), length_m(b));
    double s = 0.0;
    while (s < end_m && distance_m(b, pose_at(a, s).point) < clearance_m) s += kSample_m;
    return s;
}

std::optional<Conflict> conflict_of(const Lane& one, const Lane& two, double clearance_m) {
    if (apart(box_of(one.shape), box_of(two.shape), clearance_m)) return std::nullopt;
    return areas_of(one, two, clearance_m);
}

void find_conflicts(LaneGraph& graph, double clearance_m, int first, int stop) {
    std::vector<Box> boxes;
    for (int i = first; i < stop; ++i) boxes.push_back(box_of(graph.lanes[at(i)].shape));
    const auto stage = [&](const Lane& lane) {
        const int group = graph.lanes[at(lane.origin)].signal_group;
        return graph.stage_of.empty() ? group : graph.stage_of[at(group)];
    };
    for (int i = first; i < stop; ++i) {
        const Lane& one = graph.lanes[at(i)];
        for (int k = i + 1; k < stop; ++k) {
            const Lane& two = graph.lanes[at(k)];
            if (two.origin == one.origin || apart(boxes[at(i - first)], boxes[at(k - first)], clearance_m)) continue;
            const std::optional<Conflict> c = areas_of(one, two, clearance_m);
            if (!c) continue;
            const bool same_stage = stage(one) == stage(two);
            const bool one_yields = same_stage && yields_by_turn(one.turn, two.turn);
            const bool two_yields = same_stage && yields_by_turn(two.turn, one.turn);
            graph.conflicts[at(i)].push_back(
                {k, c->from_m, c->to_m, c->other_from_m, c->other_to_m, one_yields, two_yields});
            graph.conflicts[at(k)].push_back(
                {i, c->other_from_m, c->other_to_m, c->from_m, c->to_m, two_yields, one_yields});
        }
    }
    for (int i = first; i < stop; ++i) {
        std::vector<Conflict>& of_lane = graph.conflicts[at(i)];
        std::stable_sort(of_lane.begin(), of_lane.end(),
                         [](const Conflict& a, const Conflict& b) { return a.from_m < b.from_m; });
    }
}

}  // namespace stopline
