#include "demand/demand_plan.h"

#include <cstddef>

#include "base/random.h"

namespace stopline {

namespace {

// Index of the component that a number in [0, 1) falls into.
std::size_t pick(const std::vector<double>& shares, double number) {
    std::size_t k = 0;
    double upper = shares[0];
    while (number >= upper && k + 1 < shares.size()) upper += shares[++k];
    return k;
}

// The component that is furthest behind its share after k vehicles: shares hold in every stretch of the sequence, and equal
// shares alternate, the first component first.
std::size_t most_behind(const std::vector<double>& shares, std::int64_t k) {
    std::vector<double> given(shares.size(), 0.0);
    std::size_t chosen = 0;
    for (std::int64_t n = 0; n <= k; ++n) {
        chosen = 0;
        for (std::size_t c = 1; c < shares.size(); ++c) {
            const double behind = shares[c] * static_cast<double>(n + 1) - given[c];
            const double best = shares[chosen] * static_cast<double>(n + 1) - given[chosen];
            if (behind > best + 1e-9) chosen = c;
        }
        given[chosen] += 1.0;
    }
    return chosen;
}

std::uint64_t vehicle_key(int inlet, std::int64_t k) {
    return (static_cast<std::uint64_t>(inlet) << 40) + static_cast<std::uint64_t>(k);
}

}  // namespace

int DemandPlan::policy_of(int inlet, std::int64_t k) const {
    if (policies.size() == 1) return policies[0];
    const std::size_t c = pattern == Pattern::alternating
                              ? most_behind(policy_shares, k)
                              : pick(policy_shares, random_uniform(seed, vehicle_key(inlet, k), 0, Purpose::policy));
    return policies[c];
}

int DemandPlan::route_of(int inlet, std::int64_t k) const {
    const Inlet& in = inlets[static_cast<std::size_t>(inlet)];
    if (in.routes.size() == 1) return in.routes[0];
    return in.routes[pick(in.shares, random_uniform(seed, vehicle_key(inlet, k), 0, Purpose::turn))];
}

}  // namespace stopline
