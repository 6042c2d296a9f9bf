// Source of the mesoscale kernels. Each file meso_kernels_*.cpp includes this file and thus compiles one version of the
// kernels: the version for one instruction set, or the scalar version. The kernels are compiled once for each
// car-following model (driver/following_model.h). The kernels have internal linkage, so that the linker keeps the
// versions apart. R is the number type of the equations: one double, or a vector with one double for each slot of a
// block. `Following` is the trait struct of a car-following model.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "base/random.h"
#include "base/simd/arithmetic.h"
#include "base/simd/simd.h"
#include "sim/mesoscale/following_types.h"
#include "sim/mesoscale/meso_kernels.h"
#include "sim/mesoscale/meso_vectors.inl"
#include "sim/state/no_leader.h"
#include "sim/state/vehicles/vehicle_arrays.h"

namespace stopline {

namespace {

// The random numbers of the vehicles of a block, uniform in [0, 1), and the times since their leaders began to move.
template <class R>
struct BlockRandom {
    const MesoStep& t;
    const int* id;
    const int* start_ticks;

    STOPLINE_INLINE R dawdle() const { return uniform(t.key, t.tick); }
    // Returns number `index` of each driver (driver/human.h).
    STOPLINE_INLINE R driver(std::uint64_t index) const { return uniform(t.driver_key, index); }
    STOPLINE_INLINE double time_s() const { return static_cast<double>(t.tick) * t.dt; }
    STOPLINE_INLINE R since_leader_start_s() const {
        return start_ticks == nullptr ? R(1e9) : R(get<R>(start_ticks) * t.dt);
    }

private:
    STOPLINE_INLINE R uniform(std::uint64_t key, std::uint64_t index) const {
        if constexpr (std::is_same_v<R, double>) {
            return keyed_uniform(key, *id, index);
        } else {
            Vector<int, kWide> ids;
            std::memcpy(&ids, id, sizeof ids);
            const Words bits = keyed_bits(key, same_bits<Words>(converted<std::int64_t, int>(ids)), index);
            return packed<kWide>(same_bits<Vector<double, kWide>>(bits)) - 1.0;
        }
    }
};

// Returns the next speed of a vehicle under a speed limit. A slower vehicle gains the given share of (limit - speed). A
// vehicle above the limit brakes to the limit at once, but loses at most `braked_mps` in the step.
template <class R>
STOPLINE_INLINE R approach_limit(const R& speed_mps, const R& limit_mps, double share, double braked_mps) {
    const R gaining_mps = speed_mps + share * (limit_mps - speed_mps);
    // For a vehicle above the limit, min_of() returns limit_mps, because share <= 1.
    return max_of(min_of(gaining_mps, limit_mps), speed_mps - braked_mps);
}

// Returns the next speed of a vehicle that follows a braking curve to a lower speed limit, such as that of a turn.
// `allowed_mps`: speed on the curve at the position of the vehicle. `braked_mps`: speed that a vehicle on the curve
// loses in a step. `share`: share of the deviation from the curve that is corrected in a step. Full dynamics uses the
// same equation in slow_down_acceleration().
template <class R>
STOPLINE_INLINE R approach_turn(const R& speed_mps, const R& allowed_mps, double share, const R& braked_mps) {
    return speed_mps + share * (allowed_mps - speed_mps) - braked_mps * speed_mps / max_of(allowed_mps, R(1.0));
}

// Returns the decelerations of the vehicles of a block before a lower speed limit.
template <class R>
STOPLINE_INLINE R slow_downs_mps2(const MesoStreams& s, const MesoStep& t, int i) {
    if (t.slow_downs_mps2 == nullptr) return R(t.slow_down_mps2);
    constexpr int kSize = std::is_same_v<R, double> ? 1 : kWide;
    std::array<double, std::size_t{kSize}> values{};
    for (int j = 0; j < kSize; ++j)
        values[static_cast<std::size_t>(j)] = t.slow_downs_mps2[std::max(s.policy[i + j], 0)];
    return get<R>(values.data());
}

// Returns the highest next speed that the speed limits and the speed caps allow.
template <class R, bool kInstantSlowdown>
STOPLINE_INLINE R allowed_mps(const MesoStreams& s, const MesoStep& t, int i, const R& position, const R& speed) {
    const double braked_mps = t.emergency_mps2 * t.dt;
    const R here_mps =
        min_of(approach_limit(speed, get<R>(s.limit + i), t.approach_share, braked_mps), get<R>(s.speed_cap + i));
    if (!any_differs<R>(s.end_speed + i, kNoLowerLimit_mps)) return here_mps;
    // Braking curve with the deceleration b to a lower speed limit v_end after the lane: v^2 = v_end^2 + 2 b distance.
    const R end_mps = get<R>(s.end_speed + i);
    const R to_next_limit_m = max_of(R(get<R>(s.next_limit + i) - position), R(0.0));
    const R slow_down_mps2 = slow_downs_mps2<R>(s, t, i);
    const R allowed_before_turn_mps = square_root(end_mps * end_mps + 2.0 * slow_down_mps2 * to_next_limit_m);
    R turn_mps = allowed_before_turn_mps;
    if constexpr (!kInstantSlowdown)
        turn_mps = approach_turn(speed, allowed_before_turn_mps, t.turn_share, R(slow_down_mps2 * t.dt));
    turn_mps = max_of(turn_mps, speed - braked_mps);
    return select(end_mps < static_cast<double>(kNoLowerLimit_mps), min_of(here_mps, turn_mps), here_mps);
}

// Returns a lower bound of each vehicle's acceleration: on fast lanes, the value of power_profile at the vehicle's
// speed. On lanes with a speed limit up to calibrated_limit_mps the bound is 0, because the accelerations of the driver
// models were calibrated on such lanes.
template <class R>
STOPLINE_INLINE R least_acceleration_mps2(const MesoStreams& s, const MesoStep& t, int i, const R& speed_mps) {
    if (t.power_profile == nullptr) return R(0.0);
    const R by_power = table_value(t.power_profile->acceleration_mps2, R(speed_mps * t.power_profile->bins_per_mps));
    return select(get<R>(s.limit + i) > t.calibrated_limit_mps, by_power, R(0.0));
}

// Returns the acceleration of a platoon leader at a speed.
template <class R>
STOPLINE_INLINE R platoon_leader_acceleration_mps2(const MesoStep& t, const R& speed_mps) {
    if (t.leader_profile != nullptr) {
        // The profile is evaluated at the speed in the middle of the step. The acceleration at the start of the step
        // would be wrong in a step with a gear change.
        const AccelerationProfile& profile = *t.leader_profile;
        const R first_mps2 = table_value(profile.acceleration_mps2, R(speed_mps * profile.bins_per_mps));
        const R middle_mps = speed_mps + first_mps2 * (0.5 * t.dt);
        return table_value(profile.acceleration_mps2, R(middle_mps * profile.bins_per_mps));
    }
    return t.leader_mps2 *
           R(t.leader_constant_power_speed_mps / max_of(speed_mps, R(t.leader_constant_power_speed_mps)));
}

// Computes the next speeds of platoon leaders. Returns these speeds, and `next` for all other vehicles. All platoon
// leaders have the same acceleration, whatever their policy. A platoon leader becomes a follower when two conditions
// hold: its next speed is above 0, and its safe speed behind the vehicle ahead is lower than its speed in free driving.
// `following_mps`: result of Following::following_speed_mps(). `next`: next speeds of the vehicles as followers.
// `k`: parameters of a policy. `has_policy`: 1 for vehicles with this policy, else 0. `least_mps2`: lower bound of the
// acceleration.
template <class Following, class R, class Model>
STOPLINE_INLINE R platoon_leader_speed(const Model& k, const MesoStep& t, const FollowingInputOf<R>& in,
                                       const R& following_mps, const R& next, const R& has_policy, const R& least_mps2,
                                       float* is_platoon_leader) {
    const R acceleration_mps2 = max_of(platoon_leader_acceleration_mps2(t, in.speed_mps), least_mps2);
    const R free_mps = in.speed_mps + acceleration_mps2 * t.dt;
    const R contact_mps = contact_speed_mps(in, t.dt);
    const R safe_mps =
        min_of(Following::leader_speed_mps(k, in, following_mps, t.relays, t.leaders_use_following_speed), contact_mps);
    const R behind_mps = select(in.gap_m > kLongestGap_m, contact_mps, safe_mps);
    const R leader_next = snap_to_standstill(min_of(behind_mps, min_of(free_mps, in.speed_cap_mps)));
    const R was_leader = get<R>(is_platoon_leader);
    const R becomes_follower =
        STOPLINE_FLAG(R, behind_mps < free_mps) * STOPLINE_FLAG(R, leader_next > 0.0) * has_policy;
    put(is_platoon_leader, was_leader * (1.0 - becomes_follower));
    return choose(R(was_leader * has_policy), leader_next, next);
}

constexpr double kNoExtraGap[kWide] = {};

// Properties of a run. The kernels are compiled once for each combination.
struct MesoVariant {
    // Number of policies, 1 or 2, if the models alone limit the accelerations. 0: the kernels go through all policies,
    // and apply MesoStep::acceleration_limits.
    int policies;
    bool power_limit;       // true: at high speed the acceleration of at least one policy falls (constant power)
    bool instant_slowdown;  // true: vehicles reach the braking curve before a turn in one step (turn_share = 1)
};

// The vehicles of one block at the start of a step, and the part of the computation that all models share.
template <class R, bool kInstantSlowdown>
struct Block {
    const MesoStreams& s;
    const MesoStep& t;
    int i;  // first slot
    R position, speed;
    FollowingInputOf<R> in;
    bool has_platoon_leaders;
    R policy, least_mps2;

