// Car-following models of the mesoscale mode. A model computes the speed of the next step of each vehicle. A trait
// struct such as Krauss (krauss.h) or Idm (idm.h) holds its parameters and equations. The kernels are compiled for each
// trait struct, so no call per vehicle is virtual. All other code uses FollowingModel, which can hold any trait struct.
//
// To add a model, write its trait struct and its FollowingAt in a file of its own, and include the file in
// sim/mesoscale/following_types.h. The concept CarFollowing lists what the struct must have.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/simd/arithmetic.h"
#include "base/simd/simd.h"
#include "base/speed_thresholds.h"
#include "driver/driver_settings.h"

namespace stopline {

struct MesoKernels;  // sim/mesoscale/meso_kernels.h

// Names of the car-following models that spacing laws imply.
inline constexpr const char* kConstantDistanceFamily = "constant_distance";
inline constexpr const char* kTimeGapFamily = "time_gap";
inline constexpr const char* kHumanFamily = "human";

// The settings from which a model is made: those of the mesoscale mode and those of the driver.
struct FollowingSettings {
    const MesoSettings& meso;
    const HumanSettings& human;
};

// The desired gap of a spacing policy in the mesoscale mode: standstill gap + time gap x speed + extra gap. The extra
// gap is a function of the speed. It is 0 at rest.
struct MesoGap {
    std::string family = kConstantDistanceFamily;  // name of the car-following model; empty: none
    double standstill_gap_m = 0.0;
    double time_gap_s = 0.0;     // 0 for constant_distance
    bool has_extra_gap = false;  // false: the extra gap is 0 at every speed

