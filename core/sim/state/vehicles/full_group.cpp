#include "sim/state/vehicles/full_group.h"

#include <cstddef>
#include <initializer_list>

#include "base/simd/simd.h"

namespace stopline {

namespace {

// Divides an array into streams of n elements. Resizes the array if necessary. New elements have the value 1.
template <class Number>
void divide(LargeArray<Number>& array, std::size_t n, std::initializer_list<Number**> streams) {
    array.resize(n * streams.size(), Number{1});
    std::size_t first = 0;
    for (Number** const stream : streams) {
        *stream = array.data() + first;
        first += n;
    }
}

}  // namespace

void FullGroupArrays::resize(int vehicles) {
    // The number of elements in a stream is a multiple of kUnit. kSimdWidth floats fill whole cache lines, so every
    // stream begins on a cache line.
    constexpr std::size_t kUnit = kSimdWidth;
    vehicles_ = (static_cast<std::size_t>(vehicles) + kUnit - 1) / kUnit * kUnit;
    streams();
}

// The kernels also compute elements without a vehicle. New elements are therefore set to 1, so that no divisor is 0.
FullGroup FullGroupArrays::streams() {
    FullGroup s{};
    divide(doubles_, vehicles_, {&s.coming_speed, &s.desired_gap, &s.slope, &s.law_gap, &s.law_slope});
    divide(floats_, vehicles_, {&s.speed,
                                &s.acceleration,
                                &s.lag,
                                &s.request,
                                &s.gap,
                                &s.closing,
                                &s.to_next_limit,
                                &s.limit,
                                &s.heard_acceleration,
                                &s.heard_request,
                                &s.heard_rate,
                                &s.end_speed,
                                &s.sine,
                                &s.standstill_gap,
                                &s.demand,
                                &s.is_platoon_leader,
                                &s.torque,
                                &s.brake,
                                &s.gear_time,
                                &s.gear,
                                &s.sent_rate,
                                &s.mean_request,
                                &s.sent_acceleration,
                                &s.sent_request,
                                &s.interaction});
    divide(ints_, vehicles_, {&s.policy, &s.type, &s.driver});
    return s;
}

}  // namespace stopline