    STOPLINE_INLINE Block(const MesoStreams& streams, int slot, const double* extra_gap, const MesoStep& step)
        : s(streams),
          t(step),
          i(slot),
          position(get<R>(s.position + i)),
          speed(get<R>(s.speed + i)),
          in{speed,
             get<R>(s.position + i - 1) - get<R>(s.length + i - 1) - position,
             get<R>(s.speed + i - 1),
             max_of(get<R>(s.acceleration + i - 1), R(0.0)),
             get<R>(extra_gap),
             allowed_mps<R, kInstantSlowdown>(s, t, i, position, speed),
             get<R>(s.limit + i)},
          has_platoon_leaders((t.leader_mps2 > 0.0 || t.leader_profile != nullptr) &&
                              any_differs<R>(s.is_platoon_leader + i, 0.0F)),
          policy(get<R>(s.policy + i)),
          least_mps2(least_acceleration_mps2(s, t, i, speed)) {}

    // Returns the next speeds if all vehicles have the parameters `k`. `has_policy`: see platoon_leader_speed().
    template <class Following, bool power_limit, class Model>
    STOPLINE_INLINE R next_speed_mps(const Model& k, const R& has_policy) const {
        const BlockRandom<R> random{t, s.id + i, s.start_ticks == nullptr ? nullptr : s.start_ticks + i};
        const R following_mps = Following::following_speed_mps(k, in, random, t.dt);
        const R lowest_mps = in.speed_mps - t.hardest_mps2 * t.dt;
        const R desired_mps =
            Following::template desired_speed_mps<power_limit>(k, in, following_mps, t.dt, least_mps2);
        const R next =
            Following::disturbed_speed_mps(k, bounded_speed_mps(in, desired_mps, lowest_mps, t.dt), random, t.dt);
        if (!has_platoon_leaders) return next;
        return platoon_leader_speed<Following>(k, t, in, following_mps, next, has_policy, least_mps2,
                                               s.is_platoon_leader + i);
    }

