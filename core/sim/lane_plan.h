// The network as the phases of a step need it: what they read of a lane in one line of the cache, routes side by side, and lanes
// in the order of their intersections, so that threads can share them out.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/marks.h"
#include "base/simd.h"
#include "sim/model.h"
#include "sim/trip_lanes.h"

namespace stopline {

struct alignas(64) LanePlan {
    double length_m = 0.0;
    double stop_line_m = 0.0;
    double turn_m = 0.0;  // where the limit of the next lane begins to hold
    double limit_mps = 0.0;
    double first_area_m = 1e9;  // of a lane inside an intersection: where its first conflict area begins
    float sine = 0.0F;          // of the slope
    int signal_group = -1;      // -1: no stop line
    int origin = -1;            // of a lane inside an intersection; -1: it is none
    int exit = -1;              // the same: the lane it leads to
    int mark = -1;              // of a lane inside an intersection that meets others: its number in Marks
    bool yields = false;        // gives way to some other lane
    bool branches = false;      // several lanes can follow
    bool by_way = false;        // of a lane with a stop line: its movements have lights of their own
    bool keeps_clear = true;    // of a lane inside an intersection: not entered without room in its exit
};

// How to go on from a lane with each turn.
struct WayOn {
    int route = -1;   // from this lane; -1: there is none
    int changes = 0;  // to the next lane from which there is one: so many lanes to the right; below 0: to the left
};

// The lanes beside one of an approach.
struct BesidePlan {
    int left = -1;
    int right = -1;
    int place = 0;  // on its approach, from the left
    double begin_m = 0.0;
    std::array<WayOn, kMostTurns> ways = {};  // [Turn]

    const WayOn& way(Turn turn) const { return ways[static_cast<std::size_t>(turn)]; }
    bool changes() const { return left >= 0 || right >= 0; }
};

// Lists one after the other in memory.
template <class T>
class Lists {
public:
    template <class List>
    void add(const List& list) {
        all_.insert(all_.end(), list.begin(), list.end());
        from_.push_back(all_.size());
    }
    std::span<const T> of(int list) const {
        const std::size_t from = from_[static_cast<std::size_t>(list)];
        return {all_.data() + from, from_[static_cast<std::size_t>(list) + 1] - from};
    }

    // Where in memory a list is, and what says so: visit(begin, end).
    template <class Visit>
    void for_each_place(int list, Visit visit) const {
        place_of_bounds(list, visit);
        visit(of(list).data(), of(list).data() + of(list).size());
    }
    template <class Visit>
    void place_of_bounds(int list, Visit visit) const {
        visit(from_.data() + list, from_.data() + list + 2);
    }

private:
    std::vector<T> all_;
    std::vector<std::size_t> from_{0};
};

class NetworkPlan {
public:
    explicit NetworkPlan(const Model& model);

