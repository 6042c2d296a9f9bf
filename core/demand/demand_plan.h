// The plan of the traffic: the vehicles that enter on each lane, with their spacing policies and routes. At each inlet,
// vehicles are numbered in the order of entry. The random numbers for a vehicle depend only on the seed, the inlet and
// this number. So runs with different spacing policies have the same sequence of routes.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "demand/demand_settings.h"
#include "network/lane_graph.h"

namespace stopline {

// The trip of one vehicle through an imported network, with its departure time and its path. The path is a sequence of
// edges, the roads between the intersections of the SUMO network. The departure lane, speed and position correspond to
// SUMO's attributes departLane, departSpeed and departPos.
struct Trip {
    double depart_s = 0.0;
    int approach = -1;   // the vehicle enters on a lane of this approach
    int first_turn = 0;  // index in DemandPlan::trip_turns of the first turn
    int turn_count = 0;  // number of turns: one at the end of each edge except the last edge
    float length_m = 0.0F;
    enum class DepartLane : std::uint8_t { given, rightmost, free, random, best };
    // limit: the speed limit. last: the speed of the vehicle ahead. mean: the mean speed of the vehicles on the lane.
    enum class DepartSpeed : std::uint8_t { given, limit, last, mean, random };
    // base: the rear of the vehicle is at the start of the lane. last: the vehicle is as close behind the rearmost
    // vehicle on the lane as its desired gap allows. random: one position is drawn at random. free: a new position is
    // drawn in each step until there is room.
    enum class DepartPosition : std::uint8_t { base, given, last, random, free };
    DepartLane depart_lane = DepartLane::rightmost;
    DepartSpeed depart_speed = DepartSpeed::given;
    DepartPosition depart_position = DepartPosition::base;
    int lane = 0;            // for DepartLane::given: index of the lane in its approach, from the left
    float speed_mps = 0.0F;  // for DepartSpeed::given
    float front_m = 0.0F;    // for DepartPosition::given: distance of the front from the start of the lane
};

struct DemandPlan {
    // A lane where vehicles get a route. On an entry lane, vehicles that enter the network get their first route. On a
    // link lane (from one intersection to the next), vehicles get the route through the next intersection.
    struct Inlet {
        int lane = 0;
        // Number of vehicles that enter the network on this lane; the largest integer if the number is unlimited. A
        // link lane has vehicles of its own only if DemandSettings::approaches names its approach.
        std::int64_t vehicles = 0;
        std::vector<int> routes;     // routes from which the route of a vehicle is drawn
        std::vector<double> shares;  // [index in `routes`] share of the route; the shares sum to 1
        // [index in `routes`] share of the route for a vehicle that uses this lane because the lane suits its turn.
        // With these shares, all lanes of the approach carry equal traffic. Empty: `shares` apply.
        std::vector<double> lane_shares = {};
        // [index in `routes`] share of the vehicles on the whole approach that make the turn of this route.
        // balancing_route() corrects the draws so that these shares hold even if some lanes discharge more vehicles
        // than other lanes. Empty: no correction.
        std::vector<double> approach_shares = {};
        double headway_s = 0.0;  // > 0: vehicles arrive with this constant headway, even if `saturated` is set
        // The next two lists are used only if `has_arrival_times` is set.
        std::vector<double> arrivals_s = {};  // arrival times of the vehicles, ascending
        std::vector<int> paths = {};          // [arrival] start of the vehicle's path in path_routes; -1: no path
    };
    std::vector<Inlet> inlets;  // entry lanes, then link lanes
    double entry_speed_mps = 0.0;
    double entry_headway_s = 2.0;  // minimum headway of entering vehicles; if evenly_spaced: headway of arrivals
    // True: vehicles arrive with a constant headway. Vehicles that find no room form a backlog.
    bool evenly_spaced = false;
    // The backlog of every inlet is endless, and vehicles enter as an endless platoon: each has the speed of the
    // vehicle ahead and the desired gap of its own policy.
    bool saturated = false;
    // True: vehicles arrive at the times in Inlet::arrivals_s. Vehicles that find no room form a backlog.
    bool has_arrival_times = false;
    // Paths of vehicles: sequences of routes. Each path ends with -1. Beyond its end, routes are drawn.
    std::vector<int> path_routes;
    bool is_saturated(int inlet) const { return saturated && inlets[static_cast<std::size_t>(inlet)].headway_s == 0.0; }
    bool is_evenly_spaced(int inlet) const {
        return evenly_spaced || inlets[static_cast<std::size_t>(inlet)].headway_s > 0.0;
    }
    // Returns true if each vehicle of the inlet has an arrival time, so that a vehicle without room waits in a backlog.
    bool forms_backlog(int inlet) const {
        return has_arrival_times || (!is_saturated(inlet) && is_evenly_spaced(inlet));
    }
    double inlet_headway_s(int inlet) const {
        const double own_s = inlets[static_cast<std::size_t>(inlet)].headway_s;
        return own_s > 0.0 ? own_s : entry_headway_s;
    }
    bool starts_queued = false;  // the run begins with a queue from every stop line back to the entry

