// Shipped vehicles for tests of a single powertrain. Their driving resistances are computed from the settings alone, so
// that a test does not depend on the code that it tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <vector>

#include "base/units.h"
#include "scenario/load_scenario.h"
#include "vehicle/powertrain_step.h"
#include "vehicle/powertrain_tables.h"

namespace stopline::testing_support {

using CarState = PowertrainState<double>;

struct Car {
    PowertrainSettings settings;
    PowertrainTables tables;

    explicit Car(PowertrainSettings s) : settings(std::move(s)), tables(compile_powertrain(settings)) {}
    explicit Car(const std::string& name) : Car(load_vehicle(name)) {}

    double mass_kg() const { return settings.mass_kg + settings.load_kg; }
    double grade_N(double gradient) const { return mass_kg() * kGravity_mps2 * gradient / std::hypot(1.0, gradient); }
    double rolling_N() const { return mass_kg() * kGravity_mps2 * settings.rolling_r0; }
    double rolling_Nspm() const { return mass_kg() * kGravity_mps2 * settings.rolling_r1_s_per_m; }
    double air_Ns2pm2() const { return 0.5 * kAirDensity_kgpm3 * settings.drag_coefficient * settings.frontal_area_m2; }
    double resistance_N(double v_mps) const {
        return rolling_N() + rolling_Nspm() * v_mps + air_Ns2pm2() * v_mps * v_mps;
    }
    double rpm(double v_mps, int gear) const {
        return v_mps / (0.5 * settings.wheel_diameter_m) * ratio(gear) / kRadpsPerRpm;
    }
    double ratio(int gear) const { return settings.gear_ratio[static_cast<std::size_t>(gear)] * settings.final_drive; }
    double rotating(int gear) const { return settings.rotating_mass_factor[static_cast<std::size_t>(gear)]; }
    // Returns the force at the wheels at full load, N.
    double full_force_N(double v_mps, int gear) const {
        const double floor_rpm = gear == 0 ? settings.launch_rpm : settings.idle_rpm;
        const double torque_Nm = interpolate(settings.full_load, std::max(floor_rpm, rpm(v_mps, gear)));
        return torque_Nm * ratio(gear) * settings.driveline_efficiency / (0.5 * settings.wheel_diameter_m);
    }
    double friction_N() const { return settings.brake_friction * mass_kg() * kGravity_mps2; }
    bool electric() const { return settings.gear_ratio.size() == 1; }
};

// Returns the state of a vehicle that has driven at the speed `v_mps` for a long time.
inline CarState cruising(const Car& car, double v_mps) {
    CarState s{};
    s.speed_mps = v_mps;
    s.gear = cruising_gear(car.tables, v_mps);
    s.gear_time_s = 1000.0;
    s.lag_s = 0.2;
    return s;
}

// Returns the longest lag of the torque in first gear, s.
inline double longest_lag_s(const Car& car) {
    const std::vector<double>& lags_s = car.settings.lag_drive_s;
    return *std::max_element(lags_s.begin(), lags_s.end()) * car.settings.lag_gear_factor.front();
}

inline CarState advance(const Car& car, const CarState& s, double request_mps2, double grade_N, double dt) {
    return powertrain_step<double>(car.tables, s, request_mps2, grade_N, dt);
}

// Returns the parameter as a valid test name.
inline std::string as_test_name(const testing::TestParamInfo<std::string>& name) {
    std::string text = name.param;
    for (char& c : text) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    return text;
}

inline std::vector<std::string> car_names() { return data_names("vehicles"); }

}  // namespace stopline::testing_support
