// Fields of the mesoscale mode.
#include "scenario/schema/field_rows.h"
#include "scenario/schema/fields.h"

namespace stopline {
namespace {

const Table& krauss_table() {
    using S = KraussSettings;
    static const Table table = make_table<S>(
        "a car-following model of the Krauss family",
        {
            number<&S::acceleration_mps2>("acceleration", "m/s2", {0.1, 10}, "a: maximum acceleration"),
            number<&S::constant_power_speed_mps>(
                "constant_power_speed", "km/h", {5, 500},
                "speed above which the power is constant, so the acceleration falls in inverse proportion to the speed "
                "(500 km/h: it is a at all speeds, as in the paper)")
                .renamed_from("acceleration_until"),
            number<&S::catch_up_factor>(
                "catch_up_factor", "", {1, 5},
                "factor on the acceleration of a vehicle within 2 m of its equilibrium gap; it compensates that the "
                "vehicle starts one step after its leader (1: none, as in the paper)")
                .renamed_from("catch_up"),
            number<&S::gap_tracking>(
                "gap_tracking", "", {0, 1},
                "1: a vehicle with a time gap keeps that gap also behind a leader that draws away; 0: the safe "
                "speed of Krauss alone applies, as in the paper")
                .renamed_from("tracking"),
            number<&S::anticipation_s>(
                "anticipation", "s", {0, 1},
                "time over which the speed of an accelerating leader is extrapolated; V2V provides its acceleration (0 "
                "s: none, as in the paper)"),
            number<&S::transient_gap_s2>(
                "transient_gap", "", {0, 5},
                "extra gap in metres per m/s2 of the leader's acceleration, for the transient lag of the "
                "controller (0: none, as in the paper)"),
            number<&S::deceleration_mps2>("deceleration", "m/s2", {0.1, 12},
                                          "b: deceleration that the safe speed assumes"),
            number<&S::reaction_s>("reaction", "s", {0, 5}, "tau: reaction time that the safe speed assumes"),
            number<&S::standstill_gap_m>("standstill_gap", "m", {0.1, 20}, "s_0 (minGap): net gap at standstill"),
            number<&S::dawdling>("dawdling", kPlainShare, {0, 1},
                                 "sigma: share of the acceleration that is lost at random"),
        });
    return table;
}

}  // namespace

const Table& idm_table() {
    using S = IdmSettings;
    static const Table table = make_table<S>(
        "the intelligent driver model",
        {
            number<&S::acceleration_mps2>("acceleration", "m/s2", {0.1, 10},
                                          "a: maximum acceleration; the policy gives standstill gap and time gap"),
            number<&S::deceleration_mps2>("deceleration", "m/s2", {0.1, 12}, "b: comfortable deceleration"),
        });
    return table;
}

const Table& meso_table() {
    using S = MesoSettings;
    static const Table table = make_table<S>(
        "the mesoscale mode",
        {
            text<&S::name>("name", TextField::Rule::name, "name; default: the name of the file"),
            number<&S::step_s>(
                "step", "s", {0.01, 0.5},
                "time step; the upper limit ensures that no vehicle passes a signal that has just turned red"),
            number<&S::leader_speed_share>("leader_speed_share", "%", {50, 100},
                                           "speed of a vehicle without leader, as a share of the speed limit, so that "
                                           "followers can catch up (Section V.A)")
                .renamed_from("leader_share"),
            number<&S::speed_factor>(
                "speed_factor", "%", {50, 150},
                "factor on the speed limits of lanes, as in SUMO; vehicles enter a slower lane at its plain limit"),
            number<&S::speed_gain_1ps>("speed_gain", "1/s", {0.05, 1000},
                                       "acceleration per m/s below the speed limit, for a gradual approach to the "
                                       "limit as in full dynamics (1000 1/s: full acceleration, as in the paper)"),
            number<&S::turn_gain_1ps>(
                "turn_gain", "1/s", {0.05, 1000},
                "before a turn, the acceleration is this gain times (safe speed - own speed), minus the braking for "
                "the turn; the safe speed is the highest one that still allows braking in time (1000 1/s: the vehicle "
                "takes that speed at once, as in the paper)"),
            number<&S::leader_mps2>("leader_acceleration", "m/s2", {0, 10},
                                    "maximum acceleration of platoon leaders with any policy (0 m/s2: the model of "
                                    "the policy decides, as in the paper)"),
            number<&S::leader_constant_power_speed_mps>(
                "leader_constant_power_speed", "km/h", {5, 500},
                "speed above which leader_acceleration falls in inverse proportion to the speed")
                .renamed_from("leader_acceleration_until"),
            curve<&S::leader_profile_mps, &S::leader_profile_mps2>(
                "leader_profile", {"km/h", {0, 500}}, {"m/s2", {0.001, 10}}, {0, 200},
                "acceleration of platoon leaders over speed, taken from the nearest point; replaces "
                "leader_acceleration; stopline-calibrate measures it in full dynamics (empty: none, as in the paper)"),
            whole_number<&S::start_relay_vehicles>(
                "start_relay_vehicles", {0, 50},
                "queue discharge with constant-distance policies: number of stopped vehicles that a V2V start message "
                "reaches in one step, in addition to the next vehicle (0: none, as in the paper)")
                .renamed_from("relayed"),
            number<&S::start_delay_s>(
                "start_delay", "s", {0, 5},
                "start-up delay of the first vehicle at a stop line, due to its powertrain; the driver's hesitation is "
                "added"),
            section<&S::constant_time>("constant_time", krauss_table, "the car-following model time_gap"),
            section<&S::constant_distance>("constant_distance", krauss_table,
                                           "the car-following model constant_distance: equation (1) of the paper"),
            section<&S::idm>("idm", idm_table, "the car-following model idm"),
            number<&S::band_m>("band", "m", {0, 5}, "s_t of equation (1): width of the tolerance band"),
            number<&S::below_band_speed_share>(
                "below_band_speed_share", kPlainShare, {0, 1},
                "d of equation (1): speed of a vehicle whose gap is below the band, as a share of the leader's speed")
                .renamed_from("below_band"),
            number<&S::calibrated_time_gap_s>(
                "calibrated_time_gap", "s", {0, 5},
                "time gap of the policy that constant_time was calibrated for; a policy with another time gap gets tau "
                "plus the difference"),
            number<&S::calibrated_standstill_gap_m>(
                "calibrated_standstill_gap", "m", {0.1, 20},
                "standstill gap of the policies that were calibrated; a policy with another standstill gap gets s_0 "
                "plus the difference"),
            number<&S::calibrated_speed_limit_mps>(
                "calibrated_speed_limit", "km/h", {5, 500},
                "highest speed limit that the models were calibrated for; on faster roads the accelerations are at "
                "least driver.free_drive.power_share of what the vehicle can give"),
            number<&S::calibrated_step_s>("calibrated_step", "s", {0.01, 0.5},
                                          "longest step that the models were calibrated for; a longer step gives a "
                                          "warning"),
        },
        [](const S& s, Checker& check) {
            if (s.band_m >= s.constant_distance.standstill_gap_m) {
                check.error("band", "must be below constant_distance.standstill_gap");
            }
        });
    return table;
}

}  // namespace stopline
