// Runs a scenario with several intersections (Section VI of the paper), and measures the results.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "measure/area.h"
#include "measure/hcm.h"
#include "runs/driving/driving_results.h"
#include "runs/network/congestion.h"
#include "runs/network/time_space.h"
#include "runs/observation.h"
#include "runs/v2v_results.h"
#include "scenario/scenario.h"
#include "sim/step/simulation.h"

namespace stopline {

// The stability of a run by the criteria of Section VI.D of the paper.
//   stable       no gridlock and no teleported vehicle
//   semi_stable  gridlocks or teleported vehicles occur, but no cause in InstabilityCause applies
//   unstable     a cause in InstabilityCause applies
enum class Stability : std::uint8_t { stable, semi_stable, unstable };
inline constexpr std::array<const char*, 3> kStabilityNames{"stable", "semi-stable", "unstable"};

// The cause that makes a run unstable. If several causes apply, the first cause in this list is reported.
//   throughput_drop  gridlocks occur and throughput drops for good, by kCollapseShare or more
//   teleported       the number of teleported vehicles is kSemiStableShare of the exited vehicles or more
//   gridlock         a gridlock exists at the end of the run and has lasted for six signal cycles or more
//   starvation       a movement starves (Starvation in sim/state/delay_log.h)
enum class InstabilityCause : std::uint8_t { none, throughput_drop, teleported, gridlock, starvation };
inline constexpr std::array<const char*, 5> kInstabilityCauseNames{"", "throughput_drop", "teleported", "gridlock",
                                                                   "starvation"};
inline constexpr double kSemiStableShare = 0.01;  // from Section VI.D of the paper
inline constexpr double kCollapseShare = 0.1;     // chosen for this project; the paper only says "significant"

// One interval of the time series.
struct NetworkInterval {
    AreaResult area;
    std::array<double, kDelayCauseNames.size()> delay_s{};  // [cause] delay in the whole network, vehicle seconds
    std::int64_t teleported = 0;
};

struct NetworkResult {
    std::string population;
    AreaResult measured;     // result over the measured window
    double warm_up_s = 0.0;  // end of the warm-up, found by warm_up() from the number of vehicles in the area
    std::vector<OriginDestinationResult> origin_destination;  // in the measured window
    std::vector<NetworkInterval> series;
    Stability stability = Stability::stable;
    InstabilityCause unstable_by = InstabilityCause::none;
    std::optional<double> collapse_s;  // time at which the run becomes unstable; empty: not unstable
    int full_cycles = 0;               // number of signal cycles after the network has filled
    DelayLog delays;
    GapCounts gap_counts;  // outcomes of cooperative gap opening
    Violations violations;
    V2vResult v2v;
    DrivingResults driving;
    VehicleNames vehicle_names;
    DepartureDelays departure;                         // departure delays of all vehicles that arrived
    std::vector<DepartureDelays> approach_departures;  // [approach] the same for streets
    double longest_in_junction_s = 0.0;
    double vehicles_present = 0.0;  // mean number of vehicles in the whole network over the measured window
    int max_present = 0;            // largest number of vehicles in the whole network
    std::int64_t entered = 0;
    std::int64_t exited = 0;
    std::int64_t updates = 0;  // number of vehicles in the network, summed over all steps
    std::uint64_t state_hash = 0;
    // Inflow, congestion, turn counts and lane changes are for the results of streets (street_results.h).
    std::vector<std::array<int, 4>> inflow;  // [interval][Side] vehicles that entered the area
    Congestion congestion;
    std::vector<std::array<std::int64_t, kMaxTurns>> turn_counts;  // [approach][Turn] vehicles that left the approach
    std::int64_t mandatory_lane_changes = 0;
    std::int64_t missed_turns = 0;  // imported networks: vehicles that reached the stop line in a wrong lane
    std::int64_t backlog = 0;       // vehicles that should have entered but found no room until the end of the run
    std::int64_t discretionary_lane_changes = 0;
    std::vector<HcmRow> hcm;   // empty unless measure.hcm is on
    StreetTrace street_trace;  // empty unless measure.time_space is set
    bool complete = false;     // false: the run was stopped before its end
};

// Returns the model of a network run. The model records delays, and crossings of stop lines and of the boundary of the
// measured area.
Model network_model(const Scenario& scenario, std::size_t population);

// Runs scenario.populations[population]. `on_step` is called before every step; if it returns false, the run is stopped
// before its end. `threads` is the number of threads that share the run.
NetworkResult run_network(const Scenario& scenario, std::size_t population,
                          const std::function<bool(const Simulation&)>& on_step = {}, int threads = 1,
                          const Observation& observation = {});

}  // namespace stopline