    // Returns the gap without the extra gap.
    double gap_m(double speed_mps) const { return standstill_gap_m + time_gap_s * speed_mps; }
};

// The state from which the next speed of a vehicle is computed. R is the number type of the kernels (base/simd/simd.h):
// one vehicle or several at a time.
template <class R>
struct FollowingInputOf {
    R speed_mps;
    R gap_m;  // net gap to the leader
    R leader_speed_mps;
    R leader_acceleration_mps2;  // in the previous step; 0 if the leader brakes
    R extra_gap_m;               // see MesoGap
    R speed_cap_mps;             // highest speed that the speed limit and the stop line allow
    R limit_mps;                 // speed limit of the lane times the speed factor
};
using FollowingInput = FollowingInputOf<double>;

// Braking before a stop line: the vehicle follows braking_speed_mps() to a standstill.
struct FollowingBraking {
    double deceleration_mps2;
    double reaction_s;
};

// The parameter `random` of the functions of a model: the random numbers of one vehicle in one step, and the time since
// the vehicle ahead began to move. Here all numbers have the same value, and the vehicle ahead began to move long ago.
// A model calls only the members that it needs.
struct FixedRandom {
    double value = 0.0;
    double dawdle() const { return value; }
    double driver(std::uint64_t /*index*/) const { return value; }
    double time_s() const { return 0.0; }
    double since_leader_start_s() const { return 1e9; }
};

// Returns the speed from which a vehicle can stop behind its leader. The leader brakes with b [m/s2] at once, the
// vehicle brakes with b after the time tau [s]. `gap_m` is the part of the net gap that the vehicle may use up.
template <class R, class Parameter>
STOPLINE_INLINE R braking_speed_mps(const Parameter& b, const Parameter& tau, const R& gap_m,
                                    const R& leader_speed_mps) {
    const auto bt = b * tau;
    const R square = bt * bt + leader_speed_mps * leader_speed_mps + 2.0 * b * gap_m;
    return square_root(max_of(square, R(0.0))) - bt;
}

// Returns the speed, or 0 if it is below 1 cm/s. Without this rule, a follower would close its gap ever more slowly and
// never come to rest.
template <class R>
STOPLINE_INLINE R snap_to_standstill(const R& speed_mps) {
    return select(speed_mps < kMesoStopSpeed_mps, R(0.0), speed_mps);
}

// Returns the highest speed of the next step without contact: the vehicle moves at most to the current position of its
// leader's rear.
template <class R>
STOPLINE_INLINE R contact_speed_mps(const FollowingInputOf<R>& in, double dt) {
    return max_of(in.gap_m, R(0.0)) * (1.0 / dt);
}

// Returns the desired speed of a model, within the bounds that hold for every model. The speed does not fall below
// `lowest_mps`, except to avoid contact with the leader or if in.speed_cap_mps is lower. The bound on contact is needed
// if the leader stops harder than the model expects, such as before a conflict area. A model can then brake too little
// because of anticipation, a short gap or a long step. The desired speed is below `lowest_mps` only after lane changes.
template <class R>
STOPLINE_INLINE R bounded_speed_mps(const FollowingInputOf<R>& in, const R& desired_mps, const R& lowest_mps,
                                    double dt) {
    return snap_to_standstill(
        min_of(min_of(max_of(desired_mps, lowest_mps), contact_speed_mps(in, dt)), in.speed_cap_mps));
}

// The vehicle type of SUMO that is nearest to a car-following model.
struct SumoFollowing {
    const char* model;  // carFollowModel
    double acceleration_mps2, deceleration_mps2, time_gap_s, standstill_gap_m, dawdling;
    bool is_same_model;  // true: `model` of SUMO has the same equations
};

// Name and description of a car-following model for users.
struct FollowingName {
    const char* name;
    const char* meaning;
};

// The requirements on the trait struct of a car-following model. Besides these members, the struct has four function
// templates over the number type R (krauss.h and idm.h are examples). Their parameter `k` holds the model of one
// policy:
//
//   R following_speed_mps(k, in, random, dt)
//       Returns the highest next speed that the leader allows.
//   R leader_speed_mps(k, in, following_mps, relays, uses_following_speed)
//       Returns the highest next speed that the vehicle ahead allows to a platoon leader. `following_mps` is the result
//       of following_speed_mps(). `relays` and `uses_following_speed` are MesoStep::relays and
//       MesoStep::leaders_use_following_speed (sim/mesoscale/meso_kernels.h).
//   R desired_speed_mps<power_limit>(k, in, following_mps, dt, least_mps2)
//       Returns the desired next speed, in free driving or behind a leader. `least_mps2` is a lower bound of the
//       acceleration on fast lanes. `power_limit` is always true, except for models with fast versions (see below).
//   R disturbed_speed_mps(k, bounded_mps, random, dt)
//       Returns the next speed after random errors. It must lie between 0 and `bounded_mps`, the result of
//       bounded_speed_mps().
//
// A model may have fast versions of its kernels, as Krauss has. Its function of_two_policies() then combines the
// parameters of two policies, and has_power_limit() says if `power_limit` must be true.
//
// A vehicle at rest behind a leader at rest must stay at rest if it did not move in the previous step, because the
// kernels skip the vehicles inside a standing queue.
template <class M>
concept CarFollowing = std::is_trivially_copyable_v<M> &&
    requires(const M& model, const FollowingSettings& settings, const MesoGap& gap, double speed_mps) {
    // Array of FollowingName. A struct with several forms of its equations, such as Krauss, has a name for each form.
    M::kNames;
    { M::make(settings, gap) } -> std::same_as<M>;
    { model.equilibrium_gap_m(speed_mps) } -> std::same_as<double>;  // without the extra gap
    { model.smallest_gap_m() } -> std::same_as<double>;              // smallest gap at rest
    { model.braking() } -> std::same_as<FollowingBraking>;
    { model.relays_starts() } -> std::same_as<bool>;    // passes on V2V start messages (MesoSettings)
    { model.has_power_limit() } -> std::same_as<bool>;  // constant power can lower the acceleration
    { model.in_sumo() } -> std::same_as<SumoFollowing>;
    // True: following_speed_mps() is also the result of leader_speed_mps() in runs with V2V start messages.
    { model.leader_uses_following_speed() } -> std::same_as<bool>;
};

// FollowingAt gives a model its number in the list of all models (sim/mesoscale/following_types.h). The file of the
// model specialises it for a free number, with the trait struct as `Trait`. Lists for users are in the order of these
// numbers. Numbers may stay free.
inline constexpr int kFollowingPlaces = 32;
template <int place>
requires(place >= 0 && place < kFollowingPlaces) struct FollowingAt {
    using Trait = void;  // the place is free
};

class FollowingModel;

// A named car-following model: functions that make the model of a policy and answer questions about it.
struct FollowingFamily {
    FollowingName text;
    FollowingModel (*make)(const FollowingFamily& family, const FollowingSettings& settings, const MesoGap& gap);
    double (*equilibrium_gap_m)(const FollowingModel& model, double speed_mps);
    double (*smallest_gap_m)(const FollowingModel& model);
    FollowingBraking (*braking)(const FollowingModel& model);
    bool (*relays_starts)(const FollowingModel& model);
    bool (*leader_uses_following_speed)(const FollowingModel& model);
    SumoFollowing (*in_sumo)(const FollowingModel& model);
    // Returns the kernels of the model. If `scalar` is true, they compute one vehicle at a time.
    const MesoKernels& (*kernels)(bool scalar);
};

// The car-following model of one spacing policy: the trait struct of any model, with its family.
class FollowingModel {
public:
    template <CarFollowing M>
    FollowingModel(const FollowingFamily& family, const M& model) : family_(&family) {
        static_assert(sizeof(M) <= kBytes && alignof(M) <= alignof(double), "enlarge FollowingModel::kBytes");
        new (parameters_.data()) M(model);
    }

