// The user's settings of drivers: car following, free driving, stopping, yielding, lane changes, the mesoscale models
// and the spacing policies. SI units.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "driver/v2v_settings.h"

namespace stopline {

// Settings that the kernels (the loops over vehicles) read are templates over the number type, so that the kernels can
// use float (base/simd/narrowed.h).

// Cooperative adaptive cruise control (CACC, Fig. 3 and Fig. 4 of the paper): gains of the gap feedback, prediction
// horizon of the feedforward, delays of radar and V2V messages, limits of acceleration and jerk, and emergency braking.
template <class Number>
struct CaccSettingsOf {
    Number feedback_kp_1ps2 = 0.2;  // gain on the gap error (Ploeg et al. 2011, reference [31] of the paper)
    Number feedback_kd_1ps = 0.7;   // gain on the rate of the gap error
    Number radar_delay_s = 0.15;    // Section III.D of the paper
    Number radar_range_m = 150.0;
    Number v2v_delay_s = 0.02;
    Number prediction_start_s = 0.1;           // start of the prediction horizon, after the current time (Fig. 4)
    Number prediction_end_s = 0.5;             // end of the prediction horizon, after the current time
    Number acceleration_max_mps2 = 2.5;        // comfort limit of followers
    Number deceleration_comfort_mps2 = 3.5;    // limit without an emergency (ISO 15622 for ACC)
    Number deceleration_emergency_mps2 = 7.0;  // maximum braking
    Number emergency_threshold_mps2 = 3.0;     // emergency braking begins when this deceleration is needed
    Number emergency_gap_m = 0.5;              // remaining gap after emergency braking
    Number jerk_up_mps3 = 6.0;                 // limit of the increase of the requested acceleration
    Number jerk_down_mps3 = 25.0;              // limit of the decrease of the requested acceleration
    Number catch_up_factor = 1.05;             // a follower may exceed the speed limit by this factor to close its gap

    bool operator==(const CaccSettingsOf&) const = default;
};
using CaccSettings = CaccSettingsOf<double>;

// Reaction time tau of the speed curves on which vehicles brake to a stop: stop_acceleration() in full dynamics
// (acceleration_laws.h), and the IDM before a stop line (idm.h).
inline constexpr double kBrakingReaction_s = 0.5;

// Driving without a leader: the acceleration as a function of speed (the calibrated start-up of Section III.B).
struct FreeDriveSettings {
    std::vector<double> speed_mps;          // nodes of the profile, rising from 0
    std::vector<double> acceleration_mps2;  // acceleration at each speed; constant above the highest speed
    // Highest speed limit for which the profile holds; 0: the highest speed of the profile. Near this speed the profile
    // falls, because the measured drivers approached their limit. On roads with a higher limit, drivers accelerate at
    // least with the share power_share of the acceleration that the vehicle can give.
    double profile_limit_mps = 0.0;
    double power_share = 0.5;
    double speed_gain_1ps = 0.35;    // the acceleration is at most this gain x (desired speed - speed)
    double deceleration_mps2 = 1.5;  // deceleration before a lower speed limit, such as in a turn
    double hesitation_s = 0.0;       // reaction time of the first vehicle at the stop line

    bool operator==(const FreeDriveSettings&) const = default;
};

// Stopping at a stop line.
template <class Number>
struct StopSettingsOf {
    Number deceleration_mps2 = 2.5;           // braking begins when this deceleration is needed
    Number decision_deceleration_mps2 = 3.5;  // a vehicle stops at yellow if this deceleration suffices
    Number margin_m = 1.0;                    // distance from the front of the stopped vehicle to the stop line

    bool operator==(const StopSettingsOf&) const = default;
};
using StopSettings = StopSettingsOf<double>;

// Yielding inside intersections.
struct GiveWaySettings {
    // Shortest accepted time between two vehicles with priority, for a vehicle that starts from rest. The default is
    // near the mean of 45 approaches with permissive left turns, 4.87 s (Claros, Chitturi, Bill, Noyce 2021, "Impact of
    // geometry and operations on left-turn gap acceptance at signalized intersections with permissive indication").
    double critical_gap_s = 5.0;
    // Critical lag: shortest accepted time from the arrival of a moving vehicle at its waiting position until the next
    // vehicle with priority reaches the conflict area. 0: the critical gap, minus the time that a moving vehicle saves
    // in comparison with a start from rest.
    double critical_lag_s = 0.0;
    double margin_m = 0.5;  // distance from a waiting vehicle's front to the conflict area
    // A yielding driver assumes that approaching vehicles with priority accelerate this much, up to the speed limit.
    double approach_acceleration_mps2 = 2.0;

