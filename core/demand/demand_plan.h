// Who enters where: for each entry lane how many vehicles, and for each of them its policy, vehicle type and route. Drawn
// from keyed random numbers, so that different policies meet the same sequence.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "demand/demand_settings.h"
#include "network/lane_graph.h"

namespace stopline {

// A vehicle that enters at a time of its own and follows a way of its own. Cold data.
struct Trip {
    double depart_s = 0.0;
    int approach = -1;   // where it enters: on the lanes of this approach
    int first_turn = 0;  // in DemandPlan::trip_turns
    int turns = 0;       // of the trip, one at the end of each of its edges but for the last
    float length_m = 0.0F;
    enum class Where : std::uint8_t { lane, rightmost, free, random, best } where = Where::rightmost;
    enum class Fast : std::uint8_t { given, limit, as_last, random } fast = Fast::given;
    // base: its rear at the start of the lane; last: as near behind the last vehicle as its gap allows; random: drawn once;
    // free: drawn until there is room.
    enum class Along : std::uint8_t { base, given, last, random, free } along = Along::base;
    int lane = 0;            // where that is given, counted from the left
    float speed_mps = 0.0F;  // where that is given
    float front_m = 0.0F;    // where that is given, from the start of the lane
};

struct DemandPlan {
    // A lane where vehicles get a route: an entry, or a link between intersections, where they get their next.
    struct Inlet {
        int lane = 0;
        std::int64_t vehicles = 0;   // that enter the network here in all; mostly 0 on links
        std::vector<int> routes;     // candidate routes, and ...
        std::vector<double> shares;  // ... their shares, summing to 1
        // The same of vehicles that chose the lane for where they go: such that all lanes of the approach are as full; empty: as `shares`.
        std::vector<double> lane_shares = {};
        // Those of the approach as a whole, for the same routes, which hold whatever its lanes let through; empty: not asked for.
        std::vector<double> approach_shares = {};
        double headway_s = 0.0;  // vehicles arrive evenly here, though all other inlets are saturated; 0: as the others
    };
    std::vector<Inlet> inlets;  // entries, then links
    double entry_speed_mps = 0.0;
    double entry_headway_s = 2.0;  // at least, between two fronts at the entry; on average, ...
    bool evenly = false;           // ... where vehicles arrive evenly and wait outside while there is no room
    // Inlets never run dry: each vehicle enters as part of an endless platoon, in the gap of its policy and with the speed of
    // the vehicle ahead.
    bool saturated = false;
    bool is_saturated(int inlet) const { return saturated && inlets[static_cast<std::size_t>(inlet)].headway_s == 0.0; }
    bool is_even(int inlet) const { return evenly || inlets[static_cast<std::size_t>(inlet)].headway_s > 0.0; }
    double headway_at(int inlet) const {
        const double own_s = inlets[static_cast<std::size_t>(inlet)].headway_s;
        return own_s > 0.0 ? own_s : entry_headway_s;
    }
    bool queued = false;  // a queue stands from the stop line to the entry when the run begins

    // Policy of the k-th vehicle of an inlet: component shares, and how they are arranged.
    enum class Pattern { alternating, random, balanced };
    Pattern pattern = Pattern::alternating;
    std::vector<int> policies;
    std::vector<double> policy_shares;
    Pattern route_pattern = Pattern::random;
    std::uint64_t seed = 1;
    std::vector<Trip> trips;                                     // by time of departure, then in the order of the input
    std::vector<Turn> trip_turns;                                // of all trips, one after the other
    std::shared_ptr<const std::vector<std::string>> trip_names;  // [trip]; null: they have none
    std::vector<int> trip_policies;                              // [trip]
    double shortest_trip_m = 1e9;                                // of their vehicles

    // At the end of the leg-th edge of a trip; none: it ends there.
    Turn turn_of_trip(int trip, int leg) const {
        const Trip& own = trips[static_cast<std::size_t>(trip)];
        return leg < own.turns ? trip_turns[static_cast<std::size_t>(own.first_turn + leg)] : Turn::none;
    }
    // Draws the policies of all trips: those that enter at one approach are counted as an inlet's.
    void draw_trip_policies();

    // The k-th vehicle (from 0) of inlet `i`.
    int policy_of(int inlet, std::int64_t k) const;
    int route_of(int inlet, std::int64_t k) const;
    // The same for one that chose its lane.
    int route_on_lane(int inlet, std::int64_t k) const;
    // The same where approach_shares are asked for: `drawn` [route] is how often each turn was drawn before, `all` how often any, on all lanes of the approach. Shares are
    // multiplied by 1 + d / kPatience for a route that is d vehicles behind its share, and divided likewise for one ahead.
    static constexpr double kPatience = 4.0;
    int route_that_is_due(int inlet, std::int64_t k, std::span<const std::int64_t> drawn, std::int64_t all,
                          bool chose_lane) const;
};

// Of all entries of streets, then of all links, with routes and shares, and no vehicle. Vehicles that enter the network turn from a lane
// as turns_by_lane() says; what a pocket allows counts for the lane beside it. On links they turn as those of the approach as a whole.
// A route begins on the inlet's own lane where that allows the turn, else on the nearest one of the approach that does.
std::vector<DemandPlan::Inlet> street_inlets(const LaneGraph& graph);

}  // namespace stopline
