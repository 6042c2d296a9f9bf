// Fields of drivers and traffic rules.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "driver/human.h"
#include "scenario/schema/field_rows.h"
#include "scenario/schema/fields.h"

namespace stopline {
namespace {

const Table& cacc_table() {
    using S = CaccSettings;
    static const Table table = make_table<S>(
        "CACC car following: gap feedback and feedforward from the leader (Fig. 3 and 4)",
        {
            number<&S::feedback_kp_1ps2>("feedback_kp", "1/s2", {0, 10},
                                         "feedback gain: acceleration per metre of gap error"),
            number<&S::feedback_kd_1ps>("feedback_kd", "1/s", {0, 10},
                                        "feedback gain: acceleration per m/s of change of the gap error"),
            number<&S::radar_delay_s>("radar_delay", "s", {0, 1}, "age of a gap measured by radar"),
            number<&S::radar_range_m>("radar_range", "m", {1, 1000}, "range of the radar"),
            number<&S::v2v_delay_s>("v2v_delay", "s", {0, 1}, "age of a received V2V message"),
            number<&S::prediction_start_s>(
                "prediction_start", "s", {0, 5},
                "constant distance: time from now to the start of the interval in which the vehicle matches its "
                "leader's predicted acceleration (Fig. 4)"),
            number<&S::prediction_end_s>("prediction_end", "s", {0.01, 5}, "time from now to the end of that interval"),
            number<&S::acceleration_max_mps2>("acceleration_max", "m/s2", {0.1, 10},
                                              "maximum acceleration of a follower"),
            number<&S::deceleration_comfort_mps2>(
                "deceleration_comfort", "m/s2", {0.1, 10},
                "maximum deceleration of the following law (ISO 15622); a vehicle can brake "
                "harder when it stops behind a queue, or in an emergency"),
            number<&S::deceleration_emergency_mps2>("deceleration_emergency", "m/s2", {0.1, 12},
                                                    "maximum deceleration in an emergency"),
            number<&S::emergency_threshold_mps2>("emergency_threshold", "m/s2", {0.1, 12},
                                                 "emergency braking begins when more deceleration than this is needed"),
            number<&S::emergency_gap_m>("emergency_gap", "m", {0, 10}, "net gap that emergency braking keeps"),
            number<&S::jerk_up_mps3>("jerk_up", "m/s3", {0.1, 1000},
                                     "maximum rate of rise of the acceleration command"),
            number<&S::jerk_down_mps3>("jerk_down", "m/s3", {0.1, 1000},
                                       "maximum rate of fall of the acceleration command"),
            number<&S::catch_up_factor>("catch_up_factor", "", {1, 1.5},
                                        "factor by which a follower may exceed the speed limit to close its gap"),
        },
        [](const S& s, Checker& check) {
            if (s.prediction_end_s <= s.prediction_start_s) {
                check.error("prediction_end", "must be greater than prediction_start");
            }
            if (s.deceleration_emergency_mps2 < s.deceleration_comfort_mps2) {
                check.error("deceleration_emergency", "must be at least deceleration_comfort");
            }
        });
    return table;
}

const Table& free_drive_table() {
    using S = FreeDriveSettings;
    static const Table table = make_table<S>(
        "driving without a leader",
        {
            curve<&S::speed_mps, &S::acceleration_mps2>("acceleration", {"km/h", {0, 300}}, {"m/s2", {0.01, 10}},
                                                        {1, 200},
                                                        "desired acceleration over speed, from 0 km/h; constant "
                                                        "beyond the last point (start-up curve, Section III.B)")
                .required(),
            number<&S::profile_limit_mps>("profile_limit", "km/h", {0, 300},
                                          "highest speed limit for which the acceleration curve was measured; "
                                          "0 km/h: its last speed"),
            number<&S::power_share>("power_share", "%", {1, 100},
                                    "on roads with a higher limit: lowest acceleration, as a share of the highest "
                                    "acceleration that the vehicle can give at its speed"),
            number<&S::speed_gain_1ps>("speed_gain", "1/s", {0.01, 10}, "acceleration per m/s below the desired speed"),
            number<&S::deceleration_mps2>("deceleration", "m/s2", {0.1, 10}, "deceleration before a lower speed limit"),
            number<&S::hesitation_s>("hesitation", "s", {0, 10},
                                     "first vehicle at the stop line: time from green to the release of the brake"),
        },
        [](const S& s, Checker& check) {
            if (s.speed_mps.front() != 0.0) check.error("acceleration", "must begin at 0 km/h");
        });
    return table;
}

const Table& stop_table() {
    using S = StopSettings;
    static const Table table =
        make_table<S>("stopping at a stop line",
                      {
                          number<&S::deceleration_mps2>("deceleration", "m/s2", {0.1, 10},
                                                        "braking begins when this deceleration is needed"),
                          number<&S::decision_deceleration_mps2>(
                              "decision_deceleration", "m/s2", {0.1, 10},
                              "on yellow, a vehicle stops if this deceleration suffices; otherwise it goes on"),
                          number<&S::margin_m>("margin", "m", {0.1, 20},
                                               "distance from the front of the stopped vehicle to the stop line"),
                      });
    return table;
}

const Table& lane_change_table() {
    using S = LaneChangeSettings;
    static const Table table = make_table<S>(
        "lane changes on the approaches of streets",
        {
            number<&S::look_ahead_s>("look_ahead_time", "s", {0, 1000},
                                     "mandatory changes: time for each change that a vehicle needs; the search for a "
                                     "gap begins when the usable distance before the stop line is shorter than the "
                                     "distance that the vehicle covers in this time"),
            number<&S::left_factor>("left_factor", "", {0.1, 10},
                                    "mandatory changes: factor on look_ahead_time for changes to the left"),
            number<&S::gap_share>(
                "gap_share", "%", {0, 200},
                "smallest accepted lead gap and lag gap, as a share of the gap that the policy keeps"),
            number<&S::urgent_gap_share>(
                "urgent_gap_share", "%", {0, 200},
                "mandatory changes: value of gap_share where no usable distance is left; gap_share changes linearly to "
                "this value from the begin of the search"),
            choice<&S::look_ahead>(
                "look_ahead", {"off", "on"},
                "on: vehicles choose a lane also for their turn at the intersection after the next one"),
            choice<&S::gap_opening>(
                "gap_opening", {"off", "on", "cooperative"},
                "on: a follower in the target lane opens a gap for a mandatory change; cooperative: vehicles with V2V "
                "agree on the gap")
                .renamed_from("help"),
            number<&S::courtesy>("courtesy", "%", {0, 100},
                                 "probability with which a driver without V2V opens a gap for another vehicle")
                .only_if("gap_opening", {"cooperative"}),
            number<&S::threshold_mps2>("threshold", "m/s2", {0, 10},
                                       "discretionary changes (MOBIL): smallest gain in acceleration that counts"),
            number<&S::gain_mps>("gain", "km/h", {0, 100},
                                 "discretionary changes: a vehicle changes when the gains in acceleration beyond "
                                 "threshold, summed up over time, reach this speed"),
            number<&S::politeness>("politeness", "", {0, 1},
                                   "discretionary changes (MOBIL): weight of the gains and losses of other vehicles"),
            number<&S::keep_right_mps2>("keep_right", "m/s2", {0, 5},
                                        "discretionary changes (MOBIL): bonus of a change to the right"),
            number<&S::acceleration_mps2>("acceleration", "m/s2", {0.1, 10},
                                          "acceleration of the intelligent driver model that rates a change"),
            number<&S::deceleration_mps2>("deceleration", "m/s2", {0.1, 10},
                                          "comfortable deceleration of the intelligent driver model"),
            number<&S::pause_s>("pause", "s", {0, 1000},
                                "shortest time from a change to the next discretionary change"),
        });
    return table;
}

const Table& give_way_table() {
    using S = GiveWaySettings;
    static const Table table = make_table<S>(
        "yielding inside intersections",
        {
            number<&S::critical_gap_s>("critical_gap", "s", {0, 60},
                                       "shortest accepted time between two vehicles with priority, for a yielding "
                                       "vehicle that starts from rest; in SUMO networks, at least the time in which "
                                       "the yielding vehicle leaves the conflict area; in other networks, at least the "
                                       "time of the next vehicle for an emergency stop"),
            number<&S::critical_lag_s>(
                "critical_lag", "s", {0, 60},
                "replaces critical_gap for a yielding vehicle that is faster than 1 m/s: shortest accepted time from "
                "its arrival at its waiting position until the next vehicle with priority reaches the conflict area; "
                "0 s: derived from critical_gap, shorter by the time that a moving vehicle gains over a start from "
                "rest"),
            number<&S::margin_m>("margin", "m", {0, 10},
                                 "distance from the front of a waiting vehicle to the conflict area"),
            number<&S::approach_acceleration_mps2>(
                "approach_acceleration", "m/s2", {0.1, 10},
                "assumed acceleration of approaching vehicles with priority, up to the speed limit")
                .renamed_from("approach"),
        });
    return table;
}

const Table& human_table() {
    using S = HumanSettings;
    static const Table table = make_table<S>(
        "human drivers",
        {
            section<&S::idm>("idm", idm_table,
                             "acceleration of human drivers; in full dynamics at most cacc.acceleration_max"),
            number<&S::start_reaction_s>(
                "start_reaction", "s", {0, 2},
                "mean reaction time to the start of the vehicle ahead, or to the start of green"),
            number<&S::reaction_s>("reaction", "s", {0, 2}, "mean reaction time while following"),
            number<&S::reaction_spread_s>(
                "reaction_spread", "s", {0, 2},
                "largest deviation of a reaction time from its mean; `start_reaction` deviates by the same percentage"),
            number<&S::gap_error>("gap_error", kPlainShare, {0, 0.5},
                                  "standard deviation of the estimated gap, relative"),
            number<&S::closing_error_1ps>("closing_error", "1/s", {0, 0.1},
                                          "standard deviation of the estimated closing speed per metre of gap"),
            number<&S::error_time_s>("error_time", "s", {0.1, 1000}, "correlation time of both errors"),
            whole_number<&S::anticipated_vehicles>("anticipated_vehicles", {1, kMaxAnticipatedVehicles},
                                                   "full dynamics: number of vehicles ahead to which a driver reacts"),
        },
        [](const S& s, Checker& check) {
            // The reaction time for the design of roads (AASHTO, A Policy on Geometric Design of Highways and Streets).
            constexpr double kLongest_s = 2.5;
            const std::string both =
                fmt::format("reaction is {:g} s and reaction_spread {:g} s: ", s.reaction_s, s.reaction_spread_s);
            if (s.reaction_spread_s > s.reaction_s)
                check.error("reaction_spread", both + "the spread must be at most the mean");
            if (s.reaction_s + s.reaction_spread_s > kLongest_s)
                check.error("reaction_spread", both + fmt::format("their sum must be at most {:g} s", kLongest_s));
        });
    return table;
}

// Checks that emergency braking begins at a deceleration that normal car following can still reach. Checks that the
// decelerations for stopping and for slowing down are at most the maximum deceleration of emergency braking.
void check_driver(const DriverSettings& driver, Checker& check) {
    const CaccSettings& cacc = driver.cacc;
    const auto compare = [&](const std::string& field, double value, const std::string& other, double most) {
        if (value <= most) return;
        check.error(field, "value " + short_text(value, unit("m/s2")) + " must be at most " + other + ", " +
                               short_text(most, unit("m/s2")));
    };
    compare("cacc.emergency_threshold", cacc.emergency_threshold_mps2, "cacc.deceleration_comfort",
            cacc.deceleration_comfort_mps2);
    compare("stop.deceleration", driver.stop.deceleration_mps2, "cacc.deceleration_emergency",
            cacc.deceleration_emergency_mps2);
    compare("stop.decision_deceleration", driver.stop.decision_deceleration_mps2, "cacc.deceleration_emergency",
            cacc.deceleration_emergency_mps2);
    compare("free_drive.deceleration", driver.free_drive.deceleration_mps2, "cacc.deceleration_emergency",
            cacc.deceleration_emergency_mps2);
}

}  // namespace

const Table& driver_table() {
    using S = DriverSettings;
    static const Table table = make_table<S>(
        "the driver: controllers and behaviour",
        {
            text<&S::name>("name", TextField::Rule::name, "name of the driver; default: the name of the file"),
            section<&S::cacc>("cacc", cacc_table, "CACC car following"),
            section<&S::free_drive>("free_drive", free_drive_table, "driving without a leader").required(),
            section<&S::stop>("stop", stop_table, "stopping at a stop line"),
            section<&S::give_way>("give_way", give_way_table, "yielding inside intersections"),
            section<&S::lane_change>("lane_change", lane_change_table, "lane changes"),
            section<&S::human>("human", human_table, "human drivers: policies with the law human"),
            section<&S::v2v>("v2v", v2v_table, "V2V messages between automated vehicles"),
            section<&S::platoon>("platoon", platoon_table, "length of platoons"),
            section<&S::speed_advice>("speed_advice", speed_advice_table, "speed advice of signals (GLOSA)"),
        },
        check_driver);
    return table;
}

const Table& rules_table() {
    using S = TrafficRules;
    static const Table table = make_table<S>(
        "rules against junction blocking and gridlock",
        {
            choice<&S::keep_clear>(
                "keep_clear", {"off", "on"},
                "on: a vehicle passes the stop line only if its exit lane has room behind the last stopped vehicle; on short "
                "exit lanes moving vehicles count, too"),
            number<&S::sight_m>("sight", "m", {1, 10'000}, "distance into the exit lane that drivers check for room")
                .enabled_by("keep_clear"),
            choice<&S::count_queue_at_red_exit>(
                "count_queue_at_red_exit", {"off", "on"},
                "on: while the signal at the end of the exit lane is not green, moving vehicles in that lane count as "
                "already stopped at it")
                .enabled_by("keep_clear")
                .renamed_from("light_ahead"),
            choice<&S::clearing>("clearing", {"off", "cooperative"},
                                 "cooperative: vehicles with V2V announce where they will come to rest, and pass the "
                                 "stop line only if there is room for them beyond the intersection")
                .enabled_by("keep_clear"),
            number<&S::teleport_cycles>(
                "teleport_cycles", "", {0, 1000},
                "teleport: the first vehicle of a lane, if stopped for this number of signal cycles, is moved past the "
                "intersection; 0: never"),
            number<&S::pass_blocker_greens>(
                "pass_blocker_greens", "", {0, 1000},
                "number of green times after which crossing vehicles may pass a vehicle that blocks the intersection; "
                "0: never"),
        });
    return table;
}

}  // namespace stopline
