// One run of an intersection (Section IV): from a scenario to its figures.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiment/observation.h"
#include "measure/discharge.h"
#include "measure/zones.h"
#include "scenario/scenario.h"
#include "sim/simulation.h"

namespace stopline {

// A vehicle in the plane.
struct DrawnVehicle {
    Point rear;
    Point front;
    int policy = 0;
};

struct IntersectionFigures {
    std::string population;
    TimeWindow window;               // measured; whole cycles
    double throughput_veh_h = 0.0;   // fronts that leave the intersection's radius
    std::vector<ZoneFigures> zones;  // as in measure.zones
    std::vector<double> delay_s;     // [zone] beyond the time at the limit
    Discharge discharge;
    double vehicles_present = 0.0;  // mean over the window
    double occupied = 0.0;          // share of all road metres that they occupy
    double queue_veh = 0.0;         // mean over lanes and greens: vehicles that stand when their green begins
    double longest_queue_m = 0.0;
    double straight = 0.0, right = 0.0, left = 0.0;  // shares of those that left the intersection within the window
    std::int64_t gaps_accepted = 0;
    double longest_inside_s =
        0.0;  // that a vehicle spent between its stop line and wholly on the exit; two cycles and what the slowest way takes: a deadlock
    double picture_s = 0.0;  // in the middle of the first green of the last group within the window
    std::vector<DrawnVehicle> picture;
    std::vector<Light> picture_lights;  // [signal group]
    Violations violations;
    std::int64_t entered = 0;
    std::int64_t left_network = 0;
    std::int64_t updates = 0;
    std::uint64_t state_hash = 0;
    bool complete = false;
};

// The window that a scenario measures: whole cycles up to the end of the run.
TimeWindow measured_window(const Scenario& scenario);
TimeWindow first_cycle(const Scenario& scenario);  // of it

// `on_step` is called before every step, with the state at its beginning; return false to stop early.
IntersectionFigures run_intersection(const Scenario& scenario, std::size_t population,
                                     const std::function<bool(const Simulation&)>& on_step = {},
                                     const Observation& observation = {});

}  // namespace stopline
