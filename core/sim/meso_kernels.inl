// The kernels' text. Included by one file for each build, each in a namespace of its own.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/random.h"
#include "sim/meso_kernels.h"

namespace stopline {

namespace {

// The speed of the next step on the way to a limit: at once where that is lower, else a share of what is missing.
inline double approached(double speed_mps, double limit_mps, double share) {
    const double missing_mps = limit_mps - speed_mps;
    return missing_mps > 0.0 ? speed_mps + share * missing_mps : limit_mps;
}

// The same on the way to a turn, whose allowed speed falls with the distance: slow_down_acceleration of full dynamics.
inline double slowed(double speed_mps, double allowed_mps, double share, double braked_mps) {
    const double next_mps =
        speed_mps + share * (allowed_mps - speed_mps) - braked_mps * speed_mps / std::max(allowed_mps, 1.0);
    return share < 1.0 ? next_mps : allowed_mps;
}

inline void gather(const MesoStreams& streams, MesoKernels::Lanes lanes, const MesoStep& step, const MesoGroup& group) {
    const MesoStreams s = streams;  // own copies: nothing that is written here can change them
    const MesoGroup g = group;
    const double slow_down_mps2 = step.slow_down_mps2;
    const double share = step.approach_share;
    const double turn_share = step.turn_share;
    const double braked_mps = slow_down_mps2 * step.dt;
    int first = 0;  // place of the lane's first vehicle
    for (const LaneStep& lane : lanes) {
        const int n = lane.stop - lane.begin;
        const double* const position = s.position + lane.begin;
        const double* const speed = s.speed + lane.begin;
        const float* const length = s.length + lane.begin;
        const float* const acceleration = s.acceleration + lane.begin;
        const float* const end_speed = s.end_speed + lane.begin;
        const double turn_m = lane.turn_m;
        const double limit_mps = lane.limit_mps;
        for (int i = 0; i < n; ++i) {
            const int k = first + i;
            g.speed[k] = speed[i];
            g.ahead[k] = speed[i - 1];
            g.ahead_acceleration[k] = std::max(static_cast<double>(acceleration[i - 1]), 0.0);
            g.gap[k] = position[i - 1] - static_cast<double>(length[i - 1]) - position[i];
            // Towards a lower limit at the end of the lane: v^2 = v_end^2 + 2 b distance.
            const auto end_mps = static_cast<double>(end_speed[i]);
            const double to_turn_m = std::max(turn_m - position[i], 0.0);
            const double slow_mps = std::sqrt(end_mps * end_mps + 2.0 * slow_down_mps2 * to_turn_m);
            g.cap[k] =
                std::min(approached(speed[i], limit_mps, share), slowed(speed[i], slow_mps, turn_share, braked_mps));
            g.more[k] = 0.0;
        }
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
