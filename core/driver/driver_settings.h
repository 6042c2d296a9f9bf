// Settings of the longitudinal controller: following (CACC), free driving, stopping. SI units.
#pragma once

#include <string>
#include <vector>

namespace stopline {

// Settings that kernels read are templates over the number type (base/narrowed.h).

// The feedback and feedforward gains of Fig. 3 and Fig. 4, and the delays of the sensors.
template <class Number>
struct CaccSettingsOf {
    Number feedback_kp_1ps2 = 0.2;  // Ploeg et al. 2011 (reference [31] of the paper)
    Number feedback_kd_1ps = 0.7;
    Number radar_delay_s = 0.15;  // Section III.D
    Number radar_range_m = 150.0;
    Number v2v_delay_s = 0.02;
    Number prediction_start_s = 0.1;         // Fig. 4: a_i shall meet a_(i-1) from here ...
    Number prediction_end_s = 0.5;           // ... to here after now
    Number acceleration_max_mps2 = 2.5;      // a follower's comfort limit
    Number deceleration_comfort_mps2 = 3.5;  // ISO 15622: ACC brakes at most this hard without an emergency
    Number deceleration_emergency_mps2 = 7.0;
    Number emergency_threshold_mps2 = 3.0;  // collision avoidance acts from this required deceleration on
    Number emergency_gap_m = 0.5;           // and keeps this distance
    Number jerk_up_mps3 = 6.0;              // the command's slew limits: switches are bumpless
    Number jerk_down_mps3 = 25.0;
    Number catch_up_factor = 1.05;  // a follower may exceed the limit by this factor to close its gap
};
using CaccSettings = CaccSettingsOf<double>;

// Free driving: acceleration asked for over speed (the calibrated start-up of Section III.B), towards the desired speed.
struct FreeDriveSettings {
    std::vector<double> speed_mps;          // knots, rising from 0
    std::vector<double> acceleration_mps2;  // at the knots; constant beyond the last
    double speed_gain_1ps = 0.35;           // towards the desired speed: gain x (v_desired - v)
    double deceleration_mps2 = 1.5;         // for a lower limit ahead (turns)
    double hesitation_s = 0.0;              // leader: from green to the release of the brake
};

// Stopping at a line.
template <class Number>
struct StopSettingsOf {
    Number deceleration_mps2 = 2.5;           // braking starts when this is needed
    Number decision_deceleration_mps2 = 3.5;  // on yellow: stop if this suffices, else go on
    Number margin_m = 1.0;                    // front to line
};
using StopSettings = StopSettingsOf<double>;

// Giving way inside intersections.
struct GiveWaySettings {
    double critical_gap_s = 5.0;  // shortest time to the next vehicle with priority that is accepted
    double margin_m = 0.5;        // from the front to the conflict area when waiting
    double approach_mps2 = 2.0;   // vehicles with priority are expected to accelerate like this, up to the limit
};

// Changing lanes (sim/lane_change.cpp).
struct LaneChangeSettings {
    // For the route: a lane is looked for from this far before the stop line on, for each change that it takes, ...
    double strategic_m = 300.0;
    double urgent_m = 200.0;  // ... and from here on the speed is adapted to the gaps in the lane beside.
    // Of the gap that the policy keeps at the own speed: what is enough ahead and behind; and at the stop line (linear from urgent_m on).
    double gap_share = 1.0;
    // Default: median critical gaps of drivers that must change are 4 m at equal speeds (Toledo, Koutsopoulos, Ben-Akiva 2003, "Modeling
    // integrated lane-changing behavior", Transportation Research Record 1857), 0.3 of what 0.87 s are at 50 km/h.
    double urgent_gap_share = 0.3;
    // off | on: whether vehicles know how they will turn at the next intersection but one, and go to a lane from which they get there.
    std::string look_ahead = "on";
    std::string help = "off";  // off | on: whether others make room for those that must change
    // For speed: MOBIL (Kesting, Treiber, Helbing 2007), accelerations by the intelligent driver model with the policy's gap.
    double threshold_mps2 = 0.1;
    double politeness = 0.0;
    double keep_right_mps2 = 0.0;  // advantage of the lane to the right
    double acceleration_mps2 = 1.5;
    double deceleration_mps2 = 2.0;
    double pause_s = 5.0;  // after a change, before another one for speed
};

struct DriverSettings {
    CaccSettings cacc;
    FreeDriveSettings free_drive;
    StopSettings stop;
    GiveWaySettings give_way;
    LaneChangeSettings lane_change;
    std::string name = {};  // of the file in data/drivers
};

// A model of the Krauss family (krauss.h), as Table 2 of the paper writes it.
struct KraussSettings {
    double acceleration_mps2 = 1.7;
    double acceleration_until_mps = 500.0 / 3.6;  // beyond it the power is constant: acceleration falls with 1 / v
    double catch_up = 1.0;                        // times the acceleration, for those close behind a predecessor
    double tracking = 0.0;          // 1: no faster than the gap is that of the time gap; 0: as v_safe says
    double anticipation_s = 0.0;    // the predecessor's speed is reckoned with as it will be then
    double transient_gap_s2 = 0.0;  // added to the gap for each m/s2 that the predecessor accelerates
    double deceleration_mps2 = 4.7;
    double reaction_s = 0.9;         // tau
    double standstill_gap_m = 2.95;  // minGap
    double dawdling = 0.4;           // sigma
};

// The mesoscale mode: one model for policies with a time gap, one for those without.
struct MesoSettings {
    std::string name;  // of the file in data/meso
    double step_s = 0.1;
    double leader_share = 0.95;               // of the limit, for vehicles without a predecessor (Section V.A)
    double speed_factor = 1.0;                // of every limit
    double speed_gain_1ps = 1000;             // acceleration towards a limit, a second and m/s below it
    double turn_gain_1ps = 1000;              // the same towards the speed allowed on the way to a turn
    double leader_mps2 = 0.0;                 // acceleration of platoon leaders (0: as the model says), ...
    double leader_until_mps = 500.0 / 3.6;    // ... and the speed up to which it is available
    std::vector<double> leader_profile_mps;   // their acceleration over speed, instead of these two: speeds, ...
    std::vector<double> leader_profile_mps2;  // ... and accelerations
    int relayed = 0;             // resting vehicles that hear at once that those further ahead set out (V2V)
    double start_delay_s = 0.0;  // by which the first vehicle at a stop line sets out later: what the powertrain takes
    KraussSettings constant_time;
    KraussSettings constant_distance;
    double band_m = 0.5;       // s_t of equation (1)
    double below_band = 0.95;  // d of equation (1)
    // The policy that the models were calibrated with: others differ from it.
    double calibrated_time_gap_s = 0.87;
    double calibrated_standstill_gap_m = 2.95;
};

// One spacing policy by name. `law` is a registered law; the numbers a law does not use stay 0.
struct GapPolicySettings {
    std::string name;
    std::string law;  // constant_distance | constant_time | switch_time_gap | switch_distance
    double standstill_gap_m = 2.95;
    double time_gap_s = 0.0;
    double switch_speed_mps = 0.0;     // below it the gap is the standstill gap
    double reference_speed_mps = 0.0;  // switch_distance: the speed at which ...
    double reference_gap_m = 0.0;      // ... this gap is reached
};

// Which vehicles follow which policy: one component, or several with shares that sum to 1.
struct PopulationSettings {
    enum class Pattern { alternating, random, balanced };
    struct Component {
        std::string policy;
        double share = 1.0;
    };
    std::string name;
    std::vector<Component> components;
    Pattern pattern = Pattern::alternating;
};

}  // namespace stopline
