// One run of several intersections that influence each other (Section VI): from a scenario to its figures.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiment/backlog.h"
#include "experiment/observation.h"
#include "experiment/time_space.h"
#include "measure/area.h"
#include "scenario/scenario.h"
#include "sim/simulation.h"

namespace stopline {

// Section VI.D. Stable: no gridlock, nobody was moved on. Semi-stable: gridlocks that dissolve, vehicles moved on are below 1 % of those
// that left. Unstable: see Breakdown.
enum class Stability : std::uint8_t { stable, semi_stable, unstable };
inline constexpr std::array<const char*, 3> kStabilityNames{"stable", "semi-stable", "unstable"};
// By what a run is unstable, the first that holds: throughput falls to a lower level for good where there are gridlocks; so many vehicles
// are moved on; a gridlock of six cycles or more is there at the end.
enum class Breakdown : std::uint8_t { none, fall, moved_on, gridlock };
inline constexpr std::array<const char*, 4> kBreakdownNames{"", "fall", "moved_on", "gridlock"};
inline constexpr double kSemiStableShare = 0.01;  // of throughput (Section VI.D)
inline constexpr double kCollapseShare =
    0.1;  // throughput that is lost at least (our choice: the paper says "significant")

// One step of the time series.
struct NetworkInterval {
    AreaFigures area;
    std::array<double, kCauseNames.size()> lost_s{};  // vehicle seconds, by cause
    std::int64_t taken_out = 0;
};

struct NetworkFigures {
    std::string population;
    AreaFigures steady;            // over the last measure.steady of the run, or all of a shorter one but the warm-up
    double warm_up_s = 0.0;        // found from the number of vehicles in the area (measure/steady_state.h)
    std::vector<WayFigures> ways;  // over the same window
    std::vector<NetworkInterval> series;
    Stability stability = Stability::stable;
    Breakdown breakdown = Breakdown::none;
    // Of an unstable run: from when on throughput is lower, 1 % or more of those that have left were moved on, or the gridlock stands.
    std::optional<double> collapse_s;
    int full_cycles = 0;  // cycles of the lights from when the network had filled to the end
    HindranceLog hindrance;
    Violations violations;
    double longest_inside_s = 0.0;
    double vehicles_present = 0.0;  // mean over the steady window, queues outside included
    int most_present = 0;
    std::int64_t entered = 0;
    std::int64_t left_network = 0;
    std::int64_t updates = 0;
    std::uint64_t state_hash = 0;
    // Streets (street_results.h).
    std::vector<std::array<int, 4>> inflow;  // [interval][Side] vehicles
    Backlog backlog;
    std::vector<std::array<std::int64_t, kMostTurns>> turned;  // [approach][Turn]
    std::int64_t changes_for_route = 0;
    std::int64_t strayed = 0;  // imported networks: see State::strayed
    std::int64_t waiting = 0;  // they have come, but found no room to enter until the end (waiting_outside)
    std::int64_t changes_for_speed = 0;
    StreetTrace street;  // empty unless measure.time_space asks for it
    bool complete = false;
};

// The model of a network run: fronts that come into the measured area and leave it, and hindrance, are all that it records.
Model network_model(const Scenario& scenario, std::size_t population);

// `on_step` is called before every step; return false to stop early. `threads`: that share the run.
NetworkFigures run_network(const Scenario& scenario, std::size_t population,
                           const std::function<bool(const Simulation&)>& on_step = {}, int threads = 1,
                           const Observation& observation = {});

}  // namespace stopline
