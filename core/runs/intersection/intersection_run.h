// Runs a scenario with a single intersection (Section IV of the paper), and measures the results.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "measure/discharge.h"
#include "measure/hcm.h"
#include "measure/zones.h"
#include "runs/driving/driving_results.h"
#include "runs/intersection/deadlock.h"
#include "runs/observation.h"
#include "runs/v2v_results.h"
#include "scenario/scenario.h"
#include "sim/step/simulation.h"

namespace stopline {

// A vehicle in a figure, with the x and y coordinates of its rear and its front.
struct DrawnVehicle {
    Point rear;
    Point front;
    int policy = 0;  // index into PopulationSettings::components
};

struct IntersectionResult {
    std::string population;
    TimeWindow window;              // result of measured_window()
    double throughput_veh_h = 0.0;  // vehicles that leave the intersection within the window
    std::vector<ZoneResult> zones;  // [zone] in the order of measure.zones
    std::vector<double> delay_s;    // [zone] travel time minus travel time at the speed limit
    Discharge discharge;
    std::vector<HcmRow> hcm;        // empty unless measure.hcm is on
    double vehicles_present = 0.0;  // mean number of vehicles in the network over the window
    double occupied = 0.0;          // share of the lane length that vehicles occupy, 0 .. 1
    double queue_veh = 0.0;         // queued vehicles at the start of green, mean over lanes and greens
    double longest_queue_m = 0.0;   // longest queue at the start of green
    // Shares of the three movements among the vehicles that leave the intersection within the window, 0 .. 1.
    double straight_share = 0.0, right_share = 0.0, left_share = 0.0;
    std::int64_t gaps_accepted = 0;
    // Longest time of a vehicle from its front at the stop line to its rear on the exit lane.
    double longest_in_junction_s = 0.0;
    std::vector<Starvation> starvations;  // movements that starve
    // Time of the snapshot: the middle of the green time of signal stage 2, in the first measured cycle.
    double snapshot_s = 0.0;
    std::vector<DrawnVehicle> snapshot;
    std::vector<Light> snapshot_lights;  // [signal group] at the time of the snapshot
    Violations violations;
    std::optional<Deadlock> deadlock;  // the first one
    V2vResult v2v;
    DrivingResults driving;
    VehicleNames vehicle_names;
    DepartureDelays departure;  // departure delays of all vehicles that arrived
    std::int64_t backlog = 0;   // vehicles that found no room to enter until the end of the run
    std::int64_t entered = 0;
    std::int64_t exited = 0;
    std::int64_t updates = 0;  // number of vehicles in the network, summed over all steps
    std::uint64_t state_hash = 0;
    bool complete = false;  // false: the run was stopped before its end
};

// Returns the measured window. It begins after the warm-up cycles. If Scenario::duration_s is 0, the window is
// measure.cycles signal cycles long. Otherwise it ends at the end of the run.
TimeWindow measured_window(const Scenario& scenario);
// Returns the first cycle of the measured window.
TimeWindow first_cycle(const Scenario& scenario);

// Runs scenario.populations[population]. `on_step` is called before every step; if it returns false, the run is stopped
// before its end.
IntersectionResult run_intersection(const Scenario& scenario, std::size_t population,
                                    const std::function<bool(const Simulation&)>& on_step = {},
                                    const Observation& observation = {});

}  // namespace stopline