    // The order in which policies or routes are assigned to successive vehicles. alternating: each vehicle gets the
    // policy or route whose number of vehicles so far is furthest below its share. balanced: the order is random, but
    // the shares hold in each block of 20 successive vehicles of an inlet.
    enum class Pattern { alternating, random, balanced };
    Pattern pattern = Pattern::alternating;  // order of the spacing policies
    std::vector<int> policies;               // [component of the population] index of its spacing policy
    std::vector<double> policy_shares;       // [component of the population] share; the shares sum to 1
    Pattern route_pattern = Pattern::random;
    std::uint64_t seed = 1;
    std::vector<Trip> trips;                                     // sorted by departure time
    std::vector<Turn> trip_turns;                                // turns of all trips, one trip after the other
    std::shared_ptr<const std::vector<std::string>> trip_names;  // [trip] name; null: trips have no names
    std::vector<int> trip_policies;                              // [trip] index of its spacing policy
    double shortest_vehicle_m = 1e9;                             // length of the shortest vehicle of all trips

    // Returns the turn at the end of an edge of a trip, or Turn::none on its last edge. Edges are counted from 0.
    Turn turn_of_trip(int trip, int edge) const {
        const Trip& own = trips[static_cast<std::size_t>(trip)];
        return edge < own.turn_count ? trip_turns[static_cast<std::size_t>(own.first_turn + edge)] : Turn::none;
    }
    // Draws the spacing policies of all trips. Trips that begin on the same approach are drawn like the vehicles of one
    // inlet.
    void draw_trip_policies();

    // Returns the spacing policy of the k-th vehicle of an inlet, counted from 0.
    int policy_of(int inlet, std::int64_t k) const;
    // Returns the route of the k-th vehicle of an inlet, drawn from `shares`.
    int route_of(int inlet, std::int64_t k) const;
    // Returns the route of the k-th vehicle of an inlet, drawn from `lane_shares`.
    int route_for_chosen_lane(int inlet, std::int64_t k) const;
    // Draws the route of the k-th vehicle of an inlet so that the shares in Inlet::approach_shares hold. This list must
    // not be empty. The weights of the routes are lane_shares if the vehicle chose its lane because of its turn, else
    // `shares`. If a turn was drawn d times too rarely on the whole approach, the weight of its route is multiplied by
    // 1 + d / kBalanceVehicles. If the turn was drawn d times too often, the weight is divided by this factor.
    // `drawn_per_route` counts the earlier draws of each route's turn on all lanes of the approach. `total_drawn` is
    // the number of earlier draws of all turns.
    static constexpr double kBalanceVehicles = 4.0;
    int balancing_route(int inlet, std::int64_t k, std::span<const std::int64_t> drawn_per_route,
                        std::int64_t total_drawn, bool chose_lane) const;
};

// Returns the inlets of streets: all entry lanes, then all link lanes. The inlets have routes and shares, but no
// vehicles yet.
//
// On an entry lane, turns_by_lane() computes the shares. A turn that only a pocket allows is assigned to the nearest
// entry lane. On a link lane, the shares are the turn shares of the approach. The route for a turn begins on the lane
// of the inlet if this lane allows the turn, else on the nearest lane of the approach that allows it.
std::vector<DemandPlan::Inlet> street_inlets(const LaneGraph& graph);

}  // namespace stopline
