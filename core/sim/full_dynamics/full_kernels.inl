// Source of the full-dynamics kernels. One .cpp file for each instruction set includes this file. The kernels have
// internal linkage, so that the linker keeps the versions for the instruction sets apart.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <utility>

#include "base/simd/simd_memory.h"
#include "base/speed_thresholds.h"
#include "base/units.h"
#include "driver/idm.h"
#include "sim/full_dynamics/full_kernels.h"
#include "sim/full_dynamics/receive_kernels.inl"
#include "vehicle/powertrain_step.h"

namespace stopline {

namespace {

// The brake holds a vehicle whose speed is at most kBrakeHoldSpeed_mps. It releases the vehicle when the driver
// requests more than kStart_mps2. The powertrain of a held vehicle gets the request kHold_mps2.
constexpr double kStart_mps2 = 0.01;
constexpr double kHold_mps2 = -0.3;

// Returns a delayed radar or V2V sample. Interpolates between two rows if the delay is not a multiple of the step.
template <class R>
STOPLINE_INLINE R delayed(const DelayRows& rows, const float* delayed_row, const float* older_row, int i) {
    const R sample = load<R>(delayed_row + i);
    return rows.older_share == 0.0 ? sample : rows.delayed_share * sample + rows.older_share * load<R>(older_row + i);
}

// Copies the vehicle in slot i of a lane to place k of the group. If R has several numbers, copies a batch of
// successive vehicles that begins with this vehicle.
template <class R>
STOPLINE_INLINE void gather_at(const FullStreams& s, const DelayRows& radar, const DelayRows& v2v, const LaneStep& lane,
                               int i, int k, double dt, const FullGroup& g) {
    const R speed = load<R>(s.speed + i);
    // Radar measurement of this step. If the radar has no delay, delayed() reads this measurement.
    store(s.gap_now + i, load_difference<R>(s.position + i - 1, s.position + i) - load<R>(s.length + i - 1));
    store(s.closing_now + i, speed - load<R>(s.speed + i - 1));
    // Delayed data about the leader.
    store(g.gap + k, delayed<R>(radar, s.gap_delayed, s.gap_older, i));
    store(g.closing + k, delayed<R>(radar, s.closing_delayed, s.closing_older, i));
    if (s.heard_acceleration != nullptr) {
        store(g.heard_acceleration + k, delayed<R>(v2v, s.heard_acceleration, s.heard_acceleration_older, i - 1));
        store(g.heard_request + k, delayed<R>(v2v, s.heard_request, s.heard_request_older, i - 1));
        store(g.heard_rate + k, delayed<R>(v2v, s.heard_rate, s.heard_rate_older, i - 1));
    }
    // Data of the lane.
    store(g.to_next_limit + k, load_difference<R>(lane.next_limit_m, s.position + i));
    store(g.limit + k, splat<R>(lane.limit_mps));
    store(g.sine + k, splat<R>(lane.sine));
    store(g.demand + k, splat<R>(kUnconstrained_mps2));
    // State of the vehicle.
    store(g.speed + k, speed);
    const auto copy_in = [&](const float* from, float* to) STOPLINE_INLINE_LAMBDA { store(to + k, load<R>(from + i)); };
    copy_in(s.end_speed, g.end_speed), copy_in(s.standstill_gap, g.standstill_gap);
    copy_in(s.acceleration, g.acceleration), copy_in(s.lag, g.lag), copy_in(s.request, g.request);
    copy_in(s.is_platoon_leader, g.is_platoon_leader), copy_in(s.torque, g.torque), copy_in(s.brake, g.brake);
    copy_in(s.gear_time, g.gear_time), copy_in(s.gear, g.gear);
    for (int j = 0; j < kWidthOf<R>; ++j) {
        g.coming_speed[k + j] = std::max(s.speed[i + j] + static_cast<double>(s.acceleration[i + j]) * dt, 0.0);
    }
    if (s.policy != nullptr) std::memcpy(g.policy + k, s.policy + i, kWidthOf<R> * sizeof(int));
    if (s.type != nullptr) std::memcpy(g.type + k, s.type + i, kWidthOf<R> * sizeof(int));
}

// Divides the vehicles of a lane into batches and calls treat(number, i) for each batch; i is the first slot of the
// batch. The type of `number` tells treat() the width of the batch. If R has 16 numbers or more and the last vehicles
// fit into half a batch, the last batch has half the width.
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

// Prefetches the data of the next group in portions, one portion during each batch of the current group. Loading thus
// overlaps with computing. The prefetcher of the hardware does not help, because the part of an array that belongs to
// one lane is too short.
class GroupPrefetch {
public:
    GroupPrefetch(const FullStreams& streams, const FullKernels::NextSlots& slots, int vehicles, int width)
        : slots_(slots), streams_(streams) {
        const auto batches = static_cast<std::size_t>((vehicles + width - 1) / width);
        slots_per_batch_ = slots.empty() ? 0 : (slots.size() + batches - 1) / batches;
    }

