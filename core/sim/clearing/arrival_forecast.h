// Cooperative clearing: forecasts of the times at which the vehicles of a lane reach the stop line. The forecasts are
// late rather than early, because other vehicles rely on them.
#pragma once

#include <cstdint>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Forecasts the arrivals of consecutive vehicles of one lane, from downstream to upstream.
class ArrivalForecast {
public:
    ArrivalForecast(const Model& model, const State& state, int lane)
        : model_(model), state_(state), lane_(lane), discharge_mps_(model.leader_speed_share * limit_mps()) {}

    // Returns the time until the front of the vehicle in `slot` reaches the stop line if its signal stays green; 0 if
    // the front is past the line. Call the function for each vehicle in turn.
    double next_s(int slot);

private:
    double limit_mps() const { return state_.plan.free_speed_mps(lane_); }

    const Model& model_;
    const State& state_;
    int lane_;
    double discharge_mps_;      // speed of the vehicles at the stop line
    double previous_s_ = -1.0;  // arrival of the leader; below 0: none
    double previous_length_m_ = 0.0;
};

// Returns for how long the signal group stays green, s. Returns 0 if it is not green, or if its controller reacts to
// traffic, because the end of green is then unknown.
double remaining_green_s(const Model& model, const State& state, int group);

// Returns how long the next green of the programme of a signal group lasts, s; 0: none.
double next_green_duration_s(const Model& model, const State& state, int group);

// Returns the time in which a vehicle covers a distance if it accelerates constantly up to the speed limit.
double travel_time_s(double distance_m, double speed_mps, double acceleration_mps2, double limit_mps);

}  // namespace stopline
