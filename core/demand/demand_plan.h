// The plan of the traffic: the vehicles that enter on each lane, with their spacing policies and routes. All draws use
// keyed random numbers, so runs with different spacing policies have the same sequence of routes.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "demand/demand_settings.h"
#include "network/lane_graph.h"

namespace stopline {

// A vehicle of an imported network, with its own departure time and path. The departure settings are those of SUMO.
struct Trip {
    double depart_s = 0.0;
    int approach = -1;   // the vehicle enters on the lanes of this approach
    int first_turn = 0;  // index of its first turn in DemandPlan::trip_turns
    int turn_count = 0;  // one turn at the end of each edge except the last
    float length_m = 0.0F;
    enum class DepartLane : std::uint8_t { given, rightmost, free, random, best };
    enum class DepartSpeed : std::uint8_t { given, limit, last, random };  // last: speed of the vehicle ahead
    // base: the rear is at the start of the lane. last: as close behind the last vehicle as the desired gap allows.
    // random: drawn once. free: drawn again until there is room.
    enum class DepartPosition : std::uint8_t { base, given, last, random, free };
    DepartLane depart_lane = DepartLane::rightmost;
    DepartSpeed depart_speed = DepartSpeed::given;
    DepartPosition depart_position = DepartPosition::base;
    int lane = 0;            // for DepartLane::given: counted from the left
    float speed_mps = 0.0F;  // for DepartSpeed::given
    float front_m = 0.0F;    // for DepartPosition::given: front position from the start of the lane
};

struct DemandPlan {
    // A lane where vehicles get a route. On an entry lane they enter the network; on a link lane they get their next
    // route.
    struct Inlet {
        int lane = 0;
        std::int64_t vehicles = 0;   // number of vehicles that enter the network here; usually 0 on links
        std::vector<int> routes;     // candidate routes
        std::vector<double> shares;  // [index in routes] shares, which sum to 1
        // The shares for a vehicle that chose this lane to suit its turn. They load all lanes of the approach equally.
        // Empty: use `shares`.
        std::vector<double> lane_shares = {};
        // The shares over all lanes of the approach. The draws keep to them even if some lanes discharge more vehicles
        // than others. Empty: no such correction.
        std::vector<double> approach_shares = {};
        double headway_s = 0.0;  // > 0: vehicles arrive here at this constant headway although the demand is saturated
    };
    std::vector<Inlet> inlets;  // entries, then links
    double entry_speed_mps = 0.0;
    double entry_headway_s = 2.0;  // minimum headway at an entry; with evenly_spaced: headway of the arrivals
    bool evenly_spaced = false;    // vehicles arrive at a constant headway and form a backlog if there is no room
    // The backlog of every inlet is endless. A vehicle enters at the gap of its policy behind the vehicle ahead, with
    // the speed of that vehicle, as part of an endless platoon.
    bool saturated = false;
    bool is_saturated(int inlet) const { return saturated && inlets[static_cast<std::size_t>(inlet)].headway_s == 0.0; }
    bool is_evenly_spaced(int inlet) const {
        return evenly_spaced || inlets[static_cast<std::size_t>(inlet)].headway_s > 0.0;
    }
    double inlet_headway_s(int inlet) const {
        const double own_s = inlets[static_cast<std::size_t>(inlet)].headway_s;
        return own_s > 0.0 ? own_s : entry_headway_s;
    }
    bool starts_queued = false;  // the run begins with a queue from every stop line back to the entry

    // The order of the drawn components. balanced: the shares hold in each block of 20 vehicles of an inlet.
    enum class Pattern { alternating, random, balanced };
    Pattern pattern = Pattern::alternating;
    std::vector<int> policies;          // [component] index of its spacing policy
    std::vector<double> policy_shares;  // [component] share; the shares sum to 1
    Pattern route_pattern = Pattern::random;
    std::uint64_t seed = 1;
    std::vector<Trip> trips;                                     // by departure time, then in the order of the input
    std::vector<Turn> trip_turns;                                // turns of all trips, one trip after the other
    std::shared_ptr<const std::vector<std::string>> trip_names;  // [trip]; null: no names
    std::vector<int> trip_policies;                              // [trip] spacing policy
    double shortest_trip_m = 1e9;                                // length of the shortest vehicle of all trips

    // Returns the turn at the end of an edge of a trip, or Turn::none on its last edge. Edges are counted from 0.
    Turn turn_of_trip(int trip, int edge) const {
        const Trip& own = trips[static_cast<std::size_t>(trip)];
        return edge < own.turn_count ? trip_turns[static_cast<std::size_t>(own.first_turn + edge)] : Turn::none;
    }
    // Draws the policies of all trips. The trips that enter at one approach are drawn like the vehicles of one inlet.
    void draw_trip_policies();

    // Returns the spacing policy of the k-th vehicle of an inlet, counted from 0.
    int policy_of(int inlet, std::int64_t k) const;
    // Returns the route of the k-th vehicle of an inlet, drawn from `shares`.
    int route_of(int inlet, std::int64_t k) const;
    // Returns the route of the k-th vehicle of an inlet, drawn from `lane_shares`.
    int route_for_chosen_lane(int inlet, std::int64_t k) const;
    // Returns the route of the k-th vehicle of an inlet that has approach_shares. The weights of the routes begin with
    // lane_shares if the vehicle chose its lane, else with shares. A route that is d vehicles behind its share gets its
    // weight multiplied by 1 + d / kBalanceVehicles. For a route that is ahead, the weight is divided likewise.
    // `drawn_per_route` counts the earlier draws of each route's turn on all lanes of the approach, and `total_drawn`
    // counts those of all turns.
    static constexpr double kBalanceVehicles = 4.0;
    int balancing_route(int inlet, std::int64_t k, std::span<const std::int64_t> drawn_per_route,
                        std::int64_t total_drawn, bool chose_lane) const;
};

// Returns the inlets of streets: all entries, then all links. They have routes and shares, but no vehicles yet.
//
// On an entry lane the shares are those of turns_by_lane(), where the movements of a pocket count for the lane beside
// it. On a link lane they are those of the approach. A route begins on the inlet's lane if that allows the turn, else
// on the nearest lane of the approach that does.
std::vector<DemandPlan::Inlet> street_inlets(const LaneGraph& graph);

}  // namespace stopline
