// Runs a scenario with one of its populations, and keeps the events and the trajectories of the run.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "measure/hcm.h"
#include "runs/driving/driving_results.h"
#include "runs/observation.h"
#include "runs/v2v_results.h"
#include "scenario/scenario.h"
#include "sim/state/events.h"
#include "sim/state/insertion_state.h"
#include "sim/step/simulation.h"

namespace stopline {

// The state of a vehicle at one time.
struct TrajectoryPoint {
    double time_s = 0.0;
    int vehicle = 0;
    int policy = 0;           // index into PopulationSettings::components
    int lane = 0;             // index into the lane graph
    double distance_m = 0.0;  // position of the front, from the start of the route
    double position_m = 0.0;  // position of the front, from the start of the lane
    double speed_mps = 0.0;
    double acceleration_mps2 = 0.0;
    double request_mps2 = 0.0;  // acceleration that the controller requests; mesoscale mode: same as acceleration_mps2
    double net_gap_m = 0.0;     // net gap to the leader; NaN without a leader
    int gear = 0;               // engaged gear, from 1; 0 in the mesoscale mode
    double leader_length_m = 0.0;  // 0 without a leader
};

// Appends one point for each vehicle in the network, lane by lane.
void sample_vehicles(const Simulation& simulation, std::vector<TrajectoryPoint>& points);

// A follower in a queue.
struct QueueGap {
    double net_gap_m = 0.0;         // to its leader
    double standstill_gap_m = 0.0;  // that its policy keeps at rest
};

struct RunOptions {
    double trajectory_interval_s = 0.0;  // sampling interval; 0: no trajectories
    double trajectory_from_s = 0.0;
    double trajectory_until_s = std::numeric_limits<double>::infinity();
    // Called every 1000 steps with the completed share of the run, 0 .. 1. If it returns false, the run is stopped
    // before its end, and the result is incomplete.
    std::function<bool(double)> on_progress;
    Observation observation = {};
};

struct RunResult {
    std::string population;
    double green_start_s = 0.0;             // start of the first green
    std::vector<Passage> passages;          // passages of vehicles from lane to lane
    std::vector<double> stop_line_times_s;  // times of passages over stop lines, counted from green_start_s, sorted
    std::vector<TrajectoryPoint> trajectory;
    std::vector<HcmRow> hcm;           // empty unless measure.hcm is on
    std::vector<QueueGap> queue_gaps;  // followers in the queue of the first lane at the start of green
    Violations violations;
    V2vResult v2v;
    DrivingResults driving;
    VehicleNames vehicle_names;
    DepartureDelays departure;  // departure delays of all vehicles that arrived
    std::int64_t backlog = 0;   // vehicles that found no room to enter until the end of the run
    std::int64_t vehicles_entered = 0;
    std::int64_t vehicles_exited = 0;
    std::int64_t updates = 0;  // number of vehicles in the network, summed over all steps
    double wall_s = 0.0;       // wall-clock time of the step loop
    std::uint64_t state_hash = 0;
    bool complete = false;  // false: the run was stopped before its end

    // Returns the number of vehicles that passed a stop line in the first `green_s` seconds after green_start_s.
    int passed_within(double green_s) const;
};

// Builds the model for scenario.populations[population] and runs it.
RunResult run_population(const Scenario& scenario, std::size_t population, const RunOptions& options = {});

}  // namespace stopline
