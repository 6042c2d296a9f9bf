// Fields of a vehicle.
#include <string>
#include <vector>

#include "scenario/schema/field_rows.h"
#include "scenario/schema/fields.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {
namespace {

using Powertrain = PowertrainSettings;

std::string rpm(double value) { return short_text(value, unit("rpm")); }

void check_gears(const Powertrain& car, Checker& check) {
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
    if (car.shift_up_full_load_rpm > car.limiter_rpm)
        check.error("shift_up_full_load", "must be at most limiter_speed");
    if (car.shift_down_rpm <= car.idle_rpm) check.error("shift_down", "must be greater than idle_speed");
    // After an upshift the engine speed must be above the downshift speed. Otherwise the gearbox would shift down
    // again.
    for (std::size_t i = 1; i < gears; ++i) {
        const double after_rpm = car.shift_up_part_load_rpm * car.gear_ratio[i] / car.gear_ratio[i - 1];
        if (after_rpm > car.shift_down_rpm) continue;
        check.error("shift_down", rpm(car.shift_down_rpm) + " is not below " + rpm(after_rpm) +
                                      ", the speed after shifting up to gear " + std::to_string(i + 1) +
                                      ": the gearbox would hunt");
    }
}

void check_engine(const Powertrain& car, Checker& check) {
    if (car.limiter_rpm <= car.idle_rpm) check.error("limiter_speed", "must be greater than idle_speed");
    if (car.launch_rpm >= car.limiter_rpm) check.error("launch_speed", "must be below limiter_speed");
    if (car.launch_rpm < car.idle_rpm) check.error("launch_speed", "must be at least idle_speed");
    const auto covers = [&](const SampledCurve& curve, const std::string& field) {
        if (curve.x.front() > car.idle_rpm || curve.x.back() < car.limiter_rpm) {
            check.error(field, "covers " + rpm(curve.x.front()) + " to " + rpm(curve.x.back()) +
                                   ", but the engine runs at " + rpm(car.idle_rpm) + " to " + rpm(car.limiter_rpm));
        }
    };
    covers(car.full_load, "full_load");
    covers(car.drag_torque, "drag_torque");
}

void check_vehicle(const Powertrain& car, Checker& check) {
    check_gears(car, check);
    check_engine(car, check);
    if (car.lag_drive_s.size() != car.lag_rpm.size() * car.lag_torque_share.size()) {
        check.error("lag_times", "has " + std::to_string(car.lag_drive_s.size()) + " values, but the map has " +
                                     std::to_string(car.lag_rpm.size()) + " speeds x " +
                                     std::to_string(car.lag_torque_share.size()) + " shares");
    }
}

}  // namespace

