// The world of the reference engine: lanes with their vehicles, lights, kinds of vehicles, and counters. The phases of
// a step read and change it.
#pragma once

#include <numeric>
#include <optional>
#include <utility>

#include "reference/kinds.h"
#include "reference/world.h"
#include "sim/state/model.h"

namespace stopline::reference_engine {

// A vehicle inside an intersection, or one that will pass its stop line without green. Positions are measured from the
// start of its connection.
struct Occupant {
    Vehicle* vehicle = nullptr;
    double front_m = 0.0;
    double rear_m = 0.0;
    std::int64_t since = 0;  // tick at which the front passed the stop line
};

struct World {
    const Scenario& scenario;
    const Model& model;
    UndocumentedRules rules;
    double step_s;
    bool is_meso;
    bool is_imported;                // the vehicles are on trips through a network of SUMO
    std::vector<VehicleKind> kinds;  // [policy]
    MesoModel meso;
    std::vector<Lane> lanes;
    std::vector<std::size_t> order;         // all lanes, grouped by intersection
    std::vector<int> intersection_of;       // [lane]
    std::vector<Light> lights;              // [signal group]
    std::vector<std::int64_t> light_since;  // [signal group]
    std::int64_t tick = 0;
    std::vector<std::vector<Leader>> leaders;      // [lane][vehicle]
    std::vector<std::vector<Occupant>> occupants;  // [connection] furthest downstream first
    std::vector<LanePassage> passages;
    Situations situations;

    World(const Scenario& from, const Model& constants, const UndocumentedRules& undocumented)
        : scenario(from),
          model(constants),
          rules(undocumented),
          step_s(from.tick_s()),
          is_meso(from.is_meso()),
          is_imported(!constants.demand.trips.empty()),
          kinds(make_kinds(from)) {
        if (is_meso) meso = make_meso_model(scenario, model, kinds, rules);
        make_lanes();
        find_entry_speeds();
        group_lanes();
        for (int group = 0; group < model.graph.signal_groups; ++group) {
            lights.push_back(model.signals.programme(group).light(0));
            light_since.push_back(model.signals.programme(group).light_start_tick(0));
        }
        occupants.resize(lanes.size());
        leaders.resize(lanes.size());
    }

    double time_s() const { return static_cast<double>(tick) * step_s; }
    Lane& lane(int number) { return lanes[static_cast<std::size_t>(number)]; }
    const Lane& lane(int number) const { return lanes[static_cast<std::size_t>(number)]; }
    Lane& lane_of(const Vehicle& v) { return lane(v.lane); }
    const Lane& lane_of(const Vehicle& v) const { return lane(v.lane); }
    const VehicleKind& kind(int policy) const { return kinds[static_cast<std::size_t>(policy)]; }
    const VehicleKind& kind(const Vehicle& v) const { return kind(v.policy); }
    const DriverSettings& driver(const Vehicle& v) const { return kind(v).settings(); }
    const DriverSettings& common_driver() const { return kinds.front().settings(); }
    const std::vector<int>& route_of(int route) const {
        return model.graph.routes[static_cast<std::size_t>(route)].lanes;
    }
    std::span<const int> connections_to(int lane) const { return model.connections_to.of(lane); }
    const Leader& leader_of(const Vehicle& v) const { return leaders[static_cast<std::size_t>(v.lane)][v.index]; }

    // Returns the signal group that a vehicle obeys on an approach lane if it takes the connection `next` (-1: none).
    int group_of(const Lane& approach, int next) const {
        const int own = next >= 0 ? lane(next).movement_signal_group : -1;
        return approach.has_movement_signals && own >= 0 ? own : approach.signal_group;
    }
    Light light(int group) const { return lights[static_cast<std::size_t>(group)]; }
    std::int64_t since(int group) const { return light_since[static_cast<std::size_t>(group)]; }
    // Returns the signal group for a connection.
    int group_of_connection(int connection) const { return group_of(lane(lane(connection).origin), connection); }

    // Returns the speed of the speed limiter; infinity if no vehicle has a limiter below a speed limit.
    double maximum_speed_mps(int policy) const {
        return model.has_speed_limiters ? kind(policy).vehicle.settings.maximum_speed_mps : kNoLimit;
    }
    double free_speed_mps(const Lane& on, int policy) const {
        const double factor = is_meso ? scenario.meso.speed_factor : 1.0;
        return std::min(factor * on.limit_mps, maximum_speed_mps(policy));
    }
    // Returns the net gap that a policy keeps behind a leader of the same constant speed.
    double desired_gap_m(int policy, double speed_mps) const {
        if (!is_meso) return law_gap(kind(policy).policy, speed_mps).gap_m;
        const MesoPolicy& p = meso.policies[static_cast<std::size_t>(policy)];
        return p.equilibrium_gap_m(speed_mps) + p.extra_gap_m(speed_mps);
    }
    // Returns the length of the longest vehicle plus the largest standstill gap.
    double longest_space_m() const {
        double length_m = 0.0;
        double gap_m = 0.0;
        for (const VehicleKind& k : kinds) {
            length_m = std::max(length_m, k.length_m);
            gap_m = std::max(gap_m, k.policy.settings.standstill_gap_m);
        }
        for (const Trip& trip : model.demand.trips) length_m = std::max(length_m, static_cast<double>(trip.length_m));
        return length_m + gap_m;
    }
    double space_m(const Vehicle& v) const { return v.length_m + kind(v).standstill_gap_m; }

