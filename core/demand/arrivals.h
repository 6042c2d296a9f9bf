// Arrival times of vehicles at an inlet. The times depend only on the seed and the inlet, so populations with different
// spacing policies see the same arrivals.
#pragma once

#include <cstdint>
#include <vector>

#include "demand/arrival_rate.h"

namespace stopline {

// A process of arrivals.
//   even       vehicle k arrives when the integral of the rate reaches k plus an offset; at a constant rate, headways
//              are equal
//   poisson    Poisson process: the headways are exponential, independent of each other
//   platooned  Cowan's model M3 (Cowan, 1975, "Useful headway models"): platoons of random size. The headway within a
//              platoon is constant. Between platoons, an exponential time is added to this headway. Platoon sizes are
//              geometric, so each vehicle is the last one of its platoon with the probability 1 / platoon_size.
struct ArrivalProcess {
    enum class Kind : std::uint8_t { even, poisson, platooned };
    Kind kind = Kind::even;
    double platoon_size = 1.0;       // platooned: mean number of vehicles in a platoon
    double platoon_headway_s = 0.0;  // platooned: headway within a platoon
};

// The key of the random numbers of an inlet.
struct ArrivalKey {
    std::uint64_t seed = 1;
    int inlet = 0;
};

// Returns the arrival times from 0 s until the end of the rate, ascending.
//
// poisson: a unit-rate Poisson process is mapped through the inverse of the integral of the rate (time rescaling). The
// result is an inhomogeneous Poisson process with exactly this rate.
// platooned: the rate must be below 1 / platoon_headway_s at all times.
std::vector<double> arrival_times(const ArrivalProcess& process, const ArrivalRate& rate, const ArrivalKey& key);

// The arrivals of a given number of vehicles in an interval.
struct CountedArrivals {
    double from_s = 0.0;
    double to_s = 0.0;
    std::int64_t vehicles = 0;
    std::int64_t first = 0;  // number of the first vehicle at this inlet; the key of its random numbers
};

// Returns exactly `vehicles` arrival times within [from_s, to_s), ascending. They are distributed as in the process,
// conditional on this number. poisson: the times are independent and uniform. platooned: vehicles times
// platoon_headway_s must be below the length of the interval.
std::vector<double> counted_arrival_times(const ArrivalProcess& process, const CountedArrivals& counted,
                                          const ArrivalKey& key);

// Returns the numbers 0 .. count - 1 in random order. `first`: see CountedArrivals.
std::vector<std::int64_t> random_order(std::int64_t count, std::int64_t first, const ArrivalKey& key);

}  // namespace stopline
