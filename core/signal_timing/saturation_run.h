// Measures the saturation flow and the lost times of an intersection by runs with saturated demand: same lanes, turn
// shares, vehicles, driver and fidelity as the scenario, and an endless queue on each approach.
//
// A lane without left turns: the flow is that of the mean headway h from the fifth vehicle of a queue on, and the
// start-up lost time is that of the first four vehicles (measure/discharge.h). The end gain e follows from the number n
// of vehicles that pass in a green g, its yellow and all red: e = n h + start-up lost time - g. So n h is the effective
// green of the run, and the capacity is exact for the greens of the run. With short greens, vehicles still accelerate
// and can stop at yellow. Flow and end gain are then lower, so the measurement must be repeated with the greens of the
// result.
//
// A lane with left turns: vehicles that yield to oncoming traffic hold those behind them, so the headways of unhindered
// queues would overestimate its flow. A second run therefore saturates only one leg of each street, and lets vehicles
// arrive on the other leg at the rate of the demand. The flow of the lane is the number of vehicles that pass in a
// green, divided by the effective green of its stage. This number changes from cycle to cycle, because the first
// left-turning vehicle of a queue blocks the vehicles behind it. Its variance increases the delay.
//
// The flow of such a lane remains somewhat too high. The saturated leg blocks the left turns of the oncoming leg, and
// the vehicles behind them are missing in the oncoming traffic.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "signal_timing/lane_demand.h"

namespace stopline {

inline constexpr double kSaturationGreen_s = 40.0;  // green of both stages in the first measurement
inline constexpr int kSaturationCycles = 10;        // measured cycles, after one cycle of warm-up
inline constexpr int kLeftTurnCycles = 40;          // measured cycles of the second run, after three cycles of warm-up

// The mean of the lanes of a stage that have the same place in their approach.
struct LaneSaturation {
    int stage = 0;
    int index = 0;            // place in the approach, from the left
    bool turns_left = false;  // true: some vehicles turn left and yield
    double flow_veh_h = 0.0;
    double startup_lost_time_s = 0.0;  // NaN: no queue of five vehicles passes in a green
    double vehicles_per_green = 0.0;
    // Variance of the number of vehicles that pass in a green, over its mean. 0 without left turns, where it is
    // negligible.
    double capacity_variance_ratio = 0.0;
};

struct StageLostTime {
    double startup_s = 0.0;
    double end_gain_s = 0.0;  // part of yellow and all red that vehicles use; below 0: part of the green is not used

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

using StageGreens = std::array<double, kTimingStages>;  // displayed greens, s

// Returns the scenario of the first run: the intersection of the scenario alone, with saturated demand and these
// greens. The approaches are so long that all vehicles that pass in a green have stood in the queue.
Scenario saturated_scenario(const Scenario& scenario, const StageGreens& greens_s);

struct SaturationInput {
    std::vector<LaneDemand> demands;  // those of the scenario, for the oncoming traffic of left turns
    StageGreens greens_s{kSaturationGreen_s, kSaturationGreen_s};
    // An earlier measurement. Its headways and start-up lost times hold for lanes on which no queue of five vehicles
    // passes in these greens. Null: none.
    const Saturation* earlier = nullptr;
};

// Measures one population. `keep_going` gets the completed share, and returns false to stop the run, which throws
// Interrupted. Throws InputError if no vehicle passes on one of the lanes.
Saturation measure_saturation(const Scenario& scenario, std::size_t population, const SaturationInput& input,
                              const std::function<bool(double)>& keep_going = {});

}  // namespace stopline