    STOPLINE_INLINE const FollowingFamily& family() const { return *family_; }
    bool is(std::string_view name) const { return name == family_->text.name; }

    double equilibrium_gap_m(double speed_mps) const { return family_->equilibrium_gap_m(*this, speed_mps); }
    double smallest_gap_m() const { return family_->smallest_gap_m(*this); }
    FollowingBraking braking() const { return family_->braking(*this); }
    bool relays_starts() const { return family_->relays_starts(*this); }
    bool leader_uses_following_speed() const { return family_->leader_uses_following_speed(*this); }
    SumoFollowing in_sumo() const { return family_->in_sumo(*this); }

    // Return the trait struct. M must be the struct of the family.
    template <CarFollowing M>
    STOPLINE_INLINE const M& as() const {
        return *std::launder(reinterpret_cast<const M*>(parameters_.data()));
    }
    template <CarFollowing M>
    STOPLINE_INLINE M& as() {
        return *std::launder(reinterpret_cast<M*>(parameters_.data()));
    }

private:
    static constexpr std::size_t kBytes = 128;
    const FollowingFamily* family_;
    alignas(double) std::array<std::byte, kBytes> parameters_{};
};

// Makes the family of a model from its trait struct.
template <CarFollowing M>
constexpr FollowingFamily following_family(const FollowingName& text, const MesoKernels& (*kernels)(bool scalar)) {
    return {text,
            [](const FollowingFamily& family, const FollowingSettings& settings, const MesoGap& gap) {
                return FollowingModel(family, M::make(settings, gap));
            },
            [](const FollowingModel& model, double speed_mps) { return model.as<M>().equilibrium_gap_m(speed_mps); },
            [](const FollowingModel& model) { return model.as<M>().smallest_gap_m(); },
            [](const FollowingModel& model) { return model.as<M>().braking(); },
            [](const FollowingModel& model) { return model.as<M>().relays_starts(); },
            [](const FollowingModel& model) { return model.as<M>().leader_uses_following_speed(); },
            [](const FollowingModel& model) { return model.as<M>().in_sumo(); },
            kernels};
}

// Returns the next speed of one vehicle. `random` is uniform in [0, 1).
template <CarFollowing M>
inline double next_speed_mps(const M& model, const FollowingInput& in, double random, double dt) {
    const FixedRandom numbers{random};
    const double following_mps = M::following_speed_mps(model, in, numbers, dt);
    const double desired_mps = M::template desired_speed_mps<true>(model, in, following_mps, dt, 0.0);
    return M::disturbed_speed_mps(model, bounded_speed_mps(in, desired_mps, 0.0, dt), numbers, dt);
}

}  // namespace stopline
