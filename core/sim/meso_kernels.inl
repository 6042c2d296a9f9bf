// The kernels' text. Included by one file for each build, each in a namespace of its own. R is what the equations are evaluated with: as
// many doubles as a block has slots, or one.
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "base/arithmetic.h"
#include "base/random.h"
#include "base/simd.h"
#include "sim/meso_kernels.h"
#include "sim/vehicle_arrays.h"

namespace stopline {

namespace {

// As many doubles as a register holds: a block.
constexpr int kWide = kBatchWidth / 2;
using Wide = PackedOf<double, kWide>;
using Words = Vector<std::uint64_t, kWide>;

template <class To, class From>
STOPLINE_INLINE To same_bits(const From& from) {
    To to;
    static_assert(sizeof to == sizeof from);
    std::memcpy(&to, &from, sizeof to);
    return to;
}

// To as many numbers of another type. The compiler would convert registers of 512 bits in halves.
template <class To, class From>
STOPLINE_INLINE Vector<To, kWide> converted(const Vector<From, kWide>& from) {
#if defined(__AVX512F__)
    constexpr __mmask8 kAll = 0xff;  // g++ warns of the functions without a mask
    if constexpr (kWide == 8 && std::is_same_v<From, float> && std::is_same_v<To, double>) {
        return same_bits<Vector<To, kWide>>(_mm512_maskz_cvtps_pd(kAll, same_bits<__m256>(from)));
    } else if constexpr (kWide == 8 && std::is_same_v<From, double> && std::is_same_v<To, float>) {
        return same_bits<Vector<To, kWide>>(_mm512_maskz_cvtpd_ps(kAll, same_bits<__m512d>(from)));
    } else if constexpr (kWide == 8 && std::is_same_v<From, int> && std::is_same_v<To, double>) {
        return same_bits<Vector<To, kWide>>(_mm512_maskz_cvtepi32_pd(kAll, same_bits<__m256i>(from)));
    } else if constexpr (kWide == 8 && std::is_same_v<From, int> && std::is_same_v<To, std::int64_t>) {
        return same_bits<Vector<To, kWide>>(_mm512_maskz_cvtepi32_epi64(kAll, same_bits<__m256i>(from)));
    }
#endif
    return __builtin_convertvector(from, Vector<To, kWide>);
}

// Slots from `from` on, as R.
template <class R, class Stored>
STOPLINE_INLINE R get(const Stored* from) {
    if constexpr (std::is_same_v<R, double>) {
        return *from;
    } else {
        Vector<Stored, kWide> values;
        std::memcpy(&values, from, sizeof values);
        return packed<kWide>(converted<double, Stored>(values));
    }
}
template <class Stored>
STOPLINE_INLINE void put(Stored* to, double value) {
    *to = static_cast<Stored>(value);
}
template <class Stored>
STOPLINE_INLINE void put(Stored* to, const Wide& value) {
    const auto values = converted<Stored, double>(value.v);
    std::memcpy(to, &values, sizeof values);
}

// In [0, 1), one for each vehicle.
template <class R>
STOPLINE_INLINE R dawdle(const MesoStep& t, const int* id) {
    if constexpr (std::is_same_v<R, double>) {
        return dawdle_uniform(t.key, *id, t.tick);
    } else {
        Vector<int, kWide> ids;
        std::memcpy(&ids, id, sizeof ids);
        const Words bits = dawdle_bits(t.key, same_bits<Words>(converted<std::int64_t, int>(ids)), t.tick);
        return packed<kWide>(same_bits<Vector<double, kWide>>(bits)) - 1.0;
    }
}

// In which slots there is a vehicle.
template <class R>
STOPLINE_INLINE auto are_there(const int* id) {
    if constexpr (std::is_same_v<R, double>) {
        return *id >= 0;
    } else {
        Vector<int, kWide> ids;
        std::memcpy(&ids, id, sizeof ids);
        return typename R::Mask{converted<std::int64_t, int>(ids) >= 0};
    }
}

// Each vehicle's of two policies.
template <class R>
STOPLINE_INLINE KraussSideBySide<R> of_two(const R& policy, const Krauss& a, const Krauss& b) {
    const auto second = policy > 0.0;
    const auto of = [&](double first, double other)
                        STOPLINE_INLINE_LAMBDA { return select(second, R(other), R(first)); };
    return {of(a.acceleration_mps2, b.acceleration_mps2),
            of(a.until_mps, b.until_mps),
            of(a.transient_gap_s2, b.transient_gap_s2),
            of(a.catch_up, b.catch_up),
            of(a.tracking, b.tracking),
            of(a.anticipation_s, b.anticipation_s),
            of(a.deceleration_mps2, b.deceleration_mps2),
            of(a.reaction_s, b.reaction_s),
            of(a.standstill_gap_m, b.standstill_gap_m),
            of(a.dawdling, b.dawdling),
            of(a.constant_distance ? 1.0 : 0.0, b.constant_distance ? 1.0 : 0.0) > 0.5,
            of(a.band_m, b.band_m),
            of(a.below_band, b.below_band)};
}

// The speed of the next step on the way to a limit: at once where that is lower, else a share of what is missing.
template <class R>
STOPLINE_INLINE R approached(const R& speed_mps, const R& limit_mps, double share) {
    const R gaining_mps = speed_mps + share * (limit_mps - speed_mps);
    return lesser(gaining_mps, limit_mps);  // faster than allowed: share <= 1, so that gaining is no less
}

// The same on the way to a turn, whose allowed speed falls with the distance: slow_down_acceleration of full dynamics.
template <class R>
STOPLINE_INLINE R slowed(const R& speed_mps, const R& allowed_mps, double share, double braked_mps) {
    return speed_mps + share * (allowed_mps - speed_mps) - braked_mps * speed_mps / greater(allowed_mps, R(1.0));
}

// Whether a float is other than `value` for any of the vehicles.
template <class R>
STOPLINE_INLINE bool any_other(const float* floats, float value) {
    if constexpr (std::is_same_v<R, double>) {
        return *floats != value;
    } else {
#if defined(__AVX512VL__)
        if constexpr (kWide == 8) {
            __m256i all;
            std::memcpy(&all, floats, sizeof all);
            return _mm256_cmpneq_epi32_mask(all, _mm256_set1_epi32(std::bit_cast<int>(value))) != 0;
        }
#endif
        const auto bits = std::bit_cast<std::uint32_t>(value);
        std::uint32_t all[kWide];
        std::memcpy(all, floats, sizeof all);
        std::uint32_t others = 0;
        for (const std::uint32_t each : all) others |= each ^ bits;
        return others != 0;
    }
}

// The highest speed that limits allow.
template <class R, bool at_once>
STOPLINE_INLINE R allowed_mps(const MesoStreams& s, const MesoStep& t, int i, const R& position, const R& speed) {
    const R here_mps = lesser(approached(speed, get<R>(s.limit + i), t.approach_share), get<R>(s.imposed + i));
    if (!any_other<R>(s.end_speed + i, kNoLowerLimit_mps)) return here_mps;
    // Towards a lower limit at the end of the lane: v^2 = v_end^2 + 2 b distance.
    const R end_mps = get<R>(s.end_speed + i);
    const R to_turn_m = greater(R(get<R>(s.turn + i) - position), R(0.0));
    const R slow_mps = square_root(end_mps * end_mps + 2.0 * t.slow_down_mps2 * to_turn_m);
    R turn_mps = slow_mps;
    if constexpr (!at_once) turn_mps = slowed(speed, slow_mps, t.turn_share, t.slow_down_mps2 * t.dt);
    return select(end_mps < static_cast<double>(kNoLowerLimit_mps), lesser(here_mps, turn_mps), here_mps);
}

constexpr double kAlone_m = 1e5;  // a gap without predecessor is longer

#if defined(__AVX512DQ__)
// The same values without a load for each vehicle: 16 at a time are permuted.
template <std::size_t bins>
STOPLINE_INLINE Wide in_table(const std::array<double, bins>& table, const Wide& bin) {
    const __m512i index = _mm512_cvttpd_epi64(same_bits<__m512d>(bin));
    const auto of_16 = [&](std::size_t from) STOPLINE_INLINE_LAMBDA {
        const double* const some = table.data() + from;
        return _mm512_permutex2var_pd(_mm512_loadu_pd(some), index, _mm512_loadu_pd(some + 8));
    };
    __m512d values = of_16(0);
    for (std::size_t from = 16; from < bins; from += 16) {
        const __mmask8 there = _mm512_cmpge_epi64_mask(index, _mm512_set1_epi64(static_cast<long long>(from)));
        values = _mm512_mask_mov_pd(values, there, of_16(from));
    }
    return packed<kWide>(same_bits<Vector<double, kWide>>(values));
}
#endif

// What a table holds for each vehicle's bin.
template <class R, std::size_t bins>
STOPLINE_INLINE R in_bin(const std::array<double, bins>& table, const R& bin) {
    const R within = limited(bin, 0.0, static_cast<double>(bins) - 1.0);
    if constexpr (std::is_same_v<R, double>) {
        return table[static_cast<std::size_t>(within)];
    } else {
#if defined(__AVX512DQ__)
        if constexpr (kWide == 8 && bins % 16 == 0) return in_table(table, within);
#endif
        R values = 0.0;
        for (int j = 0; j < kWide; ++j) values.v[j] = table[static_cast<std::size_t>(within.v[j])];
        return values;
    }
}

// The acceleration of a platoon's leader at a speed.
template <class R>
STOPLINE_INLINE R leading_mps2(const MesoStep& t, const R& speed_mps) {
    if (t.leader_profile != nullptr) {
        // In the middle of the step: from its beginning, gear changes would be jumped over.
        const LeaderProfile& profile = *t.leader_profile;
        const R first_mps2 = in_bin(profile.acceleration_mps2, R(speed_mps * profile.bins_per_mps));
        const R middle_mps = speed_mps + first_mps2 * (0.5 * t.dt);
        return in_bin(profile.acceleration_mps2, R(middle_mps * profile.bins_per_mps));
    }
    return t.leader_mps2 * R(t.leader_until_mps / greater(speed_mps, R(t.leader_until_mps)));
}

// Leaders of platoons accelerate alike, whatever their policy, until following asks for less. One that stands goes on leading
// until it moves. `foreseen_mps`: foreseen_safe_mps; `next`: what the others do; `mine`: 1 for those that are treated.
template <class R, class Model>
STOPLINE_INLINE R lead(const Model& k, const MesoStep& t, const KraussInputOf<R>& in, const R& foreseen_mps,
                       const R& next, const R& mine, float* leads) {
    const R faster_mps = in.speed_mps + leading_mps2(t, in.speed_mps) * t.dt;
    const R touch_mps = greater(in.gap_m, R(0.0)) * (1.0 / t.dt);
    R own_mps = foreseen_mps;
    if (!t.leads_foreseeing) {
        own_mps = t.relays ? foreseen_safe_mps(k, in, in.more_m) : safe_speed_mps(k, in.gap_m, in.ahead_mps, in.more_m);
    }
    const R safe_mps = lesser(own_mps, touch_mps);
    const R follows_mps = select(in.gap_m > kAlone_m, touch_mps, safe_mps);
    const R leading = at_rest(lesser(follows_mps, lesser(faster_mps, in.cap_mps)));
    const R led = get<R>(leads);
    const R ends = STOPLINE_FLAG(R, follows_mps < faster_mps) * STOPLINE_FLAG(R, leading > 0.0) * mine;
    put(leads, led * (1.0 - ends));
    return choose(R(led * mine), leading, next);
}

constexpr double kNoMore[kWide] = {};

// Returns how many overlap who is ahead, for each place in R.
template <class R, int policies, bool power_limit, bool at_once>
STOPLINE_INLINE R step_slots(const MesoStreams& s, int i, std::span<const Krauss> models, const double* more,
                             const MesoStep& t) {
    const R position = get<R>(s.position + i);
    const R speed = get<R>(s.speed + i);
    const KraussInputOf<R> in{speed,
                              get<R>(s.position + i - 1) - get<R>(s.length + i - 1) - position,
                              get<R>(s.speed + i - 1),
                              greater(get<R>(s.acceleration + i - 1), R(0.0)),
                              get<R>(more),
                              allowed_mps<R, at_once>(s, t, i, position, speed)};
    const R random = dawdle<R>(t, s.id + i);
    const bool leaders = (t.leader_mps2 > 0.0 || t.leader_profile != nullptr) && any_other<R>(s.leads + i, 0.0F);
    const R policy = get<R>(s.policy + i);
    R next = speed;
    const auto drive = [&](const auto& model, const R& mine) STOPLINE_INLINE_LAMBDA {
        const R safe_mps = foreseen_safe_mps(model, in);
        const R lowest_mps = in.speed_mps - t.hardest_mps2 * t.dt;
        R following = speed_after_mps<power_limit>(model, in, safe_mps, random, t.dt, lowest_mps);
        if (leaders) following = lead(model, t, in, safe_mps, following, mine, s.leads + i);
        return following;
    };
    if constexpr (policies == 1) {
        next = drive(models[0], R(1.0));
    } else if constexpr (policies == 2) {
        next = drive(of_two(policy, models[0], models[1]), R(1.0));
    } else {
        for (std::size_t k = 0; k < models.size(); ++k) {
            const R mine = STOPLINE_FLAG(R, policy == static_cast<double>(k));
            next = choose(mine, drive(models[k], mine), next);
        }
    }
    constexpr double kRounding_m = 1e-6;
    const auto there = are_there<R>(s.id + i);
    put(s.acceleration + i, select(there, R((next - speed) * (1.0 / t.dt)), get<R>(s.acceleration + i)));
    put(s.speed + i, select(there, next, speed));
    put(s.position + i, select(there, R(position + next * t.dt), position));
    return select(there, STOPLINE_FLAG(R, in.gap_m < -kRounding_m), R(0.0));
}

STOPLINE_INLINE double sum(double value) { return value; }
STOPLINE_INLINE double sum(const Wide& values) {
    double all = 0.0;
    for (int j = 0; j < kWide; ++j) all += values.v[j];
    return all;
}

STOPLINE_INLINE void fetch(const MesoStreams& s, int i) {
    for (const double* const stream :
         {static_cast<const double*>(s.position), static_cast<const double*>(s.speed), s.limit, s.turn, s.imposed}) {
        __builtin_prefetch(stream + i);
    }
    for (const float* const stream :
         {s.length, s.end_speed, static_cast<const float*>(s.acceleration), static_cast<const float*>(s.leads)}) {
        __builtin_prefetch(stream + i);
    }
    for (const int* const stream : {s.id, s.policy}) __builtin_prefetch(stream + i);
}

// From the last block to the first: a block's vehicles react to the last one of the block before, as it was.
template <class R, int policies, bool power_limit, bool at_once>
inline int step_blocks(const MesoStreams& streams, std::span<const int> blocks, std::span<const Krauss> models,
                       MesoMore all_more, const MesoStep& step) {
    constexpr int kSize = std::is_same_v<R, double> ? 1 : kWide;
    const MesoStreams s = streams;  // own copies: nothing that is written here can change them
    const MesoStep t = step;
    R overlaps = 0.0;
    constexpr std::size_t kAhead = 8;
    for (std::size_t n = blocks.size(); n-- > 0;) {
        if (t.fetches && n >= kAhead) fetch(s, blocks[n - kAhead] * kSize);
        const double* const more = all_more == nullptr ? kNoMore : all_more + n * kSize;
        overlaps += step_slots<R, policies, power_limit, at_once>(s, blocks[n] * kSize, models, more, t);
    }
    return static_cast<int>(sum(overlaps));
}

template <class R>
inline void follow(const Krauss& krauss, const MesoStep& step, const KraussInputOf<const double*>& in,
                   std::span<const int> ids, double* next_mps) {
    constexpr std::size_t kSize = std::is_same_v<R, double> ? 1 : kWide;
    const Krauss k = krauss;
    const MesoStep t = step;
    for (std::size_t i = 0; i < ids.size(); i += kSize) {
        const KraussInputOf<R> one{get<R>(in.speed_mps + i),  get<R>(in.gap_m + i),  get<R>(in.ahead_mps + i),
                                   get<R>(in.ahead_mps2 + i), get<R>(in.more_m + i), get<R>(in.cap_mps + i)};
        const R safe_mps = foreseen_safe_mps(k, one);
        put(next_mps + i, speed_after_mps<true>(k, one, safe_mps, dawdle<R>(t, ids.data() + i), t.dt));
    }
}

template <class R>
inline int step(const MesoStreams& streams, std::span<const int> blocks, std::span<const Krauss> models, MesoMore more,
                const MesoStep& t) {
    const bool power_limit = std::any_of(models.begin(), models.end(), has_power_limit);
    const bool at_once = t.turn_share >= 1.0;
    const auto with = [&](auto policies) {
        constexpr int kPolicies = policies;
        if (power_limit) {
            return at_once ? step_blocks<R, kPolicies, true, true>(streams, blocks, models, more, t)
                           : step_blocks<R, kPolicies, true, false>(streams, blocks, models, more, t);
        }
        return at_once ? step_blocks<R, kPolicies, false, true>(streams, blocks, models, more, t)
                       : step_blocks<R, kPolicies, false, false>(streams, blocks, models, more, t);
    };
    if (models.size() == 1) return with(std::integral_constant<int, 1>());
    if (models.size() == 2) return with(std::integral_constant<int, 2>());
    return with(std::integral_constant<int, 0>());
}

}  // namespace

}  // namespace stopline
