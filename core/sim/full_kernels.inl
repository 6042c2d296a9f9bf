// The kernels' text. Included by one file for each instruction set, each in a namespace of its own.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <utility>

#include "base/simd_memory.h"
#include "base/units.h"
#include "sim/full_kernels.h"
#include "vehicle/powertrain_step.h"

namespace stopline {

namespace {

// A vehicle that stands and has no reason to start is held by its brake, as a hill holder does.
constexpr double kStanding_mps = 1e-3;
constexpr double kStart_mps2 = 0.01;
constexpr double kHold_mps2 = -0.3;
// A speed as small as this is what rounding leaves of standstill.
constexpr double kRest_mps = 1e-6;
constexpr double kNothing_mps2 = 1e3;  // an answer that never wins

// One sample of a delay line, between two rows where the delay is no multiple of the step.
template <class R>
STOPLINE_INLINE R delayed(const Rows& rows, const float* late, const float* later, int i) {
    const R sample = load<R>(late + i);
    return rows.later_share == 0.0 ? sample : rows.late_share * sample + rows.later_share * load<R>(later + i);
}

// The vehicle in slot i of a lane, or with R = Batch those from slot i on, to place k of the group.
template <class R>
STOPLINE_INLINE void gather_at(const FullStreams& s, const Rows& radar, const Rows& v2v, const LaneStep& lane, int i,
                               int k, double dt, const FullGroup& g) {
    const R speed = load<R>(s.speed + i);
    // Measure. A radar without delay reads what is written here.
    store(s.gap_now + i, load_difference<R>(s.position + i - 1, s.position + i) - load<R>(s.length + i - 1));
    store(s.closing_now + i, speed - load<R>(s.speed + i - 1));
    // What is known of the predecessor now.
    store(g.gap + k, delayed<R>(radar, s.gap_late, s.gap_later, i));
    store(g.closing + k, delayed<R>(radar, s.closing_late, s.closing_later, i));
    store(g.heard_acceleration + k, delayed<R>(v2v, s.heard_acceleration, s.earlier_acceleration, i - 1));
    store(g.heard_request + k, delayed<R>(v2v, s.heard_request, s.earlier_request, i - 1));
    store(g.heard_rate + k, delayed<R>(v2v, s.heard_rate, s.earlier_rate, i - 1));
    // The road.
    store(g.to_turn + k, load_difference<R>(lane.turn_m, s.position + i));
    store(g.limit + k, splat<R>(lane.limit_mps));
    store(g.sine + k, splat<R>(lane.sine));
    store(g.imposed + k, splat<R>(kNothing_mps2));
    // Itself.
    store(g.speed + k, speed);
    const auto take = [&](const float* from, float* to) STOPLINE_INLINE_LAMBDA { store(to + k, load<R>(from + i)); };
    take(s.end_speed, g.end_speed), take(s.standstill_gap, g.standstill_gap), take(s.acceleration, g.acceleration);
    take(s.lag, g.lag), take(s.request, g.request), take(s.leads, g.leads), take(s.torque, g.torque);
    take(s.brake, g.brake), take(s.gear_time, g.gear_time), take(s.gear, g.gear);
    for (int j = 0; j < kWidthOf<R>; ++j) {
        g.coming_mps[k + j] = std::max(s.speed[i + j] + static_cast<double>(s.acceleration[i + j]) * dt, 0.0);
    }
    if (s.policy != nullptr) std::memcpy(g.policy + k, s.policy + i, kWidthOf<R> * sizeof(int));
    if (s.type != nullptr) std::memcpy(g.type + k, s.type + i, kWidthOf<R> * sizeof(int));
}

// Calls treat(number type, i) for the slots of a lane, from its first vehicle on: whole batches, and half a batch where that is
// enough for the last ones.
template <class R, class Treat>
STOPLINE_INLINE void for_each_batch(const LaneStep& lane, Treat treat) {
    int i = lane.begin;
    if constexpr (kWidthOf<R> >= 16) {
        for (; i + kWidthOf<R> / 2 < lane.stop; i += kWidthOf<R>) treat(R(0.0), i);
        if (i < lane.stop) treat(Packed<kWidthOf<R> / 2>(0.0), i);
    } else {
        for (; i < lane.stop; i += kWidthOf<R>) treat(R(0.0), i);
    }
}

// Fetches what the next group needs, some of it with each batch of this one: memory then works while the processor computes, and
// no burst of requests waits for its turn. The processor itself sees no stream in a lane's share of an array: it is too short.
class Fetching {
public:
    Fetching(const FullStreams& streams, const FullKernels::NextSlots& slots, int vehicles, int width)
        : slots_(slots), streams_(streams) {
        const auto batches = static_cast<std::size_t>((vehicles + width - 1) / width);
        a_batch_ = slots.empty() ? 0 : (slots.size() + batches - 1) / batches;
    }

