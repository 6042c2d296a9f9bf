// Lead gaps and lag gaps on adjacent lanes in the reference engine. The rules are those of the comments in
// core/sim/perception/lane_gaps.h.
#pragma once

#include "reference/demand.h"
#include "reference/perception.h"

namespace stopline::reference_engine {

// A vehicle that would be the leader or the follower after a lane change.
struct Neighbour {
    const Vehicle* vehicle = nullptr;  // null: there is none
    double gap_m = kNoLeaderGap_m;     // net gap

    double speed_mps() const { return vehicle == nullptr ? 0.0 : vehicle->speed_mps; }
};

struct Neighbours {
    std::size_t index = 0;  // number of vehicles on the lane that would be ahead
    Neighbour leader;
    Neighbour follower;
};

class LaneGaps {
public:
    explicit LaneGaps(const World& world) : w_(world), perception_(world) {}

    // Returns the number of vehicles of a lane with their front at `front_m` or further downstream.
    static std::size_t vehicles_ahead(const Lane& on, double front_m) {
        return static_cast<std::size_t>(std::count_if(on.vehicles.begin(), on.vehicles.end(),
                                                      [&](const Vehicle& v) { return v.position_m >= front_m; }));
    }

    // Returns the neighbours that a vehicle would have on a lane. `route`: begins on the lane; -1: none does.
    Neighbours at(const Lane& on, double front_m, double length_m, int route) const {
        Neighbours found;
        found.index = vehicles_ahead(on, front_m);
        found.leader = found.index == 0
                           ? leader_beyond(on, front_m, route)
                           : Neighbour{&on.vehicles[found.index - 1], on.vehicles[found.index - 1].rear_m() - front_m};
        found.follower =
            found.index == on.vehicles.size()
                ? follower_upstream(on, front_m - length_m)
                : Neighbour{&on.vehicles[found.index], front_m - length_m - on.vehicles[found.index].position_m};
        return found;
    }

    // Returns the gap that a vehicle needs behind a leader after a lane change: a share of the gap of its policy, and
    // the distance to brake to the speed of the leader.
    double required_m(int policy, double speed_mps, double ahead_mps, double share) const {
        constexpr double kMinGap_m = 1.0;
        constexpr double kGentleBraking_mps2 = 2.0;
        constexpr double kDelay_s = 0.3;
        const double b =
            w_.is_meso ? w_.meso.policies[static_cast<std::size_t>(policy)].braking_mps2() : kGentleBraking_mps2;
        const double delay_m = w_.is_meso ? 0.0 : kDelay_s * std::max(speed_mps - ahead_mps, 0.0);
        return std::max(share * w_.desired_gap_m(policy, speed_mps), kMinGap_m) + braking_m(speed_mps, ahead_mps, b) +
               delay_m;
    }

private:
    Neighbour leader_beyond(const Lane& on, double front_m, int route) const {
        constexpr double kLookAhead_m = 150.0;
        if (route >= 0) {
            const Ahead ahead = perception_.beyond(on.number, front_m, {route, 0}, kLookAhead_m);
            return ahead.vehicle == nullptr ? Neighbour{} : Neighbour{ahead.vehicle, ahead.rear_m() - front_m};
        }
        Neighbour nearest;
        for (const int next : on.next) {
            if (w_.lane(next).vehicles.empty()) continue;
            const Vehicle& last = w_.lane(next).vehicles.back();
            const double gap_m = on.length_m + last.rear_m() - front_m;
            if (gap_m < nearest.gap_m) nearest = {&last, gap_m};
        }
        return nearest;
    }

    // Returns the nearest vehicle that approaches the lane over a connection. Its gap ends at `rear_m` of the lane.
    Neighbour follower_upstream(const Lane& on, double rear_m) const {
        Neighbour nearest;
        const auto consider = [&](const Vehicle& v, double gap_m) {
            if (gap_m < nearest.gap_m) nearest = {&v, gap_m};
        };
        for (const int number : w_.connections_to(on.number)) {
            const Lane& connection = w_.lane(number);
            if (!connection.vehicles.empty()) {
                const Vehicle& first = connection.vehicles.front();
                consider(first, connection.length_m - first.position_m + rear_m);
                continue;
            }
            const Lane& origin = w_.lane(connection.origin);
            const auto takes_it = [&](const Vehicle& v) { return v.next_lane == number; };
            const auto first = std::find_if(origin.vehicles.begin(), origin.vehicles.end(), takes_it);
            if (first != origin.vehicles.end())
                consider(*first, origin.length_m - first->position_m + connection.length_m + rear_m);
        }
        return nearest;
    }

    const World& w_;
    Perception perception_;
};

}  // namespace stopline::reference_engine
