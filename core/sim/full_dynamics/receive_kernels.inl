// Source of the receive kernels, included by full_kernels.inl.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "base/simd/arithmetic.h"
#include "base/speed_thresholds.h"
#include "sim/full_dynamics/full_kernels.h"
#include "v2v/fallback.h"

namespace stopline {

namespace {

// Returns the differences between a tick and the ticks in memory. They are exact up to 2^24.
template <class R>
STOPLINE_INLINE R ticks_since(int tick, const int* before) {
    constexpr int kWidth = kWidthOf<R>;
    if constexpr (kWidth == 1) {
        return packed<1>(static_cast<float>(tick - *before));
    } else {
        const auto numbers = tick - packed_details::read<Vector<std::int32_t, kWidth>>(before);
        return packed<kWidth>(__builtin_convertvector(numbers, Vector<float, kWidth>));
    }
}

template <class R>
STOPLINE_INLINE void store_wide(double* to, const R& value) {
    constexpr int kWidth = kWidthOf<R>;
    if constexpr (kWidth == 1) {
        *to = static_cast<double>(value.v);
    } else {
        const auto numbers = __builtin_convertvector(value.v, Vector<double, kWidth>);
        std::memcpy(to, &numbers, sizeof numbers);
    }
}

// Returns table[index] for each element of `index`, which must hold whole numbers. Precondition: the number of entries
// is a multiple of kSimdWidth. look_up() is for short tables.
template <class R>
STOPLINE_INLINE R look_up_long(std::span<const float> table, const R& index) {
    constexpr int kWidth = kWidthOf<R>;
    if constexpr (kWidth == 1) {
        return packed<1>(table[static_cast<std::size_t>(index.v)]);
    } else {
        const auto k = __builtin_convertvector(index.v, Vector<std::int32_t, kWidth>);
        Vector<float, kWidth> found{};
#if defined(__AVX2__) && !defined(__clang__)
        // A permutation takes indices modulo kWidth.
        for (std::size_t from = 0; from < table.size(); from += kWidth) {
            const auto entries = packed_details::read<Vector<float, kWidth>>(table.data() + from);
            found = k >= static_cast<std::int32_t>(from) ? __builtin_shuffle(entries, k) : found;
        }
#else
        for (int n = 0; n < kWidth; ++n) found[n] = table[static_cast<std::size_t>(k[n])];
#endif
        return packed<kWidth>(found);
    }
}

// A batch of vehicles in the receive phase.
template <class R>
class ReceiveBatch {
public:
    // `i`: first slot, `k`: first place in the group, `count`: number of vehicles that belong to the lane.
    STOPLINE_INLINE ReceiveBatch(const ReceiveStep& step, const ReceiveStreams& streams, const FullGroup& group, int i,
                                 int k, int count)
        : step_(step), s_(streams), g_(group), i_(i), k_(k) {
        set_policy();
        if (count < kWidthOf<R>)
            has_radio_ =
                choose(STOPLINE_FLAG(R, counting_from<R>(0) < static_cast<double>(count)), has_radio_, splat<R>(0.0));
        has_leader_ = choose(STOPLINE_FLAG(R, of_slot(s_.sender) >= splat<R>(0.0)), has_radio_, splat<R>(0.0));
        speed_ = of_place(g_.speed);
        closing_ = of_place(g_.closing);
    }

    STOPLINE_INLINE void receive(ReceiveResults& results) {
        estimate_leader();
        const R age = ticks_since<R>(step_.tick, s_.sent_tick + i_);
        count_modes(results);
        hear(age);
        update_gap(age, results.mini_leader);
        keep_gap();
        keep_room();
    }

private:
    template <class Number>
    STOPLINE_INLINE R of_slot(const Number* array) const {
        return load<R>(array + i_);
    }
    template <class Number>
    STOPLINE_INLINE R of_place(const Number* array) const {
        return load<R>(array + k_);
    }
    STOPLINE_INLINE void set_slot(float* array, const R& flag, const R& value) const {
        store(array + i_, choose(flag, value, of_slot(array)));
    }
    STOPLINE_INLINE void set_place(float* array, const R& flag, const R& value) const {
        store(array + k_, choose(flag, value, of_place(array)));
    }

