// Memory of a group of vehicles from several lanes, gathered so that the full-dynamics kernels work on whole batches.
// One value a vehicle, in the order of the lanes. Values after the last vehicle are computed and never read.
#pragma once

#include <cstddef>

#include "base/simd/huge_page_allocator.h"
#include "base/simd/simd.h"

namespace stopline {

// Plain pointers to the arrays of a group, which the compiler can treat as independent streams. SI units.
struct FullGroup {
    // Knowledge and place of a vehicle.
    double* coming_speed;                         // speed at the end of the step, when the plan comes into force
    float *speed, *acceleration, *lag, *request;  // request: of the last step, then of this one
    float *gap, *closing;                         // delayed radar measurement of the leader
    float *heard_acceleration, *heard_request, *heard_rate;
    float *to_next_limit, *limit, *end_speed, *standstill_gap, *sine;
    float* demand;  // lowest external demand; kUnconstrained_mps2: none
    float *is_platoon_leader, *torque, *brake, *gear_time, *gear;
    float* mean_request;  // mean over the step, for the powertrain
    float *sent_acceleration, *sent_rate;
    int *policy, *type;
    // Demands of the gap policy.
    double *desired_gap, *slope;
    double *law_gap, *law_slope;  // results of one law where policies are mixed
};

class FullGroupArrays {
public:
    void resize(int vehicles);
    // Grows the memory if the group is larger than planned. Overlapping vehicles can make a lane hold more than fit.
    void reserve(int vehicles) {
        if (static_cast<std::size_t>(vehicles) + kSpare > vehicles_) resize(2 * vehicles + static_cast<int>(kSpare));
    }
    FullGroup streams();

private:
    LargeArray<double> doubles_;
    LargeArray<float> floats_;
    LargeArray<int> ints_;
    static constexpr std::size_t kSpare = 2 * kSimdWidth;  // batches reach beyond the last vehicle
    std::size_t vehicles_ = 0;
};

}  // namespace stopline