    // Returns the next speeds, or the speeds that the vehicles reach in this step with their highest accelerations
    // (MesoStep::acceleration_limits) if these speeds are lower.
    STOPLINE_INLINE R within_acceleration_limits(const R& next_mps) const {
        if (t.acceleration_limits == nullptr) return next_mps;
        constexpr int kSize = std::is_same_v<R, double> ? 1 : kWide;
        std::array<double, std::size_t{kSize}> reachable{};
        for (int j = 0; j < kSize; ++j) {
            const AccelerationProfile& limit = t.acceleration_limits[std::max(s.policy[i + j], 0)];
            reachable[static_cast<std::size_t>(j)] = s.speed[i + j] + limit.at(s.speed[i + j]) * t.dt;
        }
        return min_of(next_mps, get<R>(reachable.data()));
    }

    // Moves the vehicles with their next speeds. Returns 1 for each vehicle that overlaps its leader, else 0.
    STOPLINE_INLINE R move(const R& next) const {
        constexpr double kRounding_m = 1e-6;
        const auto occupied = occupied_slots<R>(s.id + i);
        put(s.acceleration + i, select(occupied, R((next - speed) * (1.0 / t.dt)), get<R>(s.acceleration + i)));
        put(s.speed + i, select(occupied, next, speed));
        put(s.position + i, select(occupied, R(position + next * t.dt), position));
        return select(occupied, STOPLINE_FLAG(R, in.gap_m < -kRounding_m), R(0.0));
    }
};

// Moves the vehicles of one block. Returns 1 for each vehicle that overlaps its leader, else 0.
template <class R, class Following, MesoVariant kVariant>
STOPLINE_INLINE R step_slots(const MesoStreams& s, int i, std::span<const FollowingModel> models,
                             const double* extra_gap, const MesoStep& t) {
    const Block<R, kVariant.instant_slowdown> block(s, i, extra_gap, t);
    const auto next_speed = [&](const auto& k, const R& has_policy) STOPLINE_INLINE_LAMBDA {
        return block.template next_speed_mps<Following, kVariant.power_limit>(k, has_policy);
    };
    R next = block.speed;
    if constexpr (kVariant.policies == 1) {
        next = next_speed(models[0].template as<Following>(), R(1.0));
    } else if constexpr (kVariant.policies == 2) {
        next = next_speed(Following::of_two_policies(block.policy, models[0].template as<Following>(),
                                                     models[1].template as<Following>()),
                          R(1.0));
    } else {
        for (std::size_t k = 0; k < models.size(); ++k) {
            const R has_policy = STOPLINE_FLAG(R, block.policy == static_cast<double>(k));
            next = choose(has_policy, next_speed(models[k].template as<Following>(), has_policy), next);
        }
        next = block.within_acceleration_limits(next);
    }
    return block.move(next);
}

// Computes the next speeds of the vehicles in one block that have the policy number `policy`. Writes them to `next_mps`
// and leaves the values of all other vehicles unchanged.
template <class R, class Following>
inline void block_speeds(const MesoStreams& streams, int i, const FollowingModel& model, int policy,
                         const double* extra_gap, const MesoStep& step, double* next_mps) {
    const MesoStreams s = streams;
    const MesoStep t = step;
    const auto compute = [&](const auto& block) STOPLINE_INLINE_LAMBDA {
        const R has_policy = STOPLINE_FLAG(R, block.policy == static_cast<double>(policy));
        const R next = block.template next_speed_mps<Following, true>(model.as<Following>(), has_policy);
        put(next_mps, choose(has_policy, next, get<R>(next_mps)));
    };
    if (t.turn_share >= 1.0) return compute(Block<R, true>(s, i, extra_gap, t));
    compute(Block<R, false>(s, i, extra_gap, t));
}

// Moves the vehicles of one block in a run with several car-following models. Calls the kernels of each policy whose
// vehicles are in the block.
template <class R>
inline R step_mixed_slots(const MesoStreams& s, int i, std::span<const FollowingModel> models, const double* extra_gap,
                          const MesoStep& t) {
    constexpr int kSize = std::is_same_v<R, double> ? 1 : kWide;
    std::array<double, std::size_t{kSize}> next_mps{};
    put(next_mps.data(), get<R>(s.speed + i));
    for (std::size_t k = 0; k < models.size(); ++k) {
        const int policy = static_cast<int>(k);
        bool is_present = false;
        for (int j = 0; j < kSize; ++j) is_present = is_present || s.policy[i + j] == policy;
        if (!is_present) continue;
        models[k].family().kernels(kSize == 1).block_speeds(s, i, models[k], policy, extra_gap, t, next_mps.data());
    }
    const R next = get<R>(next_mps.data());
    const auto move = [&](const auto& block)
                          STOPLINE_INLINE_LAMBDA { return block.move(block.within_acceleration_limits(next)); };
    return t.turn_share >= 1.0 ? move(Block<R, true>(s, i, extra_gap, t)) : move(Block<R, false>(s, i, extra_gap, t));
}

STOPLINE_INLINE double sum(double value) { return value; }
STOPLINE_INLINE double sum(const Wide& values) {
    double total = 0.0;
    for (int j = 0; j < kWide; ++j) total += values.v[j];
    return total;
}

STOPLINE_INLINE void prefetch_block(const MesoStreams& s, int i) {
    for (const double* const stream : {static_cast<const double*>(s.position), static_cast<const double*>(s.speed),
                                       s.limit, s.next_limit, s.speed_cap}) {
        __builtin_prefetch(stream + i);
    }
    for (const float* const stream : {s.length, s.end_speed, static_cast<const float*>(s.acceleration),
                                      static_cast<const float*>(s.is_platoon_leader)}) {
        __builtin_prefetch(stream + i);
    }
    for (const int* const stream : {s.id, s.policy}) __builtin_prefetch(stream + i);
}

// Moves the vehicles of all blocks and returns the number of overlaps. Begins with the last block. The first vehicle of
// a block may react to the last vehicle of the preceding block, so the preceding block must not have moved yet.
// `step_block` moves one block.
template <class R, class StepBlock>
STOPLINE_INLINE int step_blocks(const MesoStreams& streams, std::span<const int> blocks,
                                std::span<const FollowingModel> models, ExtraGap extra_gaps, const MesoStep& step,
                                StepBlock step_block) {
    constexpr int kSize = std::is_same_v<R, double> ? 1 : kWide;
    const MesoStreams s = streams;  // local copies, so that the compiler knows that stores do not change them
    const MesoStep t = step;
    R overlaps = 0.0;
    constexpr std::size_t kPrefetchBlocks = 8;
    for (std::size_t n = blocks.size(); n-- > 0;) {
        if (t.prefetches && n >= kPrefetchBlocks) prefetch_block(s, blocks[n - kPrefetchBlocks] * kSize);
        const double* const extra_gap = extra_gaps == nullptr ? kNoExtraGap : extra_gaps + n * kSize;
        overlaps += step_block(s, blocks[n] * kSize, models, extra_gap, t);
    }
    return static_cast<int>(sum(overlaps));
}

// Moves the vehicles of all blocks in a run in which all policies have the model `Following`.
template <class R, class Following, MesoVariant kVariant>
inline int step_variant(const MesoStreams& s, std::span<const int> blocks, std::span<const FollowingModel> models,
                        ExtraGap extra_gaps, const MesoStep& t) {
    return step_blocks<R>(s, blocks, models, extra_gaps, t, [](const auto&... arguments) STOPLINE_INLINE_LAMBDA {
        return step_slots<R, Following, kVariant>(arguments...);
    });
}

template <class R>
inline int step_mixed(const MesoStreams& s, std::span<const int> blocks, std::span<const FollowingModel> models,
                      ExtraGap extra_gaps, const MesoStep& t) {
    return step_blocks<R>(s, blocks, models, extra_gaps, t, [](const auto&... arguments) STOPLINE_INLINE_LAMBDA {
        return step_mixed_slots<R>(arguments...);
    });
}

template <class R, class Following>
inline void follow(const FollowingModel& model, const MesoStep& step, const FollowingInputOf<const double*>& in,
                   std::span<const int> ids, double* next_mps) {
    constexpr std::size_t kSize = std::is_same_v<R, double> ? 1 : kWide;
    const Following k = model.as<Following>();
    const MesoStep t = step;
    for (std::size_t i = 0; i < ids.size(); i += kSize) {
        const FollowingInputOf<R> input{get<R>(in.speed_mps + i),        get<R>(in.gap_m + i),
                                        get<R>(in.leader_speed_mps + i), get<R>(in.leader_acceleration_mps2 + i),
                                        get<R>(in.extra_gap_m + i),      get<R>(in.speed_cap_mps + i),
                                        get<R>(in.limit_mps + i)};
        const BlockRandom<R> random{t, ids.data() + i, nullptr};
        const R following_mps = Following::following_speed_mps(k, input, random, t.dt);
        const R desired_mps = Following::template desired_speed_mps<true>(k, input, following_mps, t.dt, R(0.0));
        put(next_mps + i,
            Following::disturbed_speed_mps(k, bounded_speed_mps(input, desired_mps, R(0.0), t.dt), random, t.dt));
    }
}

// A model for which more versions of the kernels are compiled: for exactly one and for two policies. These versions are
// used only without acceleration limits. There is each one with and without power limit.
template <class Following, class R>
concept HasFastVersions = requires(const R& policy, const Following& model) {
    Following::of_two_policies(policy, model, model);
};

template <class R, class Following>
inline int step(const MesoStreams& streams, std::span<const int> blocks, std::span<const FollowingModel> models,
                ExtraGap extra_gaps, const MesoStep& t) {
    const auto step_as = [&](auto policies, auto power_limit, auto instant_slowdown) {
        constexpr MesoVariant kVariant{policies, power_limit, instant_slowdown};
        return step_variant<R, Following, kVariant>(streams, blocks, models, extra_gaps, t);
    };
    const auto step_with = [&](auto policies, auto power_limit) {
        return t.turn_share >= 1.0 ? step_as(policies, power_limit, std::true_type())
                                   : step_as(policies, power_limit, std::false_type());
    };
    constexpr std::integral_constant<int, 0> kAnyNumber;
    if constexpr (HasFastVersions<Following, R>) {
        const bool has_power_limit = std::any_of(models.begin(), models.end(), [](const FollowingModel& model) {
            return model.as<Following>().has_power_limit();
        });
        const auto step_limited = [&](auto policies) {
            return has_power_limit ? step_with(policies, std::true_type()) : step_with(policies, std::false_type());
        };
        if (t.acceleration_limits != nullptr) return step_limited(kAnyNumber);
        if (models.size() == 1) return step_limited(std::integral_constant<int, 1>());
        if (models.size() == 2) return step_limited(std::integral_constant<int, 2>());
        return step_limited(kAnyNumber);
    } else {
        return step_with(kAnyNumber, std::true_type());
    }
}

// Returns the kernels of one car-following model.
template <class R, class Following>
constexpr MesoKernels kernels_of(const char* name) {
    return {name,
            std::is_same_v<R, double> ? 1 : kWide,
            step<R, Following>,
            step_mixed<R>,
            block_speeds<R, Following>,
            follow<R, Following>};
}

// Returns the kernels of all registered models, in the order of the list.
template <class R, class... Models>
constexpr std::array<MesoKernels, sizeof...(Models)> kernels_of_all(const char* name, FollowingList<Models...>) {
    return {kernels_of<R, Models>(name)...};
}

}  // namespace

}  // namespace stopline
