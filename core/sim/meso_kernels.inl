// The kernels' text. Included by one file for each build, each in a namespace of its own.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "base/arithmetic.h"
#include "base/random.h"
#include "base/simd.h"
#include "sim/meso_kernels.h"

namespace stopline {

namespace {

// The speed of the next step on the way to a limit: at once where that is lower, else a share of what is missing.
inline double approached(double speed_mps, double limit_mps, double share) {
    const double gaining_mps = speed_mps + share * (limit_mps - speed_mps);
    return lesser(gaining_mps, limit_mps);  // faster than allowed: share <= 1, so that gaining is no less
}

// The same on the way to a turn, whose allowed speed falls with the distance: slow_down_acceleration of full dynamics.
inline double slowed(double speed_mps, double allowed_mps, double share, double braked_mps) {
    return speed_mps + share * (allowed_mps - speed_mps) - braked_mps * speed_mps / greater(allowed_mps, 1.0);
}

constexpr int kTogether = 8;  // vehicles in the widest register
using Doubles = Vector<double, kTogether>;
using Floats = Vector<float, kTogether>;
using Ints = Vector<int, kTogether>;

template <class Wide, class Number>
STOPLINE_INLINE Wide read_at(const Number* from, int i) {
    Wide values;
    std::memcpy(&values, from + i, sizeof values);
    return values;
}
template <class Wide, class Number>
STOPLINE_INLINE void write_at(Number* to, int i, const Wide& values) {
    std::memcpy(to + i, &values, sizeof values);
}

// What a lane's vehicles know, brought together. Whole registers, so that no lane ends in a loop for single vehicles: what is written
// beyond the lane's last vehicle is written over by the next lane's.
STOPLINE_INLINE void gather_lane(const MesoStreams& s, const LaneStep& lane, const MesoGroup& g, int first) {
    const auto wide = [](const float* from, int i)
                          STOPLINE_INLINE_LAMBDA { return __builtin_convertvector(read_at<Floats>(from, i), Doubles); };
    for (int i = lane.begin; i < lane.stop; i += kTogether) {
        const int k = first + i - lane.begin;
        const auto position = read_at<Doubles>(s.position, i);
        write_at(g.position, k, position);
        write_at(g.speed, k, read_at<Doubles>(s.speed, i));
        write_at(g.ahead, k, read_at<Doubles>(s.speed, i - 1));
        write_at(g.gap, k, read_at<Doubles>(s.position, i - 1) - wide(s.length, i - 1) - position);
        write_at(g.ahead_acceleration, k, wide(s.acceleration, i - 1));
        write_at(g.cap, k, wide(s.end_speed, i));
        write_at(g.to_turn, k, lane.turn_m - position);
        write_at(g.limit, k, lane.limit_mps - Doubles{});
        write_at(g.more, k, Doubles{});
        write_at(g.id, k, read_at<Ints>(s.id, i));
        write_at(g.policy, k, read_at<Ints>(s.policy, i));
    }
}

// Fronts that are beyond the rear of their predecessor.
inline int overlaps(const double* gap, int vehicles) {
    constexpr double kRounding_m = 1e-6;
    int count = 0;
    for (int i = 0; i < vehicles; ++i) count += gap[i] < -kRounding_m ? 1 : 0;
    return count;
}

// The highest speeds that limits allow.
template <bool at_once>
inline void limit_speeds(const MesoStep& step, const MesoGroup& group, int vehicles) {
    const MesoStep t = step;
    const double braked_mps = t.slow_down_mps2 * t.dt;
    const double* __restrict const speed = group.speed;
    const double* __restrict const limit = group.limit;
    const double* __restrict const to_turn = group.to_turn;
    double* __restrict const ahead_acceleration = group.ahead_acceleration;
    double* __restrict const cap = group.cap;
    for (int i = 0; i < vehicles; ++i) {
        // Towards a lower limit at the end of the lane: v^2 = v_end^2 + 2 b distance.
        const double end_mps = cap[i];
        const double slow_mps = std::sqrt(end_mps * end_mps + 2.0 * t.slow_down_mps2 * greater(to_turn[i], 0.0));
        const double turn_mps = at_once ? slow_mps : slowed(speed[i], slow_mps, t.turn_share, braked_mps);
        cap[i] = lesser(approached(speed[i], limit[i], t.approach_share), turn_mps);
        ahead_acceleration[i] = greater(ahead_acceleration[i], 0.0);
    }
}

inline int gather(const MesoStreams& streams, const LaneGroup& lanes, const MesoStep& step, const MesoGroup& group) {
    const MesoStreams s = streams;  // own copies: nothing that is written here can change them
    const MesoGroup g = group;
    int vehicles = 0;
    for (const LaneStep& lane : lanes.lanes) {
        gather_lane(s, lane, g, vehicles);
        vehicles += lane.stop - lane.begin;
    }
    const int in_registers = (vehicles + kTogether - 1) / kTogether * kTogether;
    const auto limit = step.turn_share >= 1.0 ? limit_speeds<true> : limit_speeds<false>;
    limit(step, g, in_registers);
    for (const Imposed& imposed : lanes.imposed) g.cap[imposed.place] = std::min(g.cap[imposed.place], imposed.asks);
    return overlaps(g.gap, vehicles);
}

template <bool power_limit>
inline void follow_with(const Krauss& model, const MesoStep& step, const MesoGroup& group, int vehicles, int only) {
    const Krauss k = model;
    const MesoStep t = step;
    const double* __restrict const speed = group.speed;
    const double* __restrict const gap = group.gap;
    const double* __restrict const ahead = group.ahead;
    const double* __restrict const ahead_mps2 = group.ahead_acceleration;
    const double* __restrict const more = group.more;
    const double* __restrict const cap = group.cap;
    const int* __restrict const id = group.id;
    const int* __restrict const policy = group.policy;
    double* __restrict const next = group.next;
    const auto next_of = [&](int i) STOPLINE_INLINE_LAMBDA {
        const KraussInput in{speed[i], gap[i], ahead[i], ahead_mps2[i], more[i], cap[i]};
        return next_speed_mps<power_limit>(k, in, dawdle_uniform(t.key, id[i], t.tick), t.dt);
    };
    if (only < 0) {
        for (int i = 0; i < vehicles; ++i) next[i] = next_of(i);
        return;
    }
    for (int i = 0; i < vehicles; ++i) {
        const double mine = next_of(i);
        next[i] = policy[i] == only ? mine : next[i];
    }
}

inline void follow(const Krauss& model, const MesoStep& step, const MesoGroup& group, int vehicles, int only) {
    const auto loop = has_power_limit(model) ? follow_with<true> : follow_with<false>;
    loop(model, step, group, vehicles, only);
}

// Each vehicle with the parameters of its policy.
inline void follow_two(const Krauss& zero, const Krauss& one, const MesoStep& step, const MesoGroup& group,
                       int vehicles) {
    const Krauss a = zero;
    const Krauss b = one;
    const MesoStep t = step;
    const double* __restrict const speed = group.speed;
    const double* __restrict const gap = group.gap;
    const double* __restrict const ahead = group.ahead;
    const double* __restrict const ahead_mps2 = group.ahead_acceleration;
    const double* __restrict const more = group.more;
    const double* __restrict const cap = group.cap;
    const int* __restrict const id = group.id;
    const int* __restrict const policy = group.policy;
    double* __restrict const next = group.next;
    for (int i = 0; i < vehicles; ++i) {
        const bool second = policy[i] != 0;
        const auto of = [&](double first, double other) STOPLINE_INLINE_LAMBDA { return second ? other : first; };
        Krauss k;
        k.acceleration_mps2 = of(a.acceleration_mps2, b.acceleration_mps2);
        k.until_mps = of(a.until_mps, b.until_mps);
        k.transient_gap_s2 = of(a.transient_gap_s2, b.transient_gap_s2);
        k.catch_up = of(a.catch_up, b.catch_up);
        k.anticipation_s = of(a.anticipation_s, b.anticipation_s);
        k.deceleration_mps2 = of(a.deceleration_mps2, b.deceleration_mps2);
        k.reaction_s = of(a.reaction_s, b.reaction_s);
        k.standstill_gap_m = of(a.standstill_gap_m, b.standstill_gap_m);
        k.dawdling = of(a.dawdling, b.dawdling);
        k.constant_distance = second ? b.constant_distance : a.constant_distance;
        k.band_m = of(a.band_m, b.band_m);
        k.below_band = of(a.below_band, b.below_band);
        const KraussInput in{speed[i], gap[i], ahead[i], ahead_mps2[i], more[i], cap[i]};
        next[i] = next_speed_mps<true>(k, in, dawdle_uniform(t.key, id[i], t.tick), t.dt);
    }
}

// Takes the group apart, in whole registers too: lanes are in the order of memory, so that what is written beyond one of them is free
// or written over by the next. The last lane of the group ends exactly.
inline void scatter(const MesoStreams& streams, MesoKernels::Lanes lanes, const MesoStep& step,
                    const MesoGroup& group) {
    const MesoStreams s = streams;
    const MesoGroup g = group;
    const double dt = step.dt;
    const double rate_1ps = 1.0 / dt;
    int first = 0;
    for (const LaneStep& lane : lanes) {
        int i = lane.begin;
        int k = first;
        for (; i < lane.stop && i + kTogether <= lane.free_until; i += kTogether, k += kTogether) {
            const auto next = read_at<Doubles>(g.next, k);
            const auto acceleration = (next - read_at<Doubles>(g.speed, k)) * rate_1ps;
            write_at(s.acceleration, i, __builtin_convertvector(acceleration, Floats));
            write_at(s.speed, i, next);
            write_at(s.position, i, read_at<Doubles>(g.position, k) + next * dt);
        }
        for (; i < lane.stop; ++i, ++k) {
            s.acceleration[i] = static_cast<float>((g.next[k] - g.speed[k]) * rate_1ps);
            s.speed[i] = g.next[k];
            s.position[i] = g.position[k] + g.next[k] * dt;
        }
        first += lane.stop - lane.begin;
    }
}

}  // namespace

}  // namespace stopline