    // Sets Vehicle::lane and Vehicle::index of all vehicles.
    void number_vehicles() {
        for (Lane& on : lanes) {
            for (std::size_t k = 0; k < on.vehicles.size(); ++k) {
                on.vehicles[k].lane = on.number;
                on.vehicles[k].index = k;
            }
        }
    }
    // Returns true if `a` comes before `b` in the order of lanes, and on one lane further downstream.
    bool is_before(const Vehicle& a, const Vehicle& b) const {
        if (a.lane == b.lane) return a.index < b.index;
        const auto place = [&](int number) {
            return std::find(order.begin(), order.end(), static_cast<std::size_t>(number));
        };
        return place(a.lane) < place(b.lane);
    }
    Vehicle& vehicle(int id) {
        for (Lane& on : lanes) {
            for (Vehicle& v : on.vehicles) {
                if (v.id == id) return v;
            }
        }
        std::abort();  // never reached: callers ask for vehicles in the network
    }
    void update_lights() {
        for (std::size_t group = 0; group < lights.size(); ++group) {
            const Light now = model.signals.programme(static_cast<int>(group)).light(tick);
            if (now != lights[group]) light_since[group] = tick;
            lights[group] = now;
        }
    }

private:
    void make_lanes() {
        const LaneGraph& graph = model.graph;
        for (std::size_t number = 0; number < graph.lanes.size(); ++number) {
            Lane on;
            static_cast<stopline::Lane&>(on) = graph.lanes[number];
            on.number = static_cast<int>(number);
            if (on.is_connection()) on.exit = on.next.front();
            on.next_limit_m = on.signal_group >= 0 ? on.stop_line_m : on.length_m;
            on.sine = on.gradient / std::sqrt(1.0 + on.gradient * on.gradient);
            on.conflicts = graph.conflicts_of(on.number);
            for (const Conflict& conflict : on.conflicts) {
                on.first_conflict_m = std::min(on.first_conflict_m, conflict.from_m);
                on.yields = on.yields || conflict.yields;
            }
            for (const int next : on.next) {
                const bool has_own = graph.lanes[static_cast<std::size_t>(next)].movement_signal_group >= 0;
                on.has_movement_signals = on.has_movement_signals || (!on.is_connection() && has_own);
            }
            lanes.push_back(std::move(on));
        }
        for (const Approach& approach : graph.approaches) {
            for (std::size_t k = 0; k < approach.lanes.size(); ++k) lane(approach.lanes[k]).index = static_cast<int>(k);
        }
        for (const PhasePriority& changing : model.phase_priorities) {
            for (const PriorityStage& stage : changing.stages()) {
                lane(changing.first()).yields |= stage.priority.first_yields;
                lane(changing.second()).yields |= stage.priority.second_yields;
            }
        }
    }

    // Sets Lane::entry_mps. At the end of a lane that branches, the fastest next lane counts.
    void find_entry_speeds() {
        double braking_mps2 = kNoLimit;
        for (const VehicleKind& k : kinds)
            braking_mps2 = std::min(braking_mps2, k.settings().free_drive.deceleration_mps2);
        for (Lane& on : lanes) on.entry_mps = on.limit_mps;
        for (std::size_t round = 0; round < lanes.size(); ++round) {
            for (Lane& on : lanes) {
                if (on.next.empty()) continue;
                double end_mps = 0.0;
                for (const int next : on.next) end_mps = std::max(end_mps, lane(next).entry_mps);
                on.entry_mps =
                    std::min(on.entry_mps, std::sqrt(end_mps * end_mps + 2.0 * braking_mps2 * on.next_limit_m));
            }
        }
    }

    // Sets `intersection_of` and `order`. The approaches, connections and final exit lanes of an intersection belong
    // together.
    void group_lanes() {
        intersection_of.resize(lanes.size());
        std::iota(intersection_of.begin(), intersection_of.end(), 0);
        const auto join = [&](int a, int b) {
            const int to =
                std::min(intersection_of[static_cast<std::size_t>(a)], intersection_of[static_cast<std::size_t>(b)]);
            const int from =
                std::max(intersection_of[static_cast<std::size_t>(a)], intersection_of[static_cast<std::size_t>(b)]);
            std::replace(intersection_of.begin(), intersection_of.end(), from, to);
        };
        for (const Lane& on : lanes) {
            if (!on.is_connection()) continue;
            join(on.number, on.origin);
            for (const Conflict& conflict : on.conflicts) join(on.number, conflict.other);
            if (lane(on.exit).signal_group < 0) join(on.number, on.exit);
        }
        for (const Approach& approach : model.graph.approaches) {
            for (const int number : approach.lanes) join(approach.lanes.front(), number);
        }
        order.resize(lanes.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return intersection_of[a] < intersection_of[b]; });
    }
};

// --- Braking and stopping distances -------------------------------------------------------------------------------

// Returns the distance in which constant braking changes the speed from `from_mps` to `to_mps`; 0 if that is higher.
inline double braking_m(double from_mps, double to_mps, double deceleration_mps2) {
    return std::max(from_mps * from_mps - to_mps * to_mps, 0.0) / (2.0 * deceleration_mps2);
}
inline double comfortable_braking_m(const DriverSettings& driver, double speed_mps) {
    return braking_m(speed_mps, 0.0, driver.stop.deceleration_mps2);
}
// Returns the distance of a comfortable stop, in full dynamics with the lag of the brake.
inline double comfortable_stop_m(const World& world, const DriverSettings& driver, double speed_mps) {
    return comfortable_braking_m(driver, speed_mps) + (world.is_meso ? 0.0 : kLanding_s * speed_mps);
}
inline double emergency_braking_m(const World& world, double speed_mps) {
    return braking_m(speed_mps, 0.0, world.common_driver().cacc.deceleration_emergency_mps2);
}
// Returns the distance within which a vehicle decides about a stop.
inline double decision_distance_m(const DriverSettings& driver, double speed_mps) {
    return comfortable_braking_m(driver, speed_mps) + 1.5 * speed_mps + 3.0;
}

}  // namespace stopline::reference_engine