    bool operator==(const GiveWaySettings&) const = default;
};

// The way in which vehicles on the target lane open a gap for a mandatory lane change. cooperative: vehicles with V2V
// open it on request.
enum class GapOpening : std::uint8_t { off, on, cooperative };

// Lane changes (sim/lane_change/lane_change.cpp).
struct LaneChangeSettings {
    // Mandatory changes. A vehicle that needs n lane changes begins to look for a gap when its usable distance is
    // shorter than its speed times n look_ahead_s, plus room for two vehicles. The usable distance is the distance to
    // the stop line minus the queue on the target lane, but at most the distance to the position from which on the
    // whole vehicle is beside its turn pocket. For changes to the left, left_factor times look_ahead_s applies. The
    // form and both defaults are those of SUMO's model LC2013 (Erdmann 2015, "SUMO's lane-changing model"). Unlike in
    // LC2013, only the queue before the next intersection counts, also for a later turn.
    double look_ahead_s = 10.0;
    double left_factor = 2.0;
    // Smallest accepted lead gap and lag gap, as a share of the gap of the spacing policy. The share falls linearly
    // from gap_share at the beginning of the search to urgent_gap_share where no usable distance is left.
    double gap_share = 1.0;
    // The default follows measurements: at equal speeds the median critical gap of mandatory changes is 4 m (Toledo,
    // Koutsopoulos, Ben-Akiva 2003, "Modeling integrated lane-changing behavior", Transportation Research Record 1857).
    // These 4 m are about 0.3 of the 12 m that a vehicle drives at 50 km/h within the time gap of 0.87 s.
    double urgent_gap_share = 0.3;
    std::string look_ahead = "on";   // off | on: vehicles also choose lanes for the turn after the next one
    std::string gap_opening = "on";  // off | on | cooperative, see GapOpening
    double courtesy = 1.0;  // cooperative: probability with which a driver without V2V opens a gap as with `on`
    // Discretionary changes: MOBIL (Kesting, Treiber, Helbing 2007). MOBIL rates a change by the accelerations that
    // result from the intelligent driver model (IDM) with the desired gap of the spacing policy.
    double threshold_mps2 = 0.1;  // smallest gain in acceleration that counts
    // A vehicle sums up, over time, the gains in acceleration beyond threshold_mps2. It changes lanes when the sum
    // reaches this speed. So a short advantage of the other lane is not enough.
    double gain_mps = 1.0;
    double politeness = 0.0;         // weight of the gains and losses of other vehicles
    double keep_right_mps2 = 0.0;    // bonus of a change to the right
    double acceleration_mps2 = 1.5;  // maximum acceleration of the IDM
    double deceleration_mps2 = 2.0;  // comfortable deceleration of the IDM
    double pause_s = 5.0;            // no discretionary change within this time after any change

    bool looks_ahead() const { return look_ahead != "off"; }
    GapOpening gap_opening_value() const {
        if (gap_opening == "cooperative") return GapOpening::cooperative;
        return gap_opening == "on" ? GapOpening::on : GapOpening::off;
    }

    bool operator==(const LaneChangeSettings&) const = default;
};

// The intelligent driver model (idm.h). The policy gives the time gap and the standstill gap. The defaults are the
// values for cities of Treiber, Kesting 2013, "Traffic Flow Dynamics", table 11.2.
struct IdmSettings {
    double acceleration_mps2 = 1.0;  // a, maximum acceleration
    double deceleration_mps2 = 1.5;  // b, comfortable deceleration

    bool operator==(const IdmSettings&) const = default;
};

// Human drivers (human.h), for policies with the law `human`. The errors are those of Treiber, Kesting, Helbing 2006.
// The shipped drivers set the maximum acceleration themselves: startup_kit from measured starts, lorry and bus from
// VECTO (data/drivers).
// The reaction times are those of Green 2000, "How long does it take to stop?": about 0.75 s to an expected event, such
// as the start of the queue ahead, and about 1.25 s to an unexpected signal of the car ahead. While following, the mean
// of both applies.
struct HumanSettings {
    IdmSettings idm;
    double start_reaction_s = 0.75;   // mean reaction time to the start of the car ahead, and to the start of green
    double reaction_s = 1.0;          // mean reaction time while following
    double reaction_spread_s = 0.25;  // the reaction times of drivers are uniform within reaction_s +- this value
    double gap_error = 0.05;          // V_s, relative error of the gap
    double closing_error_1ps = 0.01;  // r_c, error of the closing speed per metre of gap
    double error_time_s = 20.0;       // correlation time of the errors
    int anticipated_vehicles = 5;     // full dynamics: number of vehicles ahead to which a driver reacts

    bool operator==(const HumanSettings&) const = default;
};

// Green light optimal speed advisory (GLOSA): the signal tells the vehicle when it will be green (SPaT messages), and
// the vehicle slows down early so that it arrives at green without a stop (sim/speed_advice/speed_advice.cpp).
struct SpeedAdviceSettings {
    std::string mode = "off";         // off | glosa
    double range_m = 300.0;           // distance to the stop line within which the vehicle gets messages
    double min_speed_mps = 20 / 3.6;  // lowest advised speed
    double deceleration_mps2 = 1.0;   // strongest braking towards the advised speed

    bool is_on() const { return mode == "glosa"; }