const Table& vehicle_table() {
    static const Table table = make_table<Powertrain>(
        "a vehicle and its powertrain",
        {
            text<&Powertrain::name>("name", TextField::Rule::name,
                                    "name of the vehicle; default: the name of the file"),
            number<&Powertrain::length_m>("length", "m", {0.5, 30}, "length from bumper to bumper").required(),
            number<&Powertrain::mass_kg>("mass", "kg", {50, 60'000}, "kerb mass").required(),
            number<&Powertrain::load_kg>("load", "kg", {0, 40'000}, "mass of driver and luggage").required(),
            number<&Powertrain::drag_coefficient>("drag_coefficient", "", {0, 3}, "air drag coefficient").required(),
            number<&Powertrain::frontal_area_m2>("frontal_area", "m2", {0.1, 20}, "frontal area").required(),
            number<&Powertrain::rolling_r0>("rolling_resistance", "", {0, 0.1},
                                            "rolling resistance coefficient at rest")
                .required(),
            number<&Powertrain::rolling_r1_s_per_m>("rolling_resistance_growth", "s/m", {0, 0.01},
                                                    "growth of rolling_resistance per m/s")
                .required(),
            number<&Powertrain::maximum_speed_mps>("maximum_speed", "km/h", {5, 500},
                                                   "speed that the speed limiter of the vehicle permits"),
            number<&Powertrain::wheel_diameter_m>("wheel_diameter", "m", {0.1, 3}, "rolling diameter of the wheels")
                .required(),
            curve<&Powertrain::full_load>("full_load", {"rpm", {0, 30'000}}, {"N m", {0, 5000}}, {2, 200},
                                          "maximum torque over engine speed")
                .required(),
            curve<&Powertrain::drag_torque>(
                "drag_torque", {"rpm", {0, 30'000}}, {"N m", {-5000, 0}}, {2, 200},
                "drag torque of the engine without fuel, over engine speed; electric motor: limit of recuperation")
                .required(),
            number<&Powertrain::idle_rpm>("idle_speed", "rpm", {0, 5000},
                                          "idle speed of the engine; electric motor: 0 rpm")
                .required(),
            number<&Powertrain::limiter_rpm>("limiter_speed", "rpm", {100, 30'000},
                                             "engine speed above which there is no torque")
                .required(),
            numbers<&Powertrain::gear_ratio>("gear_ratios", "", {0.1, 30}, {1, PowertrainTables::kMaxGears},
                                             "engine speed / propeller shaft speed, one value per gear")
                .required(),
            numbers<&Powertrain::rotating_mass_factor>(
                "rotating_mass_factors", "", {1, 5}, {1, PowertrainTables::kMaxGears},
                "effective mass with rotating parts / real mass, one value per gear")
                .required(),
            number<&Powertrain::final_drive>("final_drive", "", {0.1, 30}, "ratio of the final drive").required(),
            number<&Powertrain::driveline_efficiency>("driveline_efficiency", "%", {10, 100},
                                                      "efficiency from the engine to the wheels")
                .required(),
            number<&Powertrain::launch_rpm>("launch_speed", "rpm", {0, 10'000},
                                            "engine speed while the clutch slips at a start; 0 rpm: no clutch")
                .required(),
            number<&Powertrain::shift_up_part_load_rpm>("shift_up_part_load", "rpm", {1, 30'000},
                                                        "upshift speed of the engine at low torque"),
            number<&Powertrain::shift_up_full_load_rpm>(
                "shift_up_full_load", "rpm", {1, 30'000},
                "upshift speed of the engine at full load; linear interpolation between low torque and full load"),
            number<&Powertrain::shift_down_rpm>("shift_down", "rpm", {1, 30'000}, "downshift speed of the engine"),
            number<&Powertrain::torque_interruption_s>("torque_interruption", "s", {0, 5},
                                                       "time without drive torque during a gear change"),
            number<&Powertrain::minimum_gear_time_s>("minimum_gear_time", "s", {0, 60},
                                                     "shortest time between two gear changes"),
            numbers<&Powertrain::lag_rpm>("lag_speeds", "rpm", {0, 30'000}, {1, 100}, "engine speeds of the lag map",
                                          true)
                .required(),
            numbers<&Powertrain::lag_torque_share>("lag_torque_shares", "%", {0, 100}, {1, 100},
                                                   "torques of the lag map, as shares of the full-load torque", true)
                .required(),
            numbers<&Powertrain::lag_drive_s>(
                "lag_times", "s", {0.001, 10}, {1, 10'000},
                "lag of the drive torque: for each of lag_speeds, the values at all lag_torque_shares")
                .required(),
            numbers<&Powertrain::lag_gear_factor>("lag_gear_factors", "", {0.01, 10}, {1, PowertrainTables::kMaxGears},
                                                  "factor on the lag, one value per gear")
                .required(),
            number<&Powertrain::brake_lag_s>("brake_lag", "s", {0.001, 5}, "lag of the brake torque").required(),
            number<&Powertrain::brake_friction>("brake_friction", "", {0.05, 2},
                                                "tyre-road friction coefficient, limits braking and traction")
                .required(),
            optional_section<&Powertrain::energy>("energy", energy_table,
                                                  "energy use; `measure.energy` needs it, it changes no movement"),
        },
        check_vehicle);
    return table;
}

}  // namespace stopline
