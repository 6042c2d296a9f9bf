// One run of a scenario: builds the model of a population, advances it to the end and keeps what reports need.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "experiment/observation.h"
#include "scenario/scenario.h"
#include "sim/events.h"
#include "sim/simulation.h"

namespace stopline {

// A vehicle at one time, in network coordinates along its route: 0 at the entry.
struct TrajectoryPoint {
    double time_s;
    int vehicle;
    int policy;         // index into the population's components
    int lane;           // index into the lane graph
    double distance_m;  // of the front from the start of its route
    double position_m;  // of the front from the start of its lane
    double speed_mps;
    double acceleration_mps2;
    double request_mps2;
    double net_gap_m;  // to the vehicle ahead on its route; NaN without one
    int gear;          // from 1
};

// Appends all vehicles present, lane by lane.
void sample_vehicles(const Simulation& simulation, std::vector<TrajectoryPoint>& points);

struct RunOptions {
    double trajectory_interval_s = 0.0;  // 0: keep none
    double trajectory_from_s = 0.0;
    double trajectory_until_s = std::numeric_limits<double>::infinity();
    // Called now and then with the share done (0..1); return false to stop early (the result is then incomplete).
    std::function<bool(double)> on_progress;
    Observation observation = {};
};

struct RunResult {
    std::string population;
    double green_start_s = 0.0;             // start of the (first) green
    std::vector<Passage> passages;          // all events of the run
    std::vector<double> stop_line_times_s;  // fronts at the stop lines, relative to green_start_s, sorted
    std::vector<TrajectoryPoint> trajectory;
    std::vector<double> queue_gaps_m;  // net gaps of the queue at the start of green
    Violations violations;
    std::int64_t vehicles_entered = 0;
    std::int64_t vehicles_left = 0;
    std::int64_t updates = 0;  // vehicle updates
    double wall_s = 0.0;       // time spent in the step loop
    std::uint64_t state_hash = 0;
    bool complete = false;

    // Vehicles whose front passed within `green_s` of the start of green.
    int passed_within(double green_s) const;
};

RunResult run_population(const Scenario& scenario, std::size_t population, const RunOptions& options = {});

}  // namespace stopline