    // What the driver's part of the k-th batch brings: where vehicles are, what they are, and what they measured.
    STOPLINE_INLINE void known(int k) const {
        each(k, [&](int i) STOPLINE_INLINE_LAMBDA {
            const FullStreams& s = streams_;
            for (const double* stream : {s.position, s.speed}) {
                __builtin_prefetch(stream + i);
                __builtin_prefetch(stream + i + kSimdWidth / 2);
            }
            fetch_lines(i, s.length, s.standstill_gap, s.end_speed, s.gap_now, s.gap_late, s.closing_now,
                        s.closing_late, s.leads);
        });
    }
    // What the vehicle's part of it brings: its powertrain, and what is told.
    STOPLINE_INLINE void driven(int k) const {
        each(k, [&](int i) STOPLINE_INLINE_LAMBDA {
            const FullStreams& s = streams_;
            fetch_lines(i, s.acceleration, s.lag, s.request, s.torque, s.brake, s.gear_time, s.gear,
                        s.tell_acceleration, s.tell_request, s.tell_rate, s.heard_acceleration, s.heard_request,
                        s.heard_rate);
            if (s.policy != nullptr) fetch_lines(i, s.policy);
            if (s.type != nullptr) fetch_lines(i, s.type);
        });
    }

private:
    template <class... Streams>
    STOPLINE_INLINE static void fetch_lines(int i, Streams... streams) {
        (__builtin_prefetch(streams + i), ...);
    }
    template <class Fetch>
    STOPLINE_INLINE void each(int k, Fetch fetch) const {
        const std::size_t end = std::min(slots_.size(), (static_cast<std::size_t>(k) + 1) * a_batch_);
        for (std::size_t j = static_cast<std::size_t>(k) * a_batch_; j < end; ++j) fetch(slots_[j]);
    }

