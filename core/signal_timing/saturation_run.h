// Measures the saturation flow and the lost times of an intersection by runs with saturated demand: same lanes, turn
// shares, vehicles, driver and fidelity as the scenario, but a long green and an endless queue on each approach.
//
// A lane without left turns: the flow is that of the mean headway from the fifth vehicle of a queue on, and the start-up
// lost time is that of the first four vehicles (measure/discharge.h). The end gain e is the part of yellow and all red
// that vehicles use: passed vehicles x saturation headway + start-up lost time - green.
//
// A lane with left turns: vehicles that yield to oncoming traffic hold those behind them, so the headways of unhindered
// queues would overestimate its flow. A second run therefore saturates only one leg of each street, and lets vehicles
// arrive on the other leg at the rate of the demand. The flow of the lane is the number of vehicles that pass in a
// green, divided by the effective green of its stage.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "signal_timing/lane_demand.h"

namespace stopline {

inline constexpr double kSaturationGreen_s = 40.0;  // green of both stages in the run
inline constexpr int kSaturationCycles = 10;        // measured cycles, after one cycle of warm-up
inline constexpr int kLeftTurnCycles = 20;          // measured cycles of the second run, after three cycles of warm-up

// The mean of the lanes of a stage that have the same place in their approach.
struct LaneSaturation {
    int stage = 0;
    int index = 0;            // place in the approach, from the left
    bool turns_left = false;  // true: some vehicles turn left and yield
    double flow_veh_h = 0.0;
    double startup_lost_time_s = 0.0;  // NaN: no queue of five vehicles passes in a green
    double vehicles_per_green = 0.0;
};

struct StageLostTime {
    double startup_s = 0.0;
    double end_gain_s = 0.0;  // part of yellow and all red that vehicles use

    // Returns the lost time of the stage in each cycle.
    double total_s(double yellow_s, double all_red_s) const { return startup_s + yellow_s + all_red_s - end_gain_s; }
    // Returns the effective green of a displayed green, and the reverse.
    double effective_green_s(double green_s) const { return green_s - startup_s + end_gain_s; }
    double displayed_green_s(double effective_green_s) const { return effective_green_s + startup_s - end_gain_s; }
};

struct Saturation {
    std::string population;
    std::vector<LaneSaturation> lanes;  // by stage, then from the left
    std::array<StageLostTime, kTimingStages> lost;
    bool has_violations = false;

    std::size_t place(int stage, int index) const;  // index of a lane in `lanes`
};

// Returns the scenario of the first run: the intersection of the scenario alone, with saturated demand.
Scenario saturated_scenario(const Scenario& scenario);

// Measures one population. `demands` are those of the scenario, which the second run needs. `keep_going` gets the
// completed share, and returns false to stop the run, which throws Interrupted. Throws InputError if no vehicle passes
// on one of the lanes.
Saturation measure_saturation(const Scenario& scenario, std::size_t population, const std::vector<LaneDemand>& demands,
                              const std::function<bool(double)>& keep_going = {});

}  // namespace stopline