    STOPLINE_INLINE void set_policy() {
        const ReceivePolicy& first = step_.policies[0];
        has_radio_ = splat<R>(first.has_radio);
        response_s_ = splat<R>(first.response_s);
        margin_m_ = splat<R>(first.margin_m);
        radar_delay_s_ = splat<R>(first.radar_delay_s);
        emergency_mps2_ = splat<R>(first.emergency_mps2);
        if (step_.policies.size() == 1) return;
        const R policy = of_place(g_.policy);
        for (std::size_t n = 1; n < step_.policies.size(); ++n) {
            const ReceivePolicy& values = step_.policies[n];
            const R is_own = STOPLINE_FLAG(R, policy == splat<R>(static_cast<double>(n)));
            has_radio_ = choose(is_own, splat<R>(values.has_radio), has_radio_);
            response_s_ = choose(is_own, splat<R>(values.response_s), response_s_);
            margin_m_ = choose(is_own, splat<R>(values.margin_m), margin_m_);
            radar_delay_s_ = choose(is_own, splat<R>(values.radar_delay_s), radar_delay_s_);
            emergency_mps2_ = choose(is_own, splat<R>(values.emergency_mps2), emergency_mps2_);
        }
    }

    STOPLINE_INLINE void estimate_leader() {
        LeaderEstimateOf<R> estimate{of_slot(s_.leader_speed), of_slot(s_.leader_acceleration)};
        update_estimate(step_.filter, R(of_slot(s_.own_speed_delayed) - closing_), estimate);
        set_slot(s_.leader_speed, has_leader_, estimate.speed_mps);
        set_slot(s_.leader_acceleration, has_leader_, estimate.acceleration_mps2);
        seen_ = estimate.acceleration_mps2;
    }

    // Counts the vehicles in the driving modes. Most batches have only vehicles with recent messages.
    STOPLINE_INLINE void count_modes(ReceiveResults& results) {
        mode_ = of_slot(s_.mode);
        const std::uint32_t with_leader = bits_of(has_leader_);
        results.mode_steps[0] += std::popcount(with_leader);
        misses_ = any(R(has_leader_ * mode_));
        if (!misses_) return;
        for (std::size_t mode = 1; mode <= kLongestAge_s.size(); ++mode) {
            const R is_in = STOPLINE_FLAG(R, mode_ == splat<R>(static_cast<double>(mode)));
            const int vehicles = std::popcount(bits_of(is_in) & with_leader);
            results.mode_steps[mode] += vehicles;
            results.mode_steps[0] -= vehicles;
        }
    }

    // Determines what the vehicles know about the acceleration of their leaders: the newest message, extrapolated to
    // the present, or the estimate from radar.
    STOPLINE_INLINE void hear(const R& age) {
        constexpr double kClearly_mps2 = 1.0;  // twice the noise of the estimate
        const R zero = splat<R>(0.0);
        const R beyond_s = (age - step_.delay_ticks) * step_.step_s;
        R request = of_slot(s_.request);
        R rate = of_slot(s_.rate);
        // 1 / (1 + x + x^2 / 2) instead of exp(-x): the error is below 0.02 up to x = 1, and the result also tends to
        // 0.
        const R x = beyond_s * rate;
        const R growth = x * (1.0 + 0.5 * x);
        const R sent = of_slot(s_.acceleration);
        R acceleration = sent + (request - sent) * (growth / (1.0 + growth));
        R by_radar = zero;
        if (misses_) {
            by_radar = STOPLINE_FLAG(R, mode_ > splat<R>(number_of(V2vMode::old_messages)));
            const R seen = choose(STOPLINE_FLAG(R, mode_ > splat<R>(number_of(V2vMode::radar))), zero, seen_);
            request = choose(by_radar, seen, request);
            acceleration = choose(by_radar, seen, acceleration);
        }
        // Radar overrides a message if it shows that the leader brakes clearly harder than the message says.
        const R brakes = STOPLINE_FLAG(R, seen_ < min_of(acceleration, request) - kClearly_mps2);
        acceleration = choose(brakes, seen_, acceleration);
        request = choose(brakes, seen_, request);
        rate = choose(max_of(by_radar, brakes), splat<R>(1.0), rate);  // without effect: request and acceleration agree
        heard_ = acceleration;
        // A vehicle without a leader hears nothing. The elements after the last vehicle of the lane are set later.
        store(g_.heard_acceleration + k_, choose(has_leader_, acceleration, zero));
        store(g_.heard_request + k_, choose(has_leader_, request, zero));
        store(g_.heard_rate + k_, choose(has_leader_, rate, splat<R>(1.0)));
    }

    // Returns the time gaps that the modes demand.
    STOPLINE_INLINE R target_time_gap(const R& age) const {
        const auto in_mode = [&](V2vMode mode) STOPLINE_INLINE_LAMBDA {
            return STOPLINE_FLAG(R, mode_ == splat<R>(number_of(mode)));
        };
        R target = choose(in_mode(V2vMode::radar), splat<R>(step_.radar_time_gap_s), splat<R>(0.0));
        target = choose(in_mode(V2vMode::acc), splat<R>(step_.acc_time_gap_s), target);
        const R has_old = has_leader_ * in_mode(V2vMode::old_messages);
        if (any(has_old)) {
            const auto last = static_cast<double>(step_.stable_time_gap_s.size() - 1);
            const R ticks = clamped(age, splat<R>(0.0), splat<R>(last));
            target = choose(has_old, look_up_long(step_.stable_time_gap_s, ticks), target);
        }
        return has_leader_ * target;
    }