    FullKernels::NextSlots slots_;
    std::size_t a_batch_ = 0;  // slots that each batch of this group brings
    FullStreams streams_;
};

template <class R>
void gather(const FullStreams& streams, const Rows& radar_rows, const Rows& v2v_rows, const LaneGroup& lanes, double dt,
            const FullGroup& group) {
    const FullStreams s = streams;  // own copies: nothing that is written here can change them
    const FullGroup g = group;
    const Rows radar = radar_rows;
    const Rows v2v = v2v_rows;
    int first = 0;  // place of the lane's first vehicle
    for (const LaneStep& lane : lanes.lanes) {
        const int to_place = first - lane.begin;
        for_each_batch<R>(lane, [&](auto number, int i) STOPLINE_INLINE_LAMBDA {
            gather_at<decltype(number)>(s, radar, v2v, lane, i, i + to_place, dt, g);
        });
        first += lane.stop - lane.begin;
    }
    for (const Imposed& imposed : lanes.imposed) {
        g.imposed[imposed.place] = std::min(g.imposed[imposed.place], static_cast<float>(imposed.asks_mps2));
    }
}

// The vehicle at place k of the group, or those from there on.
template <class R>
STOPLINE_INLINE void plan_at(const DriverTablesOf<float>& d, const FullGroup& g, double dt, int k) {
    const CaccSettingsOf<float>& c = d.cacc;
    const auto get = [k](const auto* array) STOPLINE_INLINE_LAMBDA { return load<R>(array + k); };
    const R speed = get(g.speed);
    const R acceleration = get(g.acceleration);
    const R lag = get(g.lag);
    const R before = get(g.request);
    const R limit = get(g.limit);
    const R rate = 1.0 / lag;
    PredecessorView<R> p{};
    p.gap_m = get(g.gap);
    p.closing_mps = get(g.closing);
    p.acceleration_mps2 = get(g.heard_acceleration);
    p.request_mps2 = get(g.heard_request);
    p.rate_1ps = get(g.heard_rate);

    // Drive freely.
    const R nothing = splat<R>(kNothing_mps2);
    const R as_leader = free_acceleration(d, speed, limit);
    const R end_speed = get(g.end_speed);
    R slow_down = nothing;
    if (any(STOPLINE_FLAG(R, end_speed < kNothing_mps2))) {
        slow_down = slow_down_acceleration(d, speed, end_speed, get(g.to_turn));
    }
    // Follow.
    const R standstill_gap = get(g.standstill_gap);
    const R desired_gap = get(g.desired_gap);
    const R growth_m = greater(desired_gap - standstill_gap, 0.0);
    const R follow =
        follow_acceleration(c, speed, acceleration, lag, rate, before, desired_gap, growth_m, get(g.slope), p, dt);
    const R emergency = lesser(emergency_acceleration(c, speed, p), keep_room_acceleration(c, speed, growth_m, p));
    // Stop behind a standing predecessor; where else it must stop, `imposed` says.
    const R behind = stop_behind_acceleration(d, speed, standstill_gap, p);

    // The smallest answer wins. A platoon leader becomes a follower when following asks for less than driving freely.
    const R leads = get(g.leads) * STOPLINE_FLAG(R, follow > as_leader);
    const R drive = lesser(choose(leads, as_leader, catch_up_acceleration(d, speed, limit)), slow_down);
    const R smallest = lesser(lesser(lesser(drive, follow), emergency), lesser(get(g.imposed), behind));
    const R smooth = limited<R>(smallest, before - c.jerk_down_mps3 * dt, before + c.jerk_up_mps3 * dt);
    // A standing vehicle does not brake harder and harder: its next start begins from zero.
    const R lowest = select(speed <= kStanding_mps, splat<R>(0.0), splat<R>(-c.deceleration_emergency_mps2));
    const R request = greater(smooth, lowest);
    store(g.request + k, request);
    // Within the step the request moves from the last one to this one.
    const R held = STOPLINE_FLAG(R, speed <= kStanding_mps) * STOPLINE_FLAG(R, request <= kStart_mps2);
    store(g.mean_request + k, choose(held, splat<R>(kHold_mps2), 0.5 * (before + request)));
    store(g.leads + k, leads);
    // Tell. The request is in force at the end of this step; the acceleration, a mean over the last one, is brought to
    // that time by the lag.
    const R reached = lesser(1.5 * dt * rate, 1.0);
    store(g.told_acceleration + k, acceleration + (request - acceleration) * reached);
    store(g.told_rate + k, rate);
}

// As far as they are of type `only` (< 0: all are).
template <class R>
STOPLINE_INLINE void drive_at(const PowertrainTablesOf<float>& t, const FullGroup& g, double dt, int only, int k) {
    const auto get = [k](const auto* array) STOPLINE_INLINE_LAMBDA { return load<R>(array + k); };
    PowertrainState<R> now{};
    now.speed_mps = get(g.speed);
    now.acceleration_mps2 = get(g.acceleration);
    now.torque_Nm = get(g.torque);
    now.brake_N = get(g.brake);
    now.gear_time_s = get(g.gear_time);
    now.lag_s = get(g.lag);
    now.gear = get(g.gear);
    const R grade_N = t.mass_kg * kGravity_mps2 * get(g.sine);
    const PowertrainState<R> next = powertrain_step<R>(t, now, get(g.mean_request), grade_N, dt);
    const R mine = only < 0 ? splat<R>(1.0) : STOPLINE_FLAG(R, get(g.type) == only);
    const auto put = [&](float* array, const R& then, const R& before)
                         STOPLINE_INLINE_LAMBDA { store(array + k, only < 0 ? then : choose(mine, then, before)); };
    put(g.acceleration, next.acceleration_mps2, now.acceleration_mps2);
    put(g.torque, next.torque_Nm, now.torque_Nm);
    put(g.brake, next.brake_N, now.brake_N);
    put(g.gear_time, next.gear_time_s, now.gear_time_s);
    put(g.lag, next.lag_s, now.lag_s);
    put(g.gear, next.gear, now.gear);
}

template <class R>
void plan(const DriverTablesOf<float>& d, const FullGroup& group, int vehicles, double dt, const FullStreams& streams,
          FullKernels::NextSlots next) {
    const FullGroup g = group;
    const Fetching fetching(streams, next, vehicles, kWidthOf<R>);
    for (int k = 0; k < vehicles; k += kWidthOf<R>) {
        fetching.known(k / kWidthOf<R>);
        plan_at<R>(d, g, dt, k);
    }
}

template <class R>
void drive(const PowertrainTablesOf<float>& t, const FullGroup& group, int vehicles, double dt, int only,
           const FullStreams& streams, FullKernels::NextSlots next) {
    const FullGroup g = group;
    const Fetching fetching(streams, next, vehicles, kWidthOf<R>);
    for (int k = 0; k < vehicles; k += kWidthOf<R>) {
        fetching.driven(k / kWidthOf<R>);
        drive_at<R>(t, g, dt, only, k);
    }
}

template <class R>
void scatter(const FullStreams& streams, FullKernels::Lanes lanes, const FullGroup& group, double dt) {
    const FullStreams s = streams;
    const FullGroup g = group;
    int first = 0;
    for (const LaneStep& lane : lanes) {
        const int to_place = first - lane.begin;
        for_each_batch<R>(lane, [&](auto number, int i) STOPLINE_INLINE_LAMBDA {
            const auto give = [&](const float* from, float* to) STOPLINE_INLINE_LAMBDA {
                store(to + i, load<decltype(number)>(from + i + to_place));
            };
            give(g.request, s.request), give(g.leads, s.leads), give(g.acceleration, s.acceleration);
            give(g.torque, s.torque), give(g.brake, s.brake), give(g.gear_time, s.gear_time);
            give(g.lag, s.lag), give(g.gear, s.gear), give(g.request, s.tell_request);
            give(g.told_acceleration, s.tell_acceleration), give(g.told_rate, s.tell_rate);
        });
        // Speed and position from the acceleration realised in the step.
        for (int i = lane.begin; i < lane.stop; ++i) {
            const double before = s.speed[i];
            const double after = before + static_cast<double>(s.acceleration[i]) * dt;
            s.speed[i] = after > kRest_mps ? after : 0.0;
            s.position[i] += 0.5 * (before + s.speed[i]) * dt;
        }
        first += lane.stop - lane.begin;
    }
}

template <class R>
constexpr FullKernels kernels_of(const char* name) {
    return {name, gather<R>, plan<R>, drive<R>, scatter<R>};
}

}  // namespace

}  // namespace stopline
