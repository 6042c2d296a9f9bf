// Fields of the mesoscale mode.
#include "scenario/field_rows.h"
#include "scenario/fields.h"

namespace stopline {
namespace {

const Table& krauss_table() {
    using S = KraussSettings;
    static const Table table = make_table<S>(
        "a model of the Krauss family",
        {
            number<&S::acceleration_mps2>("acceleration", "m/s2", {0.1, 10}, "a: highest acceleration"),
            number<&S::acceleration_until_mps>(
                "acceleration_until", "km/h", {5, 500},
                "speed up to which a is available; beyond it the power is constant and "
                "the acceleration falls with 1 / v (500 km/h: a at all speeds, as in the "
                "paper)"),
            number<&S::catch_up>("catch_up", "", {1, 5},
                                 "times the acceleration, for a vehicle no further than 2 m beyond its gap: what it "
                                 "needs to make up for the step that it starts later than its predecessor (1: none, as "
                                 "in the paper)"),
            number<&S::tracking>("tracking", "", {0, 1},
                                 "1: a vehicle with a time gap is no faster than its gap allows, also while its "
                                 "predecessor draws away (0: as Krauss's safe speed says, as in the paper)"),
            number<&S::anticipation_s>(
                "anticipation", "s", {0, 1},
                "an accelerating predecessor's speed is reckoned with as it will be then, as V2V "
                "tells (0 s: as it is, as in the paper)"),
            number<&S::transient_gap_s2>("transient_gap", "", {0, 5},
                                         "metres of gap for each m/s2 of the predecessor's acceleration: what the "
                                         "controller falls behind meanwhile (0: nothing, as in the paper)"),
            number<&S::deceleration_mps2>("deceleration", "m/s2", {0.1, 12}, "b: braking that safe speeds reckon with"),
            number<&S::reaction_s>("reaction", "s", {0, 5}, "tau: time before braking that safe speeds reckon with"),
            number<&S::standstill_gap_m>("standstill_gap", "m", {0.1, 20}, "s_0, minGap: net gap at standstill"),
            number<&S::dawdling>("dawdling", "", {0, 1}, "sigma: share of the acceleration that is lost at random"),
        });
    return table;
}

}  // namespace

const Table& meso_table() {
    using S = MesoSettings;
    static const Table table = make_table<S>(
        "the mesoscale mode",
        {
            text<&S::name>("name", TextField::Rule::name, "name; if not given, that of the file"),
            number<&S::step_s>("step", "s", {0.01, 0.5},
                               "time step; with longer ones vehicles would pass a light that has turned red"),
            number<&S::leader_share>("leader_share", "%", {50, 100},
                                     "share of the limit that vehicles without a predecessor drive, so that others can "
                                     "catch up with them"),
            number<&S::speed_factor>("speed_factor", "%", {50, 150}, "of every limit, as in SUMO"),
            number<&S::speed_gain_1ps>("speed_gain", "1/s", {0.05, 1000},
                                       "acceleration for each m/s below the limit, which is thus approached gradually, "
                                       "as in full dynamics (1000 1/s: with the full acceleration, as in the paper)"),
            number<&S::turn_gain_1ps>(
                "turn_gain", "1/s", {0.05, 1000},
                "the same on the way to a turn: acceleration for each m/s below the speed that "
                "braking in time allows, less that braking (1000 1/s: that speed at once, as in the paper)"),
            number<&S::leader_mps2>(
                "leader_acceleration", "m/s2", {0, 10},
                "highest acceleration of leaders of platoons, whatever their policy (0 m/s2: as the "
                "policy's model says, as in the paper)"),
            number<&S::leader_until_mps>("leader_acceleration_until", "km/h", {5, 500},
                                         "speed up to which leader_acceleration is available"),
            curve<&S::leader_profile_mps, &S::leader_profile_mps2>(
                "leader_profile", {"km/h", {0, 500}}, {"m/s2", {0.001, 10}}, {0, 200},
                "acceleration of leaders at the nearest of these speeds, instead of leader_acceleration; "
                "stopline-calibrate measures it in full dynamics (not given: none, as in the paper)"),
            whole<&S::relayed>(
                "relayed", {0, 50},
                "vehicles of constant distance at rest that hear, besides the next, in the same step that "
                "those ahead of them set out: as many as V2V reaches (0: none, as in the paper)"),
            number<&S::start_delay_s>("start_delay", "s", {0, 5},
                                      "time that the first vehicle at a stop line takes to set out, besides the "
                                      "driver's hesitation: the powertrain's"),
            section<&S::constant_time>("constant_time", krauss_table, "policies with a time gap: the Krauss model"),
            section<&S::constant_distance>("constant_distance", krauss_table,
                                           "all other policies: the paper's equation (1)"),
            number<&S::band_m>("band", "m", {0, 5}, "s_t of equation (1): width of the tolerance band"),
            number<&S::below_band>("below_band", "", {0, 1},
                                   "d of equation (1): share of the predecessor's speed below the band"),
            number<&S::calibrated_time_gap_s>("calibrated_time_gap", "s", {0, 5},
                                              "time gap of the policy that constant_time was calibrated with; others "
                                              "differ from it in tau"),
            number<&S::calibrated_standstill_gap_m>("calibrated_standstill_gap", "m", {0.1, 20},
                                                    "standstill gap of the calibrated policies; others differ from it"),
        },
        [](const S& s, Checker& check) {
            if (s.band_m >= s.constant_distance.standstill_gap_m) {
                check.error("band", "must be below constant_distance.standstill_gap");
            }
        });
    return table;
}

}  // namespace stopline
