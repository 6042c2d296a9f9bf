// Deadlocks in the reference engine: slow vehicles that wait for each other in a cycle. One of them proceeds.
#pragma once

#include <tuple>

#include "reference/junction/candidate.h"

namespace stopline::reference_engine {

class Deadlocks {
public:
    Deadlocks(World& world, Resolutions& resolutions) : w_(world), resolutions_(resolutions) {}

    // The candidates of a cycle are the vehicles whose blocker has not reached the conflict area yet. The candidate
    // that has waited longest proceeds. To be called when all yield stops of the step are known.
    void resolve() {
        for (const Lane& lane : w_.lanes) {
            for (const YieldStop& stop : lane.yield_stops) {
                if (stop.blocker_id >= 0) resolve_cycle(lane.vehicles[stop.index]);
            }
        }
    }

private:
    // A vehicle and its blocker: the vehicle that it waits for.
    struct Waiting {
        const Vehicle* vehicle = nullptr;
        const Vehicle* blocker = nullptr;      // null: it waits for nobody
        bool needs_only_right_of_way = false;  // true: the blocker is not in the conflict area yet
    };

    Waiting waiting(const Vehicle& v, int intersection) const {
        const Lane& on = w_.lane_of(v);
        if (!v.is_slow() || w_.intersection_of[static_cast<std::size_t>(v.lane)] != intersection) return {&v};
        for (const YieldStop& stop : on.yield_stops) {
            if (stop.index != v.index || stop.blocker_id < 0) continue;
            const Vehicle& blocker = w_.vehicle(stop.blocker_id);
            return {&v, &blocker, stop.reason != WaitReason::deadlock && !is_in_area(v, blocker)};
        }
        return {&v, is_blocked_by_leader(w_, v) ? queue_leader(w_, v) : nullptr};
    }

    // Returns true if the front of the blocker has reached the conflict area of both connections. Also returns true if
    // the connections do not conflict.
    bool is_in_area(const Vehicle& v, const Vehicle& blocker) const {
        const auto connection_of = [&](const Vehicle& of) {
            return w_.lane_of(of).is_connection() ? of.lane : of.next_lane;
        };
        const int connection = connection_of(v);
        if (connection < 0) return true;
        const Lane& blocker_lane = w_.lane_of(blocker);
        const double start_m = blocker_lane.is_connection() ? 0.0 : -blocker_lane.length_m;
        for (const Conflict& conflict : w_.lane(connection).conflicts) {
            if (conflict.other == connection_of(blocker)) return start_m + blocker.position_m > conflict.other_from_m;
        }
        return true;
    }

    void resolve_cycle(const Vehicle& start) {
        constexpr std::size_t kMaxCycle = 16;
        if (!start.is_slow()) return;
        const int intersection = w_.intersection_of[static_cast<std::size_t>(start.lane)];
        std::vector<Waiting> cycle{waiting(start, intersection)};
        while (cycle.back().blocker != nullptr && cycle.back().blocker != &start) {
            if (cycle.size() == kMaxCycle) return;
            cycle.push_back(waiting(*cycle.back().blocker, intersection));
        }
        if (cycle.back().blocker == nullptr) return;
        const auto rank = [](const Waiting& w) {
            return std::tuple(!w.needs_only_right_of_way, w.vehicle->wait_since_tick, w.vehicle->id);
        };
        const Waiting first = *std::min_element(cycle.begin(), cycle.end(),
                                                [&](const Waiting& a, const Waiting& b) { return rank(a) < rank(b); });
        if (!first.needs_only_right_of_way || first.vehicle != &start) return;
        ++w_.situations.deadlocks;
        if (Resolution* const known = resolutions_.find(start, *first.blocker)) {
            known->last_tick = w_.tick;
        } else {
            resolutions_.add(start, *first.blocker, w_.tick);
        }
    }

    World& w_;
    Resolutions& resolutions_;
};

}  // namespace stopline::reference_engine