    bool operator==(const SpeedAdviceSettings&) const = default;
};

struct DriverSettings {
    CaccSettings cacc;
    FreeDriveSettings free_drive;
    StopSettings stop;
    GiveWaySettings give_way;
    LaneChangeSettings lane_change;
    HumanSettings human;
    V2vSettings v2v;
    PlatoonSettings platoon;
    SpeedAdviceSettings speed_advice;
    std::string name = {};  // name of the driver; default: the name of the file in data/drivers

    bool operator==(const DriverSettings&) const = default;
};

// A car-following model of the Krauss family (krauss.h), with the parameters of Table 2 of the paper.
struct KraussSettings {
    double acceleration_mps2 = 1.7;  // a, maximum acceleration
    // Above this speed the power is constant: the acceleration falls with 1 / v.
    double constant_power_speed_mps = 500.0 / 3.6;
    double catch_up_factor = 1.0;    // factor on the acceleration of a vehicle close behind its leader
    double gap_tracking = 0.0;       // 1: keep the time gap behind a leader that draws away; 0: v_safe alone applies
    double anticipation_s = 0.0;     // the speed of an accelerating leader is extrapolated over this time
    double transient_gap_s2 = 0.0;   // extra gap per m/s2 of the leader's acceleration
    double deceleration_mps2 = 4.7;  // b, expected deceleration of both vehicles
    double reaction_s = 0.9;         // tau, reaction time
    double standstill_gap_m = 2.95;  // s_0 (minGap in SUMO)
    double dawdling = 0.4;           // sigma, 0 .. 1
};

// The parameters of the mesoscale mode, including those of its car-following models (following_model.h).
struct MesoSettings {
    std::string name;  // name of this set of values; default: the name of the file in data/meso
    double step_s = 0.1;
    // Speed of a vehicle without leader, as a share of the speed limit (Section V.A of the paper).
    double leader_speed_share = 0.95;
    double speed_factor = 1.0;  // factor on every speed limit
    // The acceleration is at most this gain x (limit - speed). Without a leader, leader_speed_share x limit replaces
    // the limit.
    double speed_gain_1ps = 1000;
    // Speed control before a turn: the acceleration is at most this gain x (allowed speed - speed), minus the
    // deceleration for the turn. The allowed speed is the highest speed from which the vehicle can still brake to the
    // turn speed in time. With 1000, the vehicle takes the allowed speed at once.
    double turn_gain_1ps = 1000;
    // Acceleration of platoon leaders: leader_mps2, which falls as 1 / speed above leader_constant_power_speed_mps. If
    // leader_mps2 is 0, platoon leaders accelerate as in the car-following model of their policy. A leader profile,
    // which lists speeds and the accelerations at these speeds, replaces both values.
    double leader_mps2 = 0.0;
    double leader_constant_power_speed_mps = 500.0 / 3.6;
    std::vector<double> leader_profile_mps;
    std::vector<double> leader_profile_mps2;
    // Queue discharge: in each step, a V2V start message reaches at most this number of stopped vehicles at the front
    // of the queue. Only vehicles with the constant-distance model receive the message. 0: no start messages.
    int start_relay_vehicles = 0;
    double start_delay_s = 0.0;  // start-up delay of the first vehicle at a stop line, due to its powertrain
    KraussSettings constant_time;
    KraussSettings constant_distance;
    IdmSettings idm;
    // Equation (1) of the paper: a vehicle whose gap is below s_0, but by less than s_t, drives as fast as its leader.
    // If the gap is even smaller, the vehicle drives at the share d of its leader's speed.
    double band_m = 0.5;                   // s_t
    double below_band_speed_share = 0.95;  // d
    // Gaps of the policy for which the models were calibrated. For a policy with another time gap or standstill gap,
    // the parameter tau or s_0 of the model (krauss.h) changes by the difference.
    double calibrated_time_gap_s = 0.87;
    double calibrated_standstill_gap_m = 2.95;
    // Highest speed limit and longest step for which the models were calibrated. On roads with a higher limit, the
    // accelerations are at least the share FreeDriveSettings::power_share of what the vehicle can give.
    double calibrated_speed_limit_mps = 50.0 / 3.6;
    double calibrated_step_s = 0.1;
};

inline constexpr std::size_t kMaxLawParameters = 16;
inline constexpr const char* kFamilyByLaw = "by_law";

// A spacing policy. `law` is the name of a registered spacing law (spacing_laws/gap_policy.h).
struct GapPolicySettings {
    std::string name;
    std::string law;
    double standstill_gap_m = 2.95;
    // Parameters of laws in SI units, in the order of law_parameters(). Those that the law does not have are 0.
    std::array<double, kMaxLawParameters> parameters{};
    std::string gap_formula;  // law `formula`: the gap as a function of the speed
    // law `table`: net gaps at rising speeds above 0
    std::vector<double> gap_speed_mps;
    std::vector<double> gap_at_speed_m;
    // Name of the car-following model of the mesoscale mode (FollowingFamily), or kFamilyByLaw: the model that the law
    // implies. The laws `formula` and `table` imply no model.
    std::string mesoscale = kFamilyByLaw;
};

}  // namespace stopline