    // Prefetches a portion of the next group's positions, speeds and radar data. The driver kernel calls this function
    // during batch k.
    STOPLINE_INLINE void prefetch_driver_data(int k) const {
        for_each_slot(k, [&](int i) STOPLINE_INLINE_LAMBDA {
            const FullStreams& s = streams_;
            for (const double* stream : {s.position, s.speed}) {
                __builtin_prefetch(stream + i);
                __builtin_prefetch(stream + i + kSimdWidth / 2);
            }
            prefetch_lines(i, s.length, s.standstill_gap, s.end_speed, s.gap_now, s.gap_delayed, s.closing_now,
                           s.closing_delayed, s.is_platoon_leader);
        });
    }
    // Prefetches a portion of the next group's powertrain state and V2V messages. The vehicle kernel calls this
    // function during batch k.
    STOPLINE_INLINE void prefetch_vehicle_data(int k) const {
        for_each_slot(k, [&](int i) STOPLINE_INLINE_LAMBDA {
            const FullStreams& s = streams_;
            prefetch_lines(i, s.acceleration, s.lag, s.request, s.torque, s.brake, s.gear_time, s.gear);
            if (s.sent_request != nullptr) {
                prefetch_lines(i, s.sent_acceleration, s.sent_request, s.sent_rate, s.heard_acceleration,
                               s.heard_request, s.heard_rate);
            }
            if (s.policy != nullptr) prefetch_lines(i, s.policy);
            if (s.type != nullptr) prefetch_lines(i, s.type);
        });
    }

private:
    template <class... Streams>
    STOPLINE_INLINE static void prefetch_lines(int i, Streams... streams) {
        (__builtin_prefetch(streams + i), ...);
    }
    template <class Fetch>
    STOPLINE_INLINE void for_each_slot(int k, Fetch fetch) const {
        const std::size_t end = std::min(slots_.size(), (static_cast<std::size_t>(k) + 1) * slots_per_batch_);
        for (std::size_t j = static_cast<std::size_t>(k) * slots_per_batch_; j < end; ++j) fetch(slots_[j]);
    }