    const LanePlan& lane(int lane) const { return lanes_[static_cast<std::size_t>(lane)]; }
    int lanes() const { return static_cast<int>(lanes_.size()); }
    // The longest vehicle, with the largest gap that one keeps to it at rest.
    double needs_at_most_m() const { return needs_at_most_m_; }
    // What vehicles of the mesoscale mode drive there at most.
    double driven_mps(int lane) const { return speed_factor_ * this->lane(lane).limit_mps; }
    std::span<const int> route(int route) const { return routes_.of(route); }
    std::span<const int> next(int lane) const { return next_.of(lane); }
    const BesidePlan& beside(int lane) const { return beside_[static_cast<std::size_t>(lane)]; }
    // Lanes with others beside, in order.
    const std::vector<int>& changing() const { return changing_; }
    // A route from some lane of an approach with that turn; -1: none.
    int route_with(int approach, Turn turn) const {
        return routes_with_[static_cast<std::size_t>(approach)][static_cast<std::size_t>(turn)];
    }
    Turn turn_of(int route) const { return turns_[static_cast<std::size_t>(route)]; }
    // Another route from the same lane with the same turn, to another lane; -1: there is no further one.
    int like(int route) const { return like_[static_cast<std::size_t>(route)]; }
    // The signal group that a vehicle on a lane with a stop line minds, which goes on to `next` (-1: it has none).
    int light_before(int lane, int next) const {
        const LanePlan& plan = this->lane(lane);
        const int own = plan.by_way && next >= 0 ? lights_[static_cast<std::size_t>(next)] : -1;
        return own >= 0 ? own : plan.signal_group;
    }
    // Of a lane inside an intersection: where the rears of its vehicles are clear of the other lanes of its origin.
    double clear_m(int lane) const { return parting_[static_cast<std::size_t>(lane)].clear_m; }
    // Of such a lane: vehicles can reach from its exit back over it to where they are not.
    bool is_short(int lane) const { return parting_[static_cast<std::size_t>(lane)].is_short; }
    bool waits_inside(int lane) const { return waits_inside_[static_cast<std::size_t>(lane)] != 0; }
    // The turn of a trip at the end of its leg-th edge; none: it ends there.
    Turn turn_of_trip(int trip, int leg) const { return demand_->turn_of_trip(trip, leg); }
    // Changes of lanes that a trip takes beyond its leg-th edge, if it leaves that from a lane, and from there on (trip_lanes.h).
    int changes_after(int trip, int leg, int lane) const {
        return trip_lanes_.after(demand_->trips[static_cast<std::size_t>(trip)], leg, beside(lane).place);
    }
    int changes_from(int trip, int leg, int lane, int places) const {
        return trip_lanes_.from(demand_->trips[static_cast<std::size_t>(trip)], leg, beside(lane).place, places);
    }
    // Brings its conflict areas into the cache.
    STOPLINE_INLINE void fetch_conflicts(int lane) const {
        for (const Conflict& conflict : conflicts_.of(lane)) __builtin_prefetch(&conflict);
    }
    // Of a lane inside an intersection: conflict areas from its start, and the marks of the lanes that it meets there.
    std::span<const Conflict> conflicts(int lane) const { return conflicts_.of(lane); }
    std::span<const NumbersOfWord> meets(int lane) const { return meets_.of(lane); }
    // Lanes inside are marked by number: those of an intersection share words, with no other one's, in the order of lanes.
    std::size_t marks() const { return marked_.size(); }
    int marked(std::size_t mark) const { return marked_[mark]; }  // -1: none has this number
    // Where in memory is what steps need to know of a lane: visit(begin, end).
    template <class Visit>
    void for_each_place(int lane, Visit visit) const {
        const auto one = [&](const auto& array) { visit(array.data() + lane, array.data() + lane + 1); };
        one(lanes_), one(parting_), one(lights_), one(waits_inside_);
        next_.for_each_place(lane, visit), meets_.for_each_place(lane, visit), conflicts_.place_of_bounds(lane, visit);
        for (const WayOn& way : beside(lane).ways) {
            if (way.route >= 0) routes_.for_each_place(way.route, visit);
        }
    }
    // Lanes by intersection: what happens in one of them in a step depends on what is done in it alone.
    const std::vector<int>& order() const { return order_; }
    int intersections() const { return intersections_; }
    // Number of the lanes that depend on each other in a step.
    int intersection_of(int lane) const { return intersection_of_[static_cast<std::size_t>(lane)]; }

private:
    void number_inside(const Model& model);

    double speed_factor_;
    double needs_at_most_m_ = 0.0;
    int intersections_ = 0;
    std::vector<LanePlan> lanes_;
    Lists<int> routes_;
    Lists<int> next_;
    Lists<Conflict> conflicts_;
    Lists<NumbersOfWord> meets_;
    std::vector<int> marked_;  // [mark]
    std::vector<int> order_;
    std::vector<int> intersection_of_;  // [lane]
    std::vector<BesidePlan> beside_;
    std::vector<int> changing_;
    std::vector<Turn> turns_;                               // [route]
    std::vector<std::array<int, kMostTurns>> routes_with_;  // [approach][turn]
    std::vector<int> like_;                                 // [route]
    std::vector<int> lights_;                               // [lane] Lane::light
    std::vector<char> waits_inside_;                        // [lane]
    struct PartingPlan {
        double clear_m = 0.0;
        bool is_short = false;
    };
    std::vector<PartingPlan> parting_;  // [lane]
    const DemandPlan* demand_;          // of the model, which outlives the plan
    TripLanes trip_lanes_;
};

}  // namespace stopline
