// The kernels' text. Included by one file for each build, each in a namespace of its own.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/arithmetic.h"
#include "base/random.h"
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

// Where a lane's vehicles stand in the group, and what they all have in common.
struct LaneShare {
    int n;
    double turn_m;
    double limit_mps;
    double share;
    double turn_share;
    double slow_down_mps2;
    double braked_mps;
};

// `v`, `x`, ...: of the lane's first vehicle; the sentinel is before it.
template <bool at_once>
inline void gather_lane(const LaneShare& of, const double* __restrict v, const double* __restrict x,
                        const float* __restrict length, const float* __restrict a, const float* __restrict end_speed,
                        const MesoGroup& group, int first) {
    const LaneShare lane = of;
    double* __restrict const to_speed = group.speed + first;
    double* __restrict const to_ahead = group.ahead + first;
    double* __restrict const to_ahead_acceleration = group.ahead_acceleration + first;
    double* __restrict const to_gap = group.gap + first;
    double* __restrict const to_cap = group.cap + first;
    double* __restrict const to_more = group.more + first;
    // Single to double precision first: g++ 12 does not vectorise both in one loop.
    for (int i = 0; i < lane.n; ++i) {
        to_ahead_acceleration[i] = greater(static_cast<double>(a[i - 1]), 0.0);
        to_gap[i] = static_cast<double>(length[i - 1]);
        to_cap[i] = static_cast<double>(end_speed[i]);
    }
    for (int i = 0; i < lane.n; ++i) {
        to_speed[i] = v[i];
        to_ahead[i] = v[i - 1];
        to_gap[i] = x[i - 1] - to_gap[i] - x[i];
        to_more[i] = 0.0;
        // Towards a lower limit at the end of the lane: v^2 = v_end^2 + 2 b distance.
        const double end_mps = to_cap[i];
        const double to_turn_m = greater(lane.turn_m - x[i], 0.0);
        const double slow_mps = std::sqrt(end_mps * end_mps + 2.0 * lane.slow_down_mps2 * to_turn_m);
        const double turn_mps = at_once ? slow_mps : slowed(v[i], slow_mps, lane.turn_share, lane.braked_mps);
        to_cap[i] = lesser(approached(v[i], lane.limit_mps, lane.share), turn_mps);
    }
}

inline void gather(const MesoStreams& streams, MesoKernels::Lanes lanes, const MesoStep& step, const MesoGroup& group) {
    const MesoStreams s = streams;  // own copies: nothing that is written here can change them
    const MesoGroup g = group;
    const double share = step.approach_share;
    const auto gather_one = step.turn_share >= 1.0 ? gather_lane<true> : gather_lane<false>;
    int first = 0;  // place of the lane's first vehicle
    for (const LaneStep& lane : lanes) {
        const int n = lane.stop - lane.begin;
        const LaneShare of{
            n, lane.turn_m, lane.limit_mps, share, step.turn_share, step.slow_down_mps2, step.slow_down_mps2 * step.dt};
        gather_one(of, s.speed + lane.begin, s.position + lane.begin, s.length + lane.begin,
                   s.acceleration + lane.begin, s.end_speed + lane.begin, g, first);
        std::copy_n(s.id + lane.begin, n, g.id + first);
        std::copy_n(s.policy + lane.begin, n, g.policy + first);
        if (lane.leader_mps > 0.0) {
            g.cap[first] = std::min(g.cap[first], approached(g.speed[first], lane.leader_mps, share));
        }
        for (int n_imposed = 0; n_imposed < lane.imposed_count; ++n_imposed) {
            const auto [slot, asks] = lane.imposed[static_cast<std::size_t>(n_imposed)];
            double& cap_mps = g.cap[first + slot - lane.begin];
            cap_mps = std::min(cap_mps, asks);
        }
        first += n;
    }
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

inline void scatter(const MesoStreams& streams, MesoKernels::Lanes lanes, const MesoStep& step,
                    const MesoGroup& group) {
    const MesoStreams s = streams;
    const MesoGroup g = group;
    const double dt = step.dt;
    const double rate_1ps = 1.0 / dt;
    int first = 0;
    for (const LaneStep& lane : lanes) {
        const int n = lane.stop - lane.begin;
        double* __restrict const position = s.position + lane.begin;
        double* __restrict const speed = s.speed + lane.begin;
        float* __restrict const acceleration = s.acceleration + lane.begin;
        const double* __restrict const next = g.next + first;
        for (int i = 0; i < n; ++i) {
            acceleration[i] = static_cast<float>((next[i] - speed[i]) * rate_1ps);
            speed[i] = next[i];
            position[i] += next[i] * dt;
        }
        first += n;
    }
}

}  // namespace

}  // namespace stopline
