// The vehicles inside intersections in the reference engine, and who waits for whom.
#pragma once

#include "reference/perception.h"

namespace stopline::reference_engine {

// Returns true if the vehicle waits before a conflict area or at a stop sign, and is slow.
inline bool is_yielding(const World& world, const Vehicle& v) { return v.yield_tick >= world.tick - 1 && v.is_slow(); }
// Returns true if the vehicle yields at a position that is not beyond `area_m`, a position on its connection.
inline bool is_yielding_before(const World& world, const Vehicle& v, double area_m) {
    return is_yielding(world, v) && stored(v.yield_position_m) <= stored(area_m);
}
// Returns true if the vehicle yields, but not to a vehicle that must itself yield.
inline bool lets_others_go(const World& world, const Vehicle& v) {
    return is_yielding(world, v) && v.yield_reason != WaitReason::intruder;
}

// Returns true if the vehicle and its leader are slow and close together.
inline bool is_blocked_by_leader(const World& world, const Vehicle& v) {
    const Leader& leader = world.leader_of(v);
    const double close_m = std::max(6.0, world.kind(v).standstill_gap_m + 3.0);
    return leader.vehicle != nullptr && v.is_slow() && leader.speed_mps < kCrawlingSpeed_mps && leader.gap_m < close_m;
}

// Returns the leader of a queued vehicle; null if none is near.
inline const Vehicle* queue_leader(const World& world, const Vehicle& v) {
    const Lane& on = world.lane_of(v);
    if (v.index > 0) return &on.vehicles[v.index - 1];
    const double range_m = std::max(20.0, world.kind(v).standstill_gap_m + 17.0);
    return Perception(world).beyond_lane(v, range_m).vehicle;
}

// Returns true if an occupant of a connection stands in a queue behind a yielding vehicle. Beyond the connection, the
// queue is followed by one vehicle only, and only within the intersection.
inline bool is_behind_yielding_vehicle(const World& world, int connection, const Occupant& occupant) {
    constexpr int kMaxQueue = 8;
    const Vehicle* v = occupant.vehicle;
    for (int n = 0; n < kMaxQueue && is_blocked_by_leader(world, *v); ++n) {
        const bool leaves_lane = v->index == 0;
        v = queue_leader(world, *v);
        if (v == nullptr) return false;
        if (leaves_lane && v->lane != connection) {
            const auto intersection = [&](int lane) { return world.intersection_of[static_cast<std::size_t>(lane)]; };
            return intersection(v->lane) == intersection(connection) && is_yielding(world, *v);
        }
        if (is_yielding(world, *v)) return true;
    }
    return false;
}

// Returns the time for a distance if the vehicle accelerates up to the speed limit. A faster vehicle keeps its speed.
inline double earliest_arrival_s(double distance_m, double speed_mps, double acceleration_mps2, double limit_mps) {
    const double gain_mps = std::max(limit_mps - speed_mps, 0.0);
    const double gain_m = gain_mps * (speed_mps + 0.5 * gain_mps) / acceleration_mps2;
    if (distance_m > gain_m)
        return gain_mps / acceleration_mps2 + (distance_m - gain_m) / std::max(limit_mps, speed_mps);
    return (std::sqrt(speed_mps * speed_mps + 2.0 * acceleration_mps2 * distance_m) - speed_mps) / acceleration_mps2;
}

// Lists the occupants of each connection. To be called before the decisions at the stop lines.
class OccupantSearch {
public:
    explicit OccupantSearch(World& world) : w_(world) {}

    void search() {
        for (std::vector<Occupant>& of_lane : w_.occupants) of_lane.clear();
        for (const std::size_t number : w_.order) {
            Lane& connection = w_.lanes[number];
            if (!connection.is_connection()) continue;
            Lane& exit = w_.lane(connection.exit);
            if (exit.length_m < w_.longest_space_m()) add_from_beyond(connection, exit);
            for (Vehicle& v : exit.vehicles) {
                if (v.position_m < v.length_m && v.previous_lane == connection.number)
                    add(connection.number, v, connection.length_m,
                        v.position_m > exit.next_limit_m ? w_.tick : v.entry_tick);
            }
            for (Vehicle& v : connection.vehicles) add(connection.number, v, 0.0, v.entry_tick);
        }
        for (const std::size_t number : w_.order) {
            if (w_.lanes[number].signal_group >= 0) search_approach(w_.lanes[number]);
        }
    }

private:
    // Adds the vehicles on the connections behind a short exit lane whose rear is still upstream of this lane.
    void add_from_beyond(const Lane& connection, const Lane& exit) {
        for (const int next : exit.next) {
            for (Vehicle& v : w_.lane(next).vehicles) {
                const bool reaches_back = exit.length_m + v.position_m < v.length_m;
                if (reaches_back && v.previous_lane == exit.number && v.second_previous_lane == connection.number)
                    add(connection.number, v, connection.length_m + exit.length_m, w_.tick);
            }
        }
    }

    // Adds the vehicles on an approach lane that have passed the stop line, or that will pass it without green.
    void search_approach(Lane& approach) {
        for (Vehicle& v : approach.vehicles) {
            const bool is_inside = v.position_m > approach.stop_line_m;
            if (!is_inside && !passes_without_green(approach, v)) return;
            if (v.next_lane < 0 || w_.lane(v.next_lane).origin != approach.number) continue;
            add(v.next_lane, v, -approach.length_m, is_inside ? v.entry_tick : w_.tick);
        }
    }

    // In the step in which the light changes, no vehicle has been chosen to stop yet, so no vehicle passes.
    bool passes_without_green(const Lane& approach, const Vehicle& v) const {
        const int group = w_.group_of(approach, v.next_lane);
        return v.id != approach.stopping_id && w_.light(group) != Light::green && w_.since(group) < w_.tick;
    }

    void add(int connection, Vehicle& v, double start_m, std::int64_t since) {
        const double front_m = start_m + v.position_m;
        w_.occupants[static_cast<std::size_t>(connection)].push_back({&v, front_m, front_m - v.length_m, since});
    }

    World& w_;
};

}  // namespace stopline::reference_engine