    // Updates the time gaps. A vehicle at rest does not start on an old message: it stays until radar shows that its
    // leader drives off.
    STOPLINE_INLINE void update_gap(const R& age, const float* mini_leader) {
        constexpr double kDrivesOff_mps = 0.1;  // six times the noise of the radar
        const R zero = splat<R>(0.0);
        R target = zero;
        const R is_held = STOPLINE_FLAG(R, speed_ <= splat<R>(kBrakeHoldSpeed_mps));
        if (misses_) {
            target = target_time_gap(age);
            const R stays = has_leader_ * STOPLINE_FLAG(R, mode_ > zero) * is_held *
                            STOPLINE_FLAG(R, closing_ > splat<R>(-kDrivesOff_mps));
            set_place(g_.demand, stays, min_of(of_place(g_.demand), zero));
        }
        // The leader of a mini-platoon keeps a time gap only while it drives. From rest it starts like all others.
        if (mini_leader != nullptr) {
            const R keeps = has_leader_ * load<R>(mini_leader + k_) * (1.0 - is_held);
            target = max_of(target, R(keeps * step_.platoon_time_gap_s));
        }
        TimeGapOf<R> gap{of_slot(s_.time_gap), of_slot(s_.time_gap_rate)};
        has_gap_ = any(has_radio_ * STOPLINE_FLAG(R, max_of(target, gap.time_gap_s) > zero));
        if (!has_gap_) return;
        update_time_gap(gap, target, speed_, step_.step_s);
        set_slot(s_.time_gap, has_radio_, gap.time_gap_s);
        set_slot(s_.time_gap_rate, has_radio_, gap.rate);
        time_gap_s_ = gap.time_gap_s;
    }

    // Enlarges the desired gaps to the response gaps, and to the standstill gaps plus the time gaps times the speed.
    STOPLINE_INLINE void keep_gap() const {
        const R coming = of_place(g_.coming_speed);
        R desired = of_place(g_.desired_gap);
        R slope = of_place(g_.slope);
        const auto enlarge = [&](const R& gap_m, const R& slope_s, const R& flag) STOPLINE_INLINE_LAMBDA {
            const R is_larger = flag * STOPLINE_FLAG(R, gap_m > desired);
            desired = choose(is_larger, gap_m, desired);
            slope = choose(is_larger, slope_s, slope);
        };
        enlarge(margin_m_ + response_s_ * coming, response_s_, has_leader_);
        if (has_gap_) {
            const R has_gap = has_leader_ * STOPLINE_FLAG(R, time_gap_s_ > splat<R>(0.0));
            enlarge(of_place(g_.standstill_gap) + time_gap_s_ * coming, time_gap_s_, has_gap);
        }
        store_wide(g_.desired_gap + k_, desired);
        store_wide(g_.slope + k_, slope);
    }

    // Limits the speed at which a vehicle closes up to its leader. The vehicle can then still respond to full braking
    // of its leader after T = response_time_s(): v^2 <= v_l^2 + 2 b (gap - reserve - T v), with the speed v_l of the
    // leader and the maximum braking b. A faster vehicle brakes by the law of keep_room_acceleration(). The following
    // law keeps more than this reserve, so it alone acts in equilibrium.
    STOPLINE_INLINE void keep_room() const {
        constexpr double kSpeedGain_1ps = 2.0;
        const R zero = splat<R>(0.0);
        const R b = emergency_mps2_;
        const R leader_mps = max_of(R(speed_ - closing_), zero);
        const R reserve_m = 0.5 * margin_m_ + response_s_ * speed_;
        const R room_m = max_of(R(of_place(g_.gap) - radar_delay_s_ * closing_ - reserve_m), zero);
        const R safe_squared = leader_mps * leader_mps + 2.0 * b * room_m;
        const R is_fast =
            has_leader_ * STOPLINE_FLAG(R, closing_ > zero) * STOPLINE_FLAG(R, speed_ * speed_ > safe_squared);
        if (!any(is_fast)) return;
        const R safe_mps = square_root(safe_squared);
        const R leader_mps2 = min_of(heard_, zero);
        const R along_mps2 = (leader_mps * leader_mps2 - b * closing_) / max_of(safe_mps, splat<R>(1.0));
        const R demand_mps2 = max_of(R(along_mps2 + kSpeedGain_1ps * (safe_mps - speed_)), R(-b));
        set_place(g_.demand, is_fast, min_of(of_place(g_.demand), demand_mps2));
    }

