#include "demand/arrivals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "base/random.h"

namespace stopline {

namespace {

using Kind = ArrivalProcess::Kind;

// The different random numbers of a vehicle. The number of the inlet's first arrival belongs to no vehicle.
enum class Draw : std::uint64_t { headway, platoon_end, order, first };

double draw(const ArrivalKey& key, std::int64_t vehicle, Draw kind) {
    const std::uint64_t number = (static_cast<std::uint64_t>(key.inlet) << 40) + static_cast<std::uint64_t>(vehicle);
    return random_uniform(key.seed, number, static_cast<std::uint64_t>(kind), Purpose::arrival);
}

// Returns an exponential number with mean 1.
double exponential(const ArrivalKey& key, std::int64_t vehicle) {
    return -std::log1p(-draw(key, vehicle, Draw::headway));
}

bool ends_platoon(const ArrivalProcess& process, const ArrivalKey& key, std::int64_t vehicle) {
    return draw(key, vehicle, Draw::platoon_end) * process.platoon_size < 1.0;
}

std::vector<double> even_times(const ArrivalRate& rate, const ArrivalKey& key) {
    std::vector<double> times_s;
    const double offset = draw(key, 0, Draw::first);
    double time_s = rate.time_of_s(offset);
    while (time_s < rate.end_s()) {
        times_s.push_back(time_s);
        time_s = rate.time_of_s(static_cast<double>(times_s.size()) + offset);
    }
    return times_s;
}

std::vector<double> poisson_times(const ArrivalRate& rate, const ArrivalKey& key) {
    std::vector<double> times_s;
    double expected = exponential(key, 0);
    double time_s = rate.time_of_s(expected);
    while (time_s < rate.end_s()) {
        times_s.push_back(time_s);
        expected += exponential(key, static_cast<std::int64_t>(times_s.size()));
        time_s = rate.time_of_s(expected);
    }
    return times_s;
}

// Returns the rate at which platoons begin while no headway within a platoon is running. With this rate, the mean rate
// of all vehicles is `rate`. The function replaces a piece on which the rate changes by short steps.
ArrivalRate gap_rate(const ArrivalProcess& process, const ArrivalRate& rate) {
    constexpr double kStep_s = 1.0;
    ArrivalRate gaps;
    while (gaps.end_s() < rate.end_s()) {
        const double from_s = gaps.end_s();
        const double to_s = std::min(from_s + kStep_s, rate.end_s());
        const double mean_1ps = (rate.expected(to_s) - rate.expected(from_s)) / (to_s - from_s);
        const double gap_1ps = mean_1ps / (process.platoon_size * (1.0 - mean_1ps * process.platoon_headway_s));
        gaps.append(to_s, gap_1ps, gap_1ps);
    }
    return gaps;
}

// The process begins in its steady state. At 0 s, a headway within a platoon is running with the probability
// rate x platoon_headway_s.
std::vector<double> platooned_times(const ArrivalProcess& process, const ArrivalRate& rate, const ArrivalKey& key) {
    const ArrivalRate gaps = gap_rate(process, rate);
    std::vector<double> times_s;
    const auto after_gap_s = [&](double from_s) {
        const auto vehicle = static_cast<std::int64_t>(times_s.size());
        return gaps.time_of_s(gaps.expected(from_s) + exponential(key, vehicle));
    };
    const double headway_s = process.platoon_headway_s;
    const double blocked = rate.rate_1ps(0.0) * headway_s;
    const double first = draw(key, 0, Draw::first);
    const bool starts_within_platoon = first < blocked;
    double time_s = starts_within_platoon ? first / blocked * headway_s : after_gap_s(0.0);
    // Vehicle -1 is the one before the start.
    if (starts_within_platoon && ends_platoon(process, key, -1)) time_s = after_gap_s(time_s);
    while (time_s < rate.end_s()) {
        const auto vehicle = static_cast<std::int64_t>(times_s.size());
        times_s.push_back(time_s);
        time_s += headway_s;
        if (time_s < rate.end_s() && ends_platoon(process, key, vehicle)) time_s = after_gap_s(time_s);
    }
    return times_s;
}

// Returns `count` uniform numbers in [0, 1), ascending.
std::vector<double> sorted_uniform(std::size_t count, std::int64_t first, const ArrivalKey& key) {
    std::vector<double> numbers(count);
    for (std::size_t k = 0; k < count; ++k) {
        numbers[k] = draw(key, first + static_cast<std::int64_t>(k), Draw::headway);
    }
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

}  // namespace

std::vector<double> arrival_times(const ArrivalProcess& process, const ArrivalRate& rate, const ArrivalKey& key) {
    switch (process.kind) {
        case Kind::even:
            return even_times(rate, key);
        case Kind::poisson:
            return poisson_times(rate, key);
        case Kind::platooned:
            break;
    }
    return platooned_times(process, rate, key);
}

std::vector<double> counted_arrival_times(const ArrivalProcess& process, const CountedArrivals& counted,
                                          const ArrivalKey& key) {
    const auto count = static_cast<std::size_t>(counted.vehicles);
    const double length_s = counted.to_s - counted.from_s;
    std::vector<double> times_s(count);
    if (process.kind == Kind::even) {
        const double offset = draw(key, 0, Draw::first);
        for (std::size_t k = 0; k < count; ++k) {
            times_s[k] = counted.from_s + (static_cast<double>(k) + offset) * length_s / static_cast<double>(count);
        }
        return times_s;
    }
    const double headway_s = process.kind == Kind::platooned ? process.platoon_headway_s : 0.0;
    std::vector<std::size_t> leaders;  // first vehicle of each platoon; without platoons: all vehicles
    for (std::size_t k = 0; k < count; ++k) {
        const std::int64_t previous = counted.first + static_cast<std::int64_t>(k) - 1;
        if (k == 0 || process.kind == Kind::poisson || ends_platoon(process, key, previous)) leaders.push_back(k);
    }
    // All headways within platoons together take headways_s. The platoons are spread at random over the rest.
    const double headways_s = headway_s * static_cast<double>(count);
    const std::vector<double> places = sorted_uniform(leaders.size(), counted.first, key);
    std::size_t platoon = 0;
    for (std::size_t k = 0; k < count; ++k) {
        if (platoon + 1 < leaders.size() && leaders[platoon + 1] <= k) ++platoon;
        times_s[k] = counted.from_s + places[platoon] * (length_s - headways_s) + static_cast<double>(k) * headway_s;
    }
    return times_s;
}

std::vector<std::int64_t> random_order(std::int64_t count, std::int64_t first, const ArrivalKey& key) {
    std::vector<std::int64_t> order(static_cast<std::size_t>(count));
    std::iota(order.begin(), order.end(), std::int64_t{0});
    const auto number = [&](std::int64_t k) { return draw(key, first + k, Draw::order); };
    std::stable_sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) { return number(a) < number(b); });
    return order;
}

}  // namespace stopline
