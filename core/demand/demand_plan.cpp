#include "demand/demand_plan.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <unordered_map>

#include "base/random.h"

namespace stopline {

namespace {

// The functions below draw one component for a vehicle, according to the shares of all components. The components are
// the spacing policies that the vehicle can have, or the routes that it can take.

// Returns the index of the component that `number`, in [0, 1), selects. The shares sum to 1.
std::size_t pick(std::span<const double> shares, double number) {
    std::size_t k = 0;
    double upper = shares[0];
    while (number >= upper && k + 1 < shares.size()) upper += shares[++k];
    return k;
}

// Returns the component that is furthest behind: its number of draws is furthest below the number that its share
// demands. `drawn` holds the number of draws of each component, n in total; the function adds the new draw. With this
// choice, the shares hold in every part of the sequence. Components with equal shares alternate, beginning with the
// first component.
std::size_t draw_most_behind(std::span<const double> shares, std::int64_t n, std::vector<double>& drawn) {
    std::size_t chosen = 0;
    for (std::size_t c = 1; c < shares.size(); ++c) {
        const double behind = shares[c] * static_cast<double>(n + 1) - drawn[c];
        const double most_behind = shares[chosen] * static_cast<double>(n + 1) - drawn[chosen];
        if (behind > most_behind + 1e-9) chosen = c;
    }
    drawn[chosen] += 1.0;
    return chosen;
}

// Returns the component of the k-th vehicle in the alternating pattern.
std::size_t alternating_component(std::span<const double> shares, std::int64_t k) {
    std::vector<double> drawn(shares.size(), 0.0);
    std::size_t chosen = 0;
    for (std::int64_t n = 0; n <= k; ++n) chosen = draw_most_behind(shares, n, drawn);
    return chosen;
}

std::uint64_t vehicle_key(int inlet, std::int64_t k) {
    return (static_cast<std::uint64_t>(inlet) << 40) + static_cast<std::uint64_t>(k);
}

// Returns a number in [0, 1) for the k-th vehicle of an inlet. Vehicles form blocks of 20. Within a block, each vehicle
// gets a number from a different twentieth of the interval, in random order. So the shares hold in each block to within
// a twentieth.
double balanced_number(std::uint64_t seed, int inlet, std::int64_t k, Purpose purpose) {
    constexpr std::int64_t kBlock = 20;
    const std::int64_t first = k / kBlock * kBlock;
    const std::uint64_t own = random_bits(seed, vehicle_key(inlet, k), 1, purpose);
    int rank = 0;
    for (std::int64_t other = first; other < first + kBlock; ++other) {
        const std::uint64_t bits = random_bits(seed, vehicle_key(inlet, other), 1, purpose);
        rank += bits < own || (bits == own && other < k) ? 1 : 0;
    }
    const double fraction = random_uniform(seed, vehicle_key(inlet, first), 2, purpose);
    return (rank + fraction) / static_cast<double>(kBlock);
}

// Returns the index of the component of the k-th vehicle of an inlet.
std::size_t draw(DemandPlan::Pattern pattern, std::span<const double> shares, std::uint64_t seed, int inlet,
                 std::int64_t k, Purpose purpose) {
    using Pattern = DemandPlan::Pattern;
    if (pattern == Pattern::alternating) return alternating_component(shares, k);
    if (pattern == Pattern::balanced) return pick(shares, balanced_number(seed, inlet, k, purpose));
    return pick(shares, random_uniform(seed, vehicle_key(inlet, k), 0, purpose));
}

}  // namespace

void DemandPlan::draw_trip_policies() {
    trip_policies.clear();
    std::unordered_map<int, std::int64_t> drawn_trips;              // [approach] number of trips drawn so far
    std::unordered_map<int, std::vector<double>> drawn_components;  // [approach][component] number of trips drawn
    for (const Trip& trip : trips) {
        const std::int64_t k = drawn_trips[trip.approach]++;
        if (pattern != Pattern::alternating || policies.size() == 1) {
            trip_policies.push_back(policy_of(trip.approach, k));
            continue;
        }
        std::vector<double>& drawn = drawn_components.try_emplace(trip.approach, policies.size(), 0.0).first->second;
        const std::size_t chosen = draw_most_behind(policy_shares, k, drawn);
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

int DemandPlan::route_for_chosen_lane(int inlet, std::int64_t k) const {
    const Inlet& in = inlets[static_cast<std::size_t>(inlet)];
    if (in.lane_shares.empty()) return route_of(inlet, k);
    return in.routes[draw(route_pattern, in.lane_shares, seed, inlet, k, Purpose::turn)];
}

int DemandPlan::balancing_route(int inlet, std::int64_t k, std::span<const std::int64_t> drawn_per_route,
                                std::int64_t total_drawn, bool chose_lane) const {
    const Inlet& in = inlets[static_cast<std::size_t>(inlet)];
    const std::vector<double>& own = chose_lane && !in.lane_shares.empty() ? in.lane_shares : in.shares;
    std::array<double, kMaxTurns> storage{};
    const std::span<double> weights(storage.data(), own.size());
    std::copy(own.begin(), own.end(), weights.begin());
    double sum = 0.0;
    for (std::size_t c = 0; c < weights.size(); ++c) {
        const double expected = in.approach_shares[c] * static_cast<double>(total_drawn);
        const double behind = (expected - static_cast<double>(drawn_per_route[c])) / kBalanceVehicles;
        weights[c] = behind >= 0.0 ? weights[c] * (1.0 + behind) : weights[c] / (1.0 - behind);
        sum += weights[c];
    }
    for (double& weight : weights) weight /= sum;
    return in.routes[draw(route_pattern, weights, seed, inlet, k, Purpose::turn)];
}

}  // namespace stopline
