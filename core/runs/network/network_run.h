// One run of a network of several intersections (Section VI of the paper), from the scenario to its results.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "measure/area.h"
#include "runs/network/congestion.h"
#include "runs/network/time_space.h"
#include "runs/observation.h"
#include "scenario/scenario.h"
#include "sim/step/simulation.h"

namespace stopline {

// Section VI.D of the paper.
//   stable       no gridlock and no teleported vehicle
//   semi_stable  gridlocks dissolve, and teleported vehicles are below kSemiStableShare of the exited vehicles
//   unstable     for an InstabilityCause
enum class Stability : std::uint8_t { stable, semi_stable, unstable };
inline constexpr std::array<const char*, 3> kStabilityNames{"stable", "semi-stable", "unstable"};

// The reason why a run is unstable. The first one that holds is reported.
//   throughput_drop  gridlocks occur and throughput drops for good, by kCollapseShare or more
//   teleported       teleported vehicles reach kSemiStableShare of the exited vehicles
//   gridlock         a gridlock of six signal cycles or more exists at the end
enum class InstabilityCause : std::uint8_t { none, throughput_drop, teleported, gridlock };
inline constexpr std::array<const char*, 4> kInstabilityCauseNames{"", "throughput_drop", "teleported", "gridlock"};
inline constexpr double kSemiStableShare = 0.01;  // Section VI.D
inline constexpr double kCollapseShare = 0.1;     // our choice; the paper calls the drop "significant"

// One interval of the time series.
struct NetworkInterval {
    AreaResult area;
    std::array<double, kDelayCauseNames.size()> delay_s{};  // [cause] vehicle seconds in the whole network
    std::int64_t teleported = 0;
};

struct NetworkResult {
    std::string population;
    AreaResult measured;     // mean over the measured window
    double warm_up_s = 0.0;  // end of the warm-up, from the number of vehicles in the area (measure/steady_state.h)
    std::vector<OriginDestinationResult> origin_destination;  // in the measured window
    std::vector<NetworkInterval> series;
    Stability stability = Stability::stable;
    InstabilityCause unstable_by = InstabilityCause::none;
    std::optional<double> collapse_s;  // time from which an unstable run counts as unstable
    int full_cycles = 0;               // signal cycles from the time at which the network had filled to the end
    DelayLog delays;
    Violations violations;
    double longest_in_junction_s = 0.0;
    double vehicles_present = 0.0;  // mean over the measured window, in the whole network
    int max_present = 0;
    std::int64_t entered = 0;
    std::int64_t exited = 0;
    std::int64_t updates = 0;  // vehicles times steps
    std::uint64_t state_hash = 0;
    // Streets (street_results.h).
    std::vector<std::array<int, 4>> inflow;  // [interval][Side] vehicles
    Congestion congestion;
    std::vector<std::array<std::int64_t, kMaxTurns>> turn_counts;  // [approach][Turn] vehicles
    std::int64_t mandatory_lane_changes = 0;
    std::int64_t missed_turns = 0;  // imported networks: vehicles that reached the stop line in a wrong lane
    std::int64_t backlog = 0;       // vehicles that found no room to enter before the run ended
    std::int64_t discretionary_lane_changes = 0;
    StreetTrace street_trace;  // empty unless measure.time_space is set
    bool complete = false;     // false: the run was stopped early
};

// Returns the model of a network run. It records crossings of the area boundary and of stop lines, and delays.
Model network_model(const Scenario& scenario, std::size_t population);

// Runs one population. `on_step` is called before every step; the run stops early when it returns false. `threads` is
// the number of threads that share the run.
NetworkResult run_network(const Scenario& scenario, std::size_t population,
                          const std::function<bool(const Simulation&)>& on_step = {}, int threads = 1,
                          const Observation& observation = {});

}  // namespace stopline