    FullKernels::NextSlots slots_;
    std::size_t slots_per_batch_ = 0;  // slots to prefetch during each batch
    FullStreams streams_;
};

template <class R>
void gather(const FullStreams& streams, const DelayRows& radar_rows, const DelayRows& v2v_rows, const LaneGroup& lanes,
            double dt, const FullGroup& group) {
    const FullStreams s = streams;  // local copies, so that the compiler knows that stores do not change them
    const FullGroup g = group;
    const DelayRows radar = radar_rows;
    const DelayRows v2v = v2v_rows;
    int first = 0;  // place of the lane's first vehicle in the group
    for (const LaneStep& lane : lanes.lanes) {
        const int slot_to_place = first - lane.begin;
        for_each_batch<R>(lane, [&](auto number, int i) STOPLINE_INLINE_LAMBDA {
            gather_at<decltype(number)>(s, radar, v2v, lane, i, i + slot_to_place, dt, g);
        });
        first += lane.stop - lane.begin;
    }
    for (const ExternalDemand& demand : lanes.demands) {
        g.demand[demand.index] = std::min(g.demand[demand.index], static_cast<float>(demand.acceleration_mps2));
    }
}

// Stores the requests of a batch of vehicles. The request is `smallest`, the lowest of the accelerations that apply,
// within the limits of jerk and maximum braking. Changes only vehicles with the driver `only`, or all vehicles if
// `only` is below 0.
template <class R>
STOPLINE_INLINE void store_request(const DriverTablesOf<float>& d, const FullGroup& g, double dt, int only, int k,
                                   const R& smallest, const R& is_platoon_leader) {
    const CaccSettingsOf<float>& c = d.cacc;
    const auto get = [k](const auto* array) STOPLINE_INLINE_LAMBDA { return load<R>(array + k); };
    const R speed = get(g.speed);
    const R last_request = get(g.request);
    const R rate = 1.0 / get(g.lag);
    const R smooth = clamped<R>(smallest, last_request - c.jerk_down_mps3 * dt, last_request + c.jerk_up_mps3 * dt);
    // The request of a stopped vehicle does not fall below 0. It thus rises from 0 when the vehicle starts.
    const R lowest = select(speed <= kBrakeHoldSpeed_mps, splat<R>(0.0), splat<R>(-c.deceleration_emergency_mps2));
    const R request = max_of(smooth, lowest);
    const R has_driver = only < 0 ? splat<R>(1.0) : STOPLINE_FLAG(R, get(g.driver) == only);
    const auto write = [&](float* array, const R& value) STOPLINE_INLINE_LAMBDA {
        store(array + k, only < 0 ? value : choose(has_driver, value, load<R>(array + k)));
    };
    write(g.request, request);
    // The request changes linearly within the step, so its mean is the average of the previous and the new request. For
    // a vehicle that is held by its brake, kHold_mps2 replaces this mean.
    const R held = STOPLINE_FLAG(R, speed <= kBrakeHoldSpeed_mps) * STOPLINE_FLAG(R, request <= kStart_mps2);
    write(g.mean_request, choose(held, splat<R>(kHold_mps2), 0.5 * (last_request + request)));
    write(g.is_platoon_leader, is_platoon_leader);
    write(g.sent_rate, rate);
}

// Computes the requested acceleration of the vehicle at place k of the group. If R has several numbers, computes the
// requests of a batch of successive vehicles that begins with this vehicle. Changes only vehicles with the driver
// `only`, or all vehicles if `only` is below 0.
template <class R>
STOPLINE_INLINE void plan_at(const DriverTablesOf<float>& d, const FullGroup& g, double dt, int only, int k) {
    const CaccSettingsOf<float>& c = d.cacc;
    const auto get = [k](const auto* array) STOPLINE_INLINE_LAMBDA { return load<R>(array + k); };
    const R speed = get(g.speed);
    const R acceleration = get(g.acceleration);
    const R lag = get(g.lag);
    const R last_request = get(g.request);
    const R limit = get(g.limit);
    const R rate = 1.0 / lag;
    LeaderView<R> p{};
    p.gap_m = get(g.gap);
    p.closing_mps = get(g.closing);
    p.acceleration_mps2 = get(g.heard_acceleration);
    p.request_mps2 = get(g.heard_request);
    p.rate_1ps = get(g.heard_rate);

    // Free driving.
    const R unconstrained = splat<R>(kUnconstrained_mps2);
    const R as_leader = free_acceleration(d, speed, closing_up_speed(c, limit, p));
    const R end_speed = get(g.end_speed);
    R slow_down = unconstrained;
    if (any(STOPLINE_FLAG(R, end_speed < kUnconstrained_mps2))) {
        slow_down = slow_down_acceleration(d, speed, end_speed, get(g.to_next_limit));
    }
    // Following.
    const R standstill_gap = get(g.standstill_gap);
    const R desired_gap = get(g.desired_gap);
    const R gap_growth_m = max_of(desired_gap - standstill_gap, 0.0);
    const R follow = follow_acceleration(c, speed, acceleration, lag, rate, last_request, desired_gap, gap_growth_m,
                                         get(g.slope), p, dt);
    const R emergency = min_of(emergency_acceleration(c, speed, p), keep_room_acceleration(c, speed, gap_growth_m, p));
    // Stopping behind a leader that is about to stop. Stops for a stop line or for yielding are already in g.demand.
    const R behind = stop_behind_acceleration(d, speed, standstill_gap, p);

    // The lowest acceleration applies. A platoon leader becomes a follower when the acceleration for following no
    // longer exceeds the acceleration in free driving.
    const R is_platoon_leader = get(g.is_platoon_leader) * STOPLINE_FLAG(R, follow > as_leader);
    const R drive = min_of(choose(is_platoon_leader, as_leader, catch_up_acceleration(d, speed, limit)), slow_down);
    const R smallest = min_of(min_of(min_of(drive, follow), emergency), min_of(get(g.demand), behind));
    store_request(d, g, dt, only, k, smallest, is_platoon_leader);
}

// Computes the requested acceleration of human drivers, as plan_at() does for automated vehicles. Human drivers have no
// V2V. FullGroup::interaction is their reaction to the vehicles ahead (human_perception.h). The intelligent driver
// model gives the acceleration in free driving and behind a leader. A platoon leader starts with the measured start-up
// profile instead.
template <class R>
STOPLINE_INLINE void plan_human_at(const DriverTablesOf<float>& d, const FullGroup& g, double dt, int only, int k) {
    const auto get = [k](const auto* array) STOPLINE_INLINE_LAMBDA { return load<R>(array + k); };
    const R speed = get(g.speed);
    const R limit = get(g.limit);
    const R unconstrained = splat<R>(kUnconstrained_mps2);
    const R interaction = get(g.interaction);
    const R a = splat<R>(static_cast<double>(d.human.acceleration_mps2));
    const R follow = choose(STOPLINE_FLAG(R, interaction > 0.0), a * (1.0 - interaction), unconstrained);
    const R idm = a * (1.0 - idm_free_term(speed, limit) - interaction);
    const R as_leader = free_acceleration(d, speed, limit);
    const R end_speed = get(g.end_speed);
    R slow_down = unconstrained;
    if (any(STOPLINE_FLAG(R, end_speed < kUnconstrained_mps2))) {
        slow_down = slow_down_acceleration(d, speed, end_speed, get(g.to_next_limit));
    }
    const R is_platoon_leader = get(g.is_platoon_leader) * STOPLINE_FLAG(R, follow > as_leader);
    const R drive = min_of(choose(is_platoon_leader, as_leader, idm), slow_down);
    store_request(d, g, dt, only, k, min_of(drive, get(g.demand)), is_platoon_leader);
}

// Computes the response of the powertrains for a batch of vehicles that begins at place k. Changes only vehicles of the
// type `only`, or all vehicles if `only` is below 0.
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
    const R has_type = only < 0 ? splat<R>(1.0) : STOPLINE_FLAG(R, get(g.type) == only);
    const auto write = [&](float* array, const R& after, const R& before) STOPLINE_INLINE_LAMBDA {
        store(array + k, only < 0 ? after : choose(has_type, after, before));
    };
    write(g.acceleration, next.acceleration_mps2, now.acceleration_mps2);
    write(g.torque, next.torque_Nm, now.torque_Nm);
    write(g.brake, next.brake_N, now.brake_N);
    write(g.gear_time, next.gear_time_s, now.gear_time_s);
    write(g.lag, next.lag_s, now.lag_s);
    write(g.gear, next.gear, now.gear);
    // The V2V message describes the end of this step, when the request takes effect. The follower adds the announced
    // request to its own. The message therefore announces no more acceleration than the engine can give; otherwise the
    // follower could run into this vehicle. `now.acceleration_mps2` is the mean over the previous step, so it belongs
    // to a time 1.5 steps before the end of this step. A first-order lag extrapolates it over these 1.5 steps.
    const R announced = min_of(get(g.request), next.available_mps2);
    const R reached = min_of(1.5 * dt * get(g.sent_rate), 1.0);
    const R acceleration = now.acceleration_mps2 + (announced - now.acceleration_mps2) * reached;
    write(g.sent_request, announced, get(g.sent_request));
    write(g.sent_acceleration, acceleration, get(g.sent_acceleration));
}

template <class R>
void plan(const DriverTablesOf<float>& d, const FullGroup& group, int vehicles, double dt, int only,
          const FullStreams& streams, FullKernels::NextSlots next) {
    const FullGroup g = group;
    const GroupPrefetch prefetch(streams, next, vehicles, kWidthOf<R>);
    for (int k = 0; k < vehicles; k += kWidthOf<R>) {
        prefetch.prefetch_driver_data(k / kWidthOf<R>);
        plan_at<R>(d, g, dt, only, k);
    }
}

template <class R>
void plan_human(const DriverTablesOf<float>& d, const FullGroup& group, int vehicles, double dt, int only,
                const FullStreams& streams, FullKernels::NextSlots next) {
    const FullGroup g = group;
    const GroupPrefetch prefetch(streams, next, vehicles, kWidthOf<R>);
    for (int k = 0; k < vehicles; k += kWidthOf<R>) {
        prefetch.prefetch_driver_data(k / kWidthOf<R>);
        plan_human_at<R>(d, g, dt, only, k);
    }
}

template <class R>
void drive(const PowertrainTablesOf<float>& t, const FullGroup& group, int vehicles, double dt, int only,
           const FullStreams& streams, FullKernels::NextSlots next) {
    const FullGroup g = group;
    const GroupPrefetch prefetch(streams, next, vehicles, kWidthOf<R>);
    for (int k = 0; k < vehicles; k += kWidthOf<R>) {
        prefetch.prefetch_vehicle_data(k / kWidthOf<R>);
        drive_at<R>(t, g, dt, only, k);
    }
}

template <class R>
void scatter(const FullStreams& streams, FullKernels::Lanes lanes, const FullGroup& group, double dt) {
    const FullStreams s = streams;
    const FullGroup g = group;
    int first = 0;
    for (const LaneStep& lane : lanes) {
        const int slot_to_place = first - lane.begin;
        for_each_batch<R>(lane, [&](auto number, int i) STOPLINE_INLINE_LAMBDA {
            const auto copy = [&](const float* from, float* to) STOPLINE_INLINE_LAMBDA {
                store(to + i, load<decltype(number)>(from + i + slot_to_place));
            };
            copy(g.request, s.request), copy(g.is_platoon_leader, s.is_platoon_leader),
                copy(g.acceleration, s.acceleration);
            copy(g.torque, s.torque), copy(g.brake, s.brake), copy(g.gear_time, s.gear_time);
            copy(g.lag, s.lag), copy(g.gear, s.gear);
            if (s.sent_request == nullptr) return;
            copy(g.sent_request, s.sent_request), copy(g.sent_acceleration, s.sent_acceleration);
            copy(g.sent_rate, s.sent_rate);
        });
        // Speed and position follow from the acceleration that the powertrain realised in the step.
        for (int i = lane.begin; i < lane.stop; ++i) {
            const double speed_before = s.speed[i];
            const double speed_after = speed_before + static_cast<double>(s.acceleration[i]) * dt;
            s.speed[i] = speed_after > kSpeedRounding_mps ? speed_after : 0.0;
            s.position[i] += 0.5 * (speed_before + s.speed[i]) * dt;
        }
        first += lane.stop - lane.begin;
    }
}

template <class R>
constexpr FullKernels kernels_of(const char* name) {
    return {name, gather<R>, list_due<R>, receive<R>, plan<R>, plan_human<R>, drive<R>, scatter<R>};
}

}  // namespace

}  // namespace stopline
