#include "demand/demand_plan.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <unordered_map>

#include "base/random.h"

namespace stopline {

namespace {

// Index of the component that a number in [0, 1) falls into.
std::size_t pick(std::span<const double> shares, double number) {
    std::size_t k = 0;
    double upper = shares[0];
    while (number >= upper && k + 1 < shares.size()) upper += shares[++k];
    return k;
}

// The component that is furthest behind its share after k vehicles: shares hold in every stretch of the sequence, and equal
// shares alternate, the first component first.
std::size_t next_behind(std::span<const double> shares, std::int64_t n, std::vector<double>& given) {
    std::size_t chosen = 0;
    for (std::size_t c = 1; c < shares.size(); ++c) {
        const double behind = shares[c] * static_cast<double>(n + 1) - given[c];
        const double best = shares[chosen] * static_cast<double>(n + 1) - given[chosen];
        if (behind > best + 1e-9) chosen = c;
    }
    given[chosen] += 1.0;
    return chosen;
}

std::size_t most_behind(std::span<const double> shares, std::int64_t k) {
    std::vector<double> given(shares.size(), 0.0);
    std::size_t chosen = 0;
    for (std::int64_t n = 0; n <= k; ++n) chosen = next_behind(shares, n, given);
    return chosen;
}

std::uint64_t vehicle_key(int inlet, std::int64_t k) {
    return (static_cast<std::uint64_t>(inlet) << 40) + static_cast<std::uint64_t>(k);
}

// A number in [0, 1) for the k-th vehicle of an inlet. Of every 20 vehicles in a row one falls into each twentieth, in random
// order: shares hold in short runs too, with the randomness that shares of a twentieth leave.
double balanced_number(std::uint64_t seed, int inlet, std::int64_t k, Purpose purpose) {
    constexpr std::int64_t kBlock = 20;
    const std::int64_t first = k / kBlock * kBlock;
    const std::uint64_t own = random_bits(seed, vehicle_key(inlet, k), 1, purpose);
    int rank = 0;
    for (std::int64_t other = first; other < first + kBlock; ++other) {
        const std::uint64_t bits = random_bits(seed, vehicle_key(inlet, other), 1, purpose);
        rank += bits < own || (bits == own && other < k) ? 1 : 0;
    }
    const double within = random_uniform(seed, vehicle_key(inlet, first), 2, purpose);
    return (rank + within) / static_cast<double>(kBlock);
}

// Index of the component that the k-th vehicle of an inlet gets.
std::size_t draw(DemandPlan::Pattern pattern, std::span<const double> shares, std::uint64_t seed, int inlet,
                 std::int64_t k, Purpose purpose) {
    using Pattern = DemandPlan::Pattern;
    if (pattern == Pattern::alternating) return most_behind(shares, k);
    if (pattern == Pattern::balanced) return pick(shares, balanced_number(seed, inlet, k, purpose));
    return pick(shares, random_uniform(seed, vehicle_key(inlet, k), 0, purpose));
}

}  // namespace

void DemandPlan::draw_trip_policies() {
    trip_policies.clear();
    std::unordered_map<int, std::int64_t> entered;  // by approach
    std::unordered_map<int, std::vector<double>> given;
    for (const Trip& trip : trips) {
        const std::int64_t k = entered[trip.approach]++;
        if (pattern != Pattern::alternating || policies.size() == 1) {
            trip_policies.push_back(policy_of(trip.approach, k));
            continue;
        }
        std::vector<double>& so_far = given.try_emplace(trip.approach, policies.size(), 0.0).first->second;
        const std::size_t chosen = next_behind(policy_shares, k, so_far);
        trip_policies.push_back(policies[chosen]);
    }
}

int DemandPlan::policy_of(int inlet, std::int64_t k) const {
    if (policies.size() == 1) return policies[0];
    return policies[draw(pattern, policy_shares, seed, inlet, k, Purpose::policy)];
}

int DemandPlan::route_of(int inlet, std::int64_t k) const {
    const Inlet& in = inlets[static_cast<std::size_t>(inlet)];
    if (in.routes.size() == 1) return in.routes[0];
    return in.routes[draw(route_pattern, in.shares, seed, inlet, k, Purpose::turn)];
}

int DemandPlan::route_on_lane(int inlet, std::int64_t k) const {
    const Inlet& in = inlets[static_cast<std::size_t>(inlet)];
    if (in.lane_shares.empty()) return route_of(inlet, k);
    return in.routes[draw(route_pattern, in.lane_shares, seed, inlet, k, Purpose::turn)];
}

int DemandPlan::route_that_is_due(int inlet, std::int64_t k, std::span<const std::int64_t> drawn, std::int64_t all,
                                  bool chose_lane) const {
    const Inlet& in = inlets[static_cast<std::size_t>(inlet)];
    const std::vector<double>& own = chose_lane && !in.lane_shares.empty() ? in.lane_shares : in.shares;
    std::array<double, kMostTurns> due{};
    const std::span<double> shares(due.data(), own.size());
    std::copy(own.begin(), own.end(), shares.begin());
    double sum = 0.0;
    for (std::size_t c = 0; c < shares.size(); ++c) {
        const double behind =
            (in.approach_shares[c] * static_cast<double>(all) - static_cast<double>(drawn[c])) / kPatience;
        shares[c] = behind >= 0.0 ? shares[c] * (1.0 + behind) : shares[c] / (1.0 - behind);
        sum += shares[c];
    }
    for (double& share : shares) share /= sum;
    return in.routes[draw(route_pattern, shares, seed, inlet, k, Purpose::turn)];
}

}  // namespace stopline
