// The working memory of the full-dynamics kernels for one lane group (lanes whose vehicles are computed together). The
// vehicles of the lanes lie next to each other, so that the kernels compute whole batches. The kernels also compute
// elements after the last vehicle, but nothing reads these elements.
#pragma once

#include <cstddef>

#include "base/simd/huge_page_allocator.h"
#include "base/simd/simd.h"

namespace stopline {

// Pointers to the arrays of a group. Each array has one value for each vehicle, in the order of the lanes. SI units.
struct FullGroup {
    // State of the vehicle, its measurements, and the road at its position.
    double* coming_speed;  // speed at the end of the step with the present acceleration
    float *speed, *acceleration, *lag,
        *request;          // requested acceleration of the previous step; the driver kernel overwrites it
    float *gap, *closing;  // net gap and closing speed, from the delayed radar measurement
    float *heard_acceleration, *heard_request, *heard_rate;  // delayed V2V message of the leader
    float *to_next_limit, *limit, *end_speed, *standstill_gap, *sine;
    // Acceleration that the vehicle must not exceed, for example before a stop line: the lowest of its external demands
    // (ExternalDemand in lane_group.h). kUnconstrained_mps2: none.
    float* demand;
    float *is_platoon_leader, *torque, *brake, *gear_time, *gear;
    float* mean_request;                                  // mean request within the step, for the powertrain
    float *sent_acceleration, *sent_request, *sent_rate;  // V2V message to the follower
    int *policy, *type, *driver;
    float* interaction;  // human drivers: sum of the terms (s* / s)^2 (driver/human.h)
    // Desired gap of the spacing policy, and its slope over speed.
    double *desired_gap, *slope;
    // Scratch memory for groups with several policies. The spacing law of the first vehicle's policy writes directly to
    // desired_gap and slope. The law of each other policy writes its results for all vehicles here. Then the values of
    // the vehicles with this policy are copied to desired_gap and slope.
    double *law_gap, *law_slope;
};

class FullGroupArrays {
public:
    void resize(int vehicles);
    // Grows the memory if a group has more vehicles than expected. This can happen if vehicles overlap, because a lane
    // then holds more vehicles than fit on it bumper to bumper.
    void reserve(int vehicles) {
        if (static_cast<std::size_t>(vehicles) + kSpare > vehicles_) resize(2 * vehicles + static_cast<int>(kSpare));
    }
    FullGroup streams();

private:
    LargeArray<double> doubles_;
    LargeArray<float> floats_;
    LargeArray<int> ints_;
    // Reserve of elements, because the last batch can reach beyond the last vehicle.
    static constexpr std::size_t kSpare = 2 * kSimdWidth;
    std::size_t vehicles_ = 0;
};

}  // namespace stopline
