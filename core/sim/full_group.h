// A group of vehicles from several lanes, brought together so that the kernels of full dynamics work on full batches whatever
// the lanes hold. One value a vehicle, in the order of the lanes; what follows the last one is computed along and never read.
#pragma once

#include <cstddef>

#include "base/huge_page_allocator.h"
#include "base/simd.h"

namespace stopline {

// Plain pointers to the arrays of a group, so that the compiler sees independent streams.
struct FullGroup {
    // What a vehicle knows and where it is.
    double* coming_mps;  // its speed at the end of the step, where what is planned now is in force
    float *speed, *acceleration, *lag, *request;  // request: of the last step, then of this one
    float *gap, *closing;                         // of the predecessor, as the radar tells with its delay
    float *heard_acceleration, *heard_request, *heard_rate;
    float *to_turn, *limit, *end_speed, *standstill_gap, *sine;
    float* imposed;  // the least that its line, or what it gives way to, asks of it; 1e3: nothing
    float *leads, *torque, *brake, *gear_time, *gear;
    float* mean_request;  // over the step, for the powertrain
    float *told_acceleration, *told_rate;
    int *policy, *type;
    // What its policy asks for.
    double *desired_gap, *slope;
    double *law_gap, *law_slope;  // of one law, while policies are mixed
};

// The memory of a group.
class FullGroupArrays {
public:
    void resize(int vehicles);
    // For more than was foreseen: where vehicles overlap, a lane can hold more than fit one behind the other.
    void make_room(int vehicles) {
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
