// Fields of a vehicle.
#include <string>
#include <vector>

#include "scenario/field_rows.h"
#include "scenario/fields.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {
namespace {

using S = PowertrainSettings;

std::string rpm(double value) { return short_text(value, unit("rpm")); }

void check_gears(const S& car, Checker& check) {
    const std::size_t gears = car.gear_ratio.size();
    const auto same_length = [&](const std::vector<double>& values, const std::string& field) {
        if (values.size() == gears) return;
        check.error(field, "has " + std::to_string(values.size()) + " values for " + std::to_string(gears) + " gears");
    };
    same_length(car.rotating_mass_factor, "rotating_mass_factors");
    same_length(car.lag_gear_factor, "lag_gear_factors");
    for (std::size_t i = 1; i < gears; ++i) {
        if (car.gear_ratio[i] >= car.gear_ratio[i - 1]) check.error("gear_ratios", "must fall from gear to gear");
    }
    if (gears == 1) return;
    for (const std::string field :
         {"shift_up_part_load", "shift_up_full_load", "shift_down", "torque_interruption", "minimum_gear_time"}) {
        if (!check.given(field)) check.error(field, "is missing: a vehicle with several gears needs it");
    }
    if (car.shift_up_full_load_rpm < car.shift_up_part_load_rpm) {
        check.error("shift_up_full_load", "must be at least shift_up_part_load");
    }
    if (car.shift_up_full_load_rpm > car.limiter_rpm) check.error("shift_up_full_load", "lies beyond limiter_speed");
    if (car.shift_down_rpm <= car.idle_rpm) check.error("shift_down", "must be greater than idle_speed");
    // After an upshift the engine must turn faster than the downshift speed, or the gearbox would hunt.
    for (std::size_t i = 1; i < gears; ++i) {
        const double after_rpm = car.shift_up_part_load_rpm * car.gear_ratio[i] / car.gear_ratio[i - 1];
        if (after_rpm > car.shift_down_rpm) continue;
        check.error("shift_down", rpm(car.shift_down_rpm) + " is not below " + rpm(after_rpm) +
                                      ", the speed after shifting up to gear " + std::to_string(i + 1) +
                                      ": the gearbox would hunt");
    }
}

void check_engine(const S& car, Checker& check) {
    if (car.limiter_rpm <= car.idle_rpm) check.error("limiter_speed", "must be greater than idle_speed");
    if (car.launch_rpm >= car.limiter_rpm) check.error("launch_speed", "must be below limiter_speed");
    if (car.launch_rpm < car.idle_rpm) check.error("launch_speed", "must be at least idle_speed");
    const auto covers = [&](const SampledCurve& curve, const std::string& field) {
        if (curve.x.front() > car.idle_rpm || curve.x.back() < car.limiter_rpm) {
            check.error(field, "covers " + rpm(curve.x.front()) + " to " + rpm(curve.x.back()) +
                                   ", but the engine turns " + rpm(car.idle_rpm) + " to " + rpm(car.limiter_rpm));
        }
    };
    covers(car.full_load, "full_load");
    covers(car.drag_torque, "drag_torque");
}

void check_vehicle(const S& car, Checker& check) {
    check_gears(car, check);
    check_engine(car, check);
    if (car.lag_drive_s.size() != car.lag_rpm.size() * car.lag_torque_share.size()) {
        check.error("lag_times", "has " + std::to_string(car.lag_drive_s.size()) + " values, but the grid has " +
                                     std::to_string(car.lag_rpm.size()) + " speeds x " +
                                     std::to_string(car.lag_torque_share.size()) + " shares");
    }
}

}  // namespace