    const ReceiveStep& step_;
    const ReceiveStreams& s_;
    const FullGroup& g_;
    int i_;
    int k_;
    bool misses_ = false;   // a vehicle of the batch has no recent message
    bool has_gap_ = false;  // a vehicle of the batch has a time gap
    R has_radio_, has_leader_;
    R response_s_, margin_m_, radar_delay_s_, emergency_mps2_;
    R speed_, closing_;
    R seen_;   // estimated acceleration of the leader
    R heard_;  // heard acceleration of the leader
    R mode_;
    R time_gap_s_ = splat<R>(0.0);
};

constexpr int kListBlock = 16;  // number of slots that are tested at once
using ListBlock = Vector<std::int32_t, kListBlock>;

// Appends to a list each of the `count` slots from `slot` on that has the flag -1. Returns the end of the list. Writes
// up to kListBlock numbers.
STOPLINE_INLINE int* append_slots(int* list, int slot, int count, const ListBlock& flags) {
#if defined(__AVX512F__)
    __m512i numbers;
    std::memcpy(&numbers, &flags, sizeof numbers);
    const auto all = static_cast<__mmask16>(count < kListBlock ? (1U << static_cast<unsigned>(count)) - 1U : 0xFFFFU);
    const __mmask16 mask = _mm512_mask_test_epi32_mask(all, numbers, numbers);
    const __m512i first = _mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    const __m512i slots = _mm512_add_epi32(first, _mm512_set1_epi32(slot));
    _mm512_storeu_si512(list, _mm512_maskz_compress_epi32(mask, slots));
    return list + std::popcount(static_cast<unsigned>(mask));
#else
    std::array<std::int32_t, kListBlock> numbers{};
    std::memcpy(numbers.data(), &flags, sizeof flags);
    for (int k = 0; k < std::min(count, kListBlock); ++k) {
        *list = slot + k;
        list -= numbers[static_cast<std::size_t>(k)];
    }
    return list;
#endif
}

// Stores the own speeds. Lists the vehicles with something to receive, and those that send (ReceiveWork).
template <class R>
void list_due(const ReceiveStreams& streams, FullKernels::Lanes lanes, int tick, const FullGroup& group,
              const ReceiveLists& lists) {
    using packed_details::read;
    const ReceiveStreams s = streams;
    const ReceiveLists to = lists;
    int* due = to.due;
    int* senders = to.senders;
    const float* speed = group.speed;
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
        const LaneStep& slots = lanes[lane];
        for (int i = slots.begin; i < slots.stop; i += kListBlock) {
            const int count = slots.stop - i;
            // The kernel `receive` reads these arrays next.
            for (const float* array : {s.acceleration, s.request, s.rate, s.own_speed_delayed}) {
                __builtin_prefetch(array + i);
            }
            for (const int* array : {s.sent_tick, s.mode}) __builtin_prefetch(array + i);
            for (const float* array : {s.leader_speed, s.leader_acceleration, s.time_gap, s.time_gap_rate}) {
                __builtin_prefetch(array + i, 1);
            }
            std::memcpy(s.own_speed_now + i, speed + i - slots.begin, kListBlock * sizeof(float));
            due = append_slots(due, i, count,
                               ListBlock((read<ListBlock>(s.id + i - 1) != read<ListBlock>(s.sender + i)) |
                                         (read<ListBlock>(s.due_tick + i) <= tick)));
            senders = append_slots(senders, i, count, ListBlock(read<ListBlock>(s.send_tick + i) <= tick));
        }
        to.due_end[lane] = static_cast<int>(due - to.due);
        to.senders_end[lane] = static_cast<int>(senders - to.senders);
        speed += slots.count();
    }
}

template <class R>
void receive(const ReceiveStep& common, const ReceiveStreams& streams, FullKernels::Lanes lanes, const FullGroup& group,
             ReceiveResults& all_results) {
    const ReceiveStep step = common;
    const ReceiveStreams s = streams;
    const FullGroup g = group;
    ReceiveResults results = all_results;
    int place = 0;
    for (const LaneStep& lane : lanes) {
        for (int i = lane.begin; i < lane.stop; i += kWidthOf<R>) {
            ReceiveBatch<R> batch(step, s, g, i, place + i - lane.begin, lane.stop - i);
            batch.receive(results);
        }
        place += lane.count();
    }
    all_results = results;
}

}  // namespace

}  // namespace stopline