const Table& vehicle_table() {
    static const Table table = make_table<S>(
        "a vehicle and its powertrain",
        {
            text<&S::name>("name", TextField::Rule::name, "name of the vehicle; if not given, that of the file"),
            number<&S::length_m>("length", "m", {0.5, 30}, "bumper to bumper").required(),
            number<&S::mass_kg>("mass", "kg", {50, 60'000}, "kerb mass").required(),
            number<&S::load_kg>("load", "kg", {0, 40'000}, "driver and luggage").required(),
            number<&S::drag_coefficient>("drag_coefficient", "", {0, 3}, "air drag coefficient").required(),
            number<&S::frontal_area_m2>("frontal_area", "m2", {0.1, 20}, "frontal area").required(),
            number<&S::rolling_r0>("rolling_resistance", "", {0, 0.1}, "rolling resistance coefficient at rest")
                .required(),
            number<&S::rolling_r1_s_per_m>("rolling_resistance_growth", "s/m", {0, 0.01}, "its growth with the speed")
                .required(),
            number<&S::wheel_diameter_m>("wheel_diameter", "m", {0.1, 3}, "rolling diameter").required(),
            curve<&S::full_load>("full_load", {"rpm", {0, 30'000}}, {"N m", {0, 5000}}, {2, 200},
                                 "largest torque at an engine speed")
                .required(),
            curve<&S::drag_torque>("drag_torque", {"rpm", {0, 30'000}}, {"N m", {-5000, 0}}, {2, 200},
                                   "torque without fuel, or the limit of recuperation, at an engine speed")
                .required(),
            number<&S::idle_rpm>("idle_speed", "rpm", {0, 5000}, "0 rpm for an electric motor").required(),
            number<&S::limiter_rpm>("limiter_speed", "rpm", {100, 30'000}, "no torque beyond it").required(),
            numbers<&S::gear_ratio>("gear_ratios", "", {0.1, 30}, {1, PowertrainTables::kMaxGears},
                                    "engine speed over propeller shaft speed, per gear; a single gear never shifts")
                .required(),
            numbers<&S::rotating_mass_factor>("rotating_mass_factors", "", {1, 5}, {1, PowertrainTables::kMaxGears},
                                              "effective over real mass with the rotating parts, per gear")
                .required(),
            number<&S::final_drive>("final_drive", "", {0.1, 30}, "ratio of the final drive").required(),
            number<&S::driveline_efficiency>("driveline_efficiency", "%", {10, 100}, "engine to wheels").required(),
            number<&S::launch_rpm>("launch_speed", "rpm", {0, 10'000},
                                   "engine speed that the slipping clutch holds while moving off; 0 rpm: no clutch")
                .required(),
            number<&S::shift_up_part_load_rpm>("shift_up_part_load", "rpm", {1, 30'000},
                                               "upshift speed when little torque is asked for"),
            number<&S::shift_up_full_load_rpm>("shift_up_full_load", "rpm", {1, 30'000},
                                               "upshift speed at full load; linear between the two"),
            number<&S::shift_down_rpm>("shift_down", "rpm", {1, 30'000}, "downshift speed"),
            number<&S::torque_interruption_s>("torque_interruption", "s", {0, 5},
                                              "no drive torque that long at a shift"),
            number<&S::minimum_gear_time_s>("minimum_gear_time", "s", {0, 60}, "no other shift sooner than this"),
            numbers<&S::lag_rpm>("lag_speeds", "rpm", {0, 30'000}, {1, 100}, "engine speeds of the lag map", true)
                .required(),
            numbers<&S::lag_torque_share>("lag_torque_shares", "%", {0, 100}, {1, 100},
                                          "shares of the full-load torque of the lag map", true)
                .required(),
            numbers<&S::lag_drive_s>("lag_times", "s", {0.001, 10}, {1, 10'000},
                                     "lag of the drive torque: for each speed, the values at all shares")
                .required(),
            numbers<&S::lag_gear_factor>("lag_gear_factors", "", {0.01, 10}, {1, PowertrainTables::kMaxGears},
                                         "factor on the lag, per gear")
                .required(),
            number<&S::brake_lag_s>("brake_lag", "s", {0.001, 5}, "lag of the brake torque").required(),
            number<&S::brake_friction>("brake_friction", "", {0.05, 2},
                                       "tyre-road friction coefficient: limits braking and traction")
                .required(),
        },
        check_vehicle);
    return table;
}

}  // namespace stopline
