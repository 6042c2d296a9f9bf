// The vehicle of the reference engine in full dynamics: gearbox, torque, brake and force balance. The equations are
// those of the comments in core/vehicle/powertrain_settings.h and core/vehicle/powertrain_step.h.
#pragma once

#include "base/units.h"
#include "reference/world.h"
#include "vehicle/powertrain_settings.h"

namespace stopline::reference_engine {

// A vehicle type, with its curves on uniform grids.
struct VehicleModel {
    PowertrainSettings settings;
    double mass_kg = 0.0;
    double friction_mps2 = 0.0;
    GridCurve full_load_Nm;  // over engine speed, rpm
    GridCurve drag_Nm;       // over engine speed, rpm; at most 0
    GridCurve lag_unloaded_s;
    GridCurve lag_loaded_s;

    int top_gear() const { return static_cast<int>(settings.gear_ratio.size()) - 1; }
    double rpm_per_mps(int gear) const {
        const double ratio = settings.gear_ratio[static_cast<std::size_t>(gear)] * settings.final_drive;
        return ratio / (0.5 * settings.wheel_diameter_m) / kRadpsPerRpm;
    }
    // Returns the wheel force for 1 N m of engine torque, without losses.
    double force_per_torque_1pm(int gear) const { return rpm_per_mps(gear) * kRadpsPerRpm; }
    double rotating_mass(int gear) const { return settings.rotating_mass_factor[static_cast<std::size_t>(gear)]; }
    double resistance_N(double speed_mps) const {
        const double air = 0.5 * kAirDensity_kgpm3 * settings.drag_coefficient * settings.frontal_area_m2;
        const double rolling =
            mass_kg * kGravity_mps2 * (settings.rolling_r0 + settings.rolling_r1_s_per_m * speed_mps);
        return air * speed_mps * speed_mps + rolling;
    }
};

inline VehicleModel make_vehicle_model(const PowertrainSettings& s) {
    VehicleModel vehicle;
    vehicle.settings = s;
    vehicle.mass_kg = s.mass_kg + s.load_kg;
    vehicle.friction_mps2 = s.brake_friction * kGravity_mps2;
    vehicle.full_load_Nm = vehicle.drag_Nm = GridCurve(s.limiter_rpm, 32);
    for (std::size_t node = 0; node < 32; ++node) {
        const double rpm = vehicle.full_load_Nm.x_of(node);
        vehicle.full_load_Nm.values()[node] = interpolated(s.full_load.x, s.full_load.y, rpm);
        const bool has_drag = !s.drag_torque.x.empty();
        vehicle.drag_Nm.values()[node] =
            has_drag ? std::min(0.0, interpolated(s.drag_torque.x, s.drag_torque.y, rpm)) : 0.0;
    }
    vehicle.lag_unloaded_s = vehicle.lag_loaded_s = GridCurve(s.limiter_rpm, 16);
    const std::size_t columns = s.lag_torque_share.size();
    for (std::size_t node = 0; node < 16; ++node) {
        std::vector<double> unloaded_s;
        std::vector<double> loaded_s;
        for (std::size_t row = 0; row < s.lag_rpm.size(); ++row) {
            const auto begin = s.lag_drive_s.begin() + static_cast<std::ptrdiff_t>(row * columns);
            const std::vector<double> lags_s(begin, begin + static_cast<std::ptrdiff_t>(columns));
            unloaded_s.push_back(interpolated(s.lag_torque_share, lags_s, 0.0));
            loaded_s.push_back(interpolated(s.lag_torque_share, lags_s, 1.0));
        }
        const double rpm = vehicle.lag_unloaded_s.x_of(node);
        vehicle.lag_unloaded_s.values()[node] = interpolated(s.lag_rpm, unloaded_s, rpm);
        vehicle.lag_loaded_s.values()[node] = interpolated(s.lag_rpm, loaded_s, rpm);
    }
    return vehicle;
}

// Returns the highest acceleration at a speed on a level road, in the best gear.
inline double available_mps2(const VehicleModel& vehicle, double speed_mps) {
    const PowertrainSettings& s = vehicle.settings;
    const double resistance_N = vehicle.resistance_N(speed_mps);
    double highest_mps2 = -resistance_N / vehicle.mass_kg;
    for (int gear = 0; gear <= vehicle.top_gear(); ++gear) {
        const double locked_rpm = speed_mps * vehicle.rpm_per_mps(gear);
        if (locked_rpm > s.limiter_rpm || (gear > 0 && locked_rpm < s.idle_rpm)) continue;
        const double torque_Nm = vehicle.full_load_Nm.at(gear == 0 ? std::max(locked_rpm, s.launch_rpm) : locked_rpm);
        const double force_N = torque_Nm * vehicle.force_per_torque_1pm(gear) * s.driveline_efficiency - resistance_N;
        highest_mps2 = std::max(highest_mps2, force_N / vehicle.mass_kg / vehicle.rotating_mass(gear));
    }
    return std::min(highest_mps2, vehicle.friction_mps2);
}

// Returns the highest acceleration times `power_share`, on a grid of speeds.
inline constexpr double kPowerTop_mps = 250.0 / 3.6;
inline GridCurve power_curve(const VehicleModel& vehicle, double power_share) {
    GridCurve power(kPowerTop_mps, 32);
    for (std::size_t node = 0; node < 32; ++node) {
        power.values()[node] = power_share * std::max(available_mps2(vehicle, power.x_of(node)), 0.0);
    }
    return power;
}

// Returns the highest gear in which the engine speed is at least 10 % above the engine speed for downshifts.
inline int cruising_gear_of(const VehicleModel& vehicle, double speed_mps) {
    int gear = vehicle.top_gear();
    while (gear > 0 && speed_mps * vehicle.rpm_per_mps(gear) < 1.1 * vehicle.settings.shift_down_rpm) --gear;
    return gear;
}

// The state between engine and wheels at the start of a step.
struct Drivetrain {
    double locked_rpm = 0.0;    // engine speed with closed clutch
    double rpm = 0.0;           // engine speed
    double connected = 1.0;     // share of the step without torque interruption
    double inertia_kg = 0.0;    // mass with the rotating parts that are coupled to the wheels
    double resistance_N = 0.0;  // air, rolling and slope
    double full_Nm = 0.0;
    double drag_Nm = 0.0;
    double gain_1pm = 0.0;  // wheel force for 1 N m of engine torque
};

inline Drivetrain drivetrain_of(const VehicleModel& vehicle, const Vehicle& v, double grade_N, double dt) {
    const PowertrainSettings& s = vehicle.settings;
    Drivetrain d;
    d.locked_rpm = v.speed_mps * vehicle.rpm_per_mps(v.gear);
    const double reference_rpm = v.gear == 0 ? s.launch_rpm : s.idle_rpm;
    d.rpm = std::clamp(d.locked_rpm, reference_rpm, s.limiter_rpm);
    d.connected = std::clamp((v.gear_time_s + dt - s.torque_interruption_s) / dt, 0.0, 1.0);
    // The clutch is open up to 3/4 of the reference engine speed, and closed from the reference speed on.
    const bool has_clutch = s.launch_rpm > 0.0;
    const double clutch_rpm = v.gear == 0 ? s.launch_rpm : std::max(s.idle_rpm, 1.0);
    const double closed = has_clutch ? std::clamp(4.0 * d.locked_rpm / clutch_rpm - 3.0, 0.0, 1.0) : 1.0;
    const double coupling = d.connected * closed;
    const double open_mass = *std::min_element(s.rotating_mass_factor.begin(), s.rotating_mass_factor.end());
    d.inertia_kg = vehicle.mass_kg * (open_mass + coupling * (vehicle.rotating_mass(v.gear) - open_mass));
    d.resistance_N = vehicle.resistance_N(v.speed_mps) + grade_N;
    d.full_Nm = vehicle.full_load_Nm.at(d.rpm);
    d.drag_Nm = coupling * vehicle.drag_Nm.at(d.rpm);
    d.gain_1pm = vehicle.force_per_torque_1pm(v.gear);
    return d;
}

// The request of the low-level controller to engine and brake, computed by inverse dynamics.
struct ActuatorRequest {
    double wanted_Nm = 0.0;  // torque for the requested acceleration
    double torque_Nm = 0.0;  // torque requested from the engine
    double brake_N = 0.0;
    double share = 0.0;  // torque_Nm as a share of the full-load torque
};

inline ActuatorRequest actuator_request(const VehicleModel& vehicle, const Drivetrain& d, double request_mps2) {
    const PowertrainSettings& s = vehicle.settings;
    const double resistance_mps2 = d.resistance_N / vehicle.mass_kg;
    const double reachable_mps2 = std::min(std::max(request_mps2, -vehicle.friction_mps2 - resistance_mps2),
                                           vehicle.friction_mps2 - resistance_mps2);
    const double wanted_N = d.inertia_kg * reachable_mps2 + d.resistance_N;
    ActuatorRequest request;
    request.wanted_Nm =
        wanted_N / d.gain_1pm * (wanted_N > 0.0 ? 1.0 / s.driveline_efficiency : s.driveline_efficiency);
    const double limited_Nm =
        d.locked_rpm < s.limiter_rpm ? std::min(std::max(request.wanted_Nm, d.drag_Nm), d.full_Nm) : d.drag_Nm;
    request.torque_Nm = d.connected * limited_Nm;
    const double engine_brake_N = d.connected * d.drag_Nm * d.gain_1pm / s.driveline_efficiency;
    request.brake_N = std::max(engine_brake_N - wanted_N, 0.0);
    request.share = std::clamp(request.torque_Nm / std::max(d.full_Nm, 1.0), 0.0, 1.0);
    return request;
}

// Changes the gear of `v`, which still has the speed at the start of the step. `is_moving`: the speed at the end of the
// step is above 0.
inline void change_gear_of(const VehicleModel& vehicle, const Drivetrain& d, const ActuatorRequest& request,
                           double request_mps2, bool is_moving, double dt, Vehicle& v) {
    const PowertrainSettings& s = vehicle.settings;
    const double load = std::clamp(2.5 * request.share - 1.25, 0.0, 1.0);
    const double up_rpm = s.shift_up_part_load_rpm + load * (s.shift_up_full_load_rpm - s.shift_up_part_load_rpm);
    const bool may_change = v.gear_time_s + 0.5 * dt >= s.minimum_gear_time_s;
    const bool is_driving = request.brake_N <= 0.0;
    const int next = std::min(v.gear + 1, vehicle.top_gear());
    const double next_N = vehicle.mass_kg * vehicle.rotating_mass(next) * request_mps2 + d.resistance_N;
    const double next_Nm = next_N / vehicle.force_per_torque_1pm(next) / s.driveline_efficiency;
    const bool next_suffices = next_Nm <= 0.95 * vehicle.full_load_Nm.at(v.speed_mps * vehicle.rpm_per_mps(next));
    const bool is_up_due = (d.locked_rpm > up_rpm && next_suffices) || d.locked_rpm > s.shift_up_full_load_rpm;
    const bool up = is_up_due && may_change && is_driving && v.gear < vehicle.top_gear();
    const double lower_rpm = v.speed_mps * vehicle.rpm_per_mps(std::max(v.gear - 1, 0));
    const bool kick_down =
        request.wanted_Nm > 1.5 * d.full_Nm && lower_rpm < 0.8 * s.shift_up_full_load_rpm && may_change;
    const bool is_too_slow = d.locked_rpm < s.shift_down_rpm && (may_change || !is_driving);
    const bool down = (kick_down || is_too_slow) && v.gear > 0 && !up;
    // A gear change while braking or at standstill interrupts no torque, so it does not restart the gear time.
    const bool restarts = (up || down) && is_driving && is_moving;
    v.gear_time_s = restarts ? 0.0 : std::min(v.gear_time_s + dt, 1000.0);
    v.gear = is_moving ? v.gear + (up ? 1 : 0) - (down ? 1 : 0) : 0;
}

// Computes one step of the vehicle. Sets its acceleration, torque, brake force, lag and gear, but neither speed nor
// position. Returns the acceleration that the full engine torque gives.
inline double drive(const VehicleModel& vehicle, double request_mps2, double sine, double dt, Vehicle& v) {
    const PowertrainSettings& s = vehicle.settings;
    const Drivetrain d = drivetrain_of(vehicle, v, vehicle.mass_kg * kGravity_mps2 * sine, dt);
    const ActuatorRequest request = actuator_request(vehicle, d, request_mps2);
    // In one step, a first-order lag closes the share dt / (lag + dt / 2) of the difference.
    const double drive_lag_s = (vehicle.lag_unloaded_s.at(d.rpm) +
                                request.share * (vehicle.lag_loaded_s.at(d.rpm) - vehicle.lag_unloaded_s.at(d.rpm))) *
                               s.lag_gear_factor[static_cast<std::size_t>(v.gear)];
    const double torque_before_Nm = v.torque_Nm;
    const double brake_before_N = v.brake_N;
    v.torque_Nm += (request.torque_Nm - v.torque_Nm) * dt / (drive_lag_s + 0.5 * dt);
    v.brake_N += (request.brake_N - v.brake_N) * dt / (s.brake_lag_s + 0.5 * dt);
    v.lag_s = request.brake_N > 0.0 ? s.brake_lag_s : drive_lag_s;
    // The force balance uses the means of torque and brake force over the step.
    const double transmitted_Nm = d.connected * 0.5 * (torque_before_Nm + v.torque_Nm);
    const double drive_N =
        transmitted_Nm * d.gain_1pm * (transmitted_Nm > 0.0 ? s.driveline_efficiency : 1.0 / s.driveline_efficiency);
    const double force_N = drive_N - 0.5 * (brake_before_N + v.brake_N) - d.resistance_N;
    const double lowest_mps2 = -vehicle.friction_mps2 - d.resistance_N / vehicle.mass_kg;
    const double acceleration_mps2 = std::max(force_N / d.inertia_kg, lowest_mps2);
    // Brakes and resistances stop a vehicle but never push it back.
    const bool stops = v.speed_mps + acceleration_mps2 * dt <= 0.0;
    v.acceleration_mps2 = stops ? -v.speed_mps / dt : acceleration_mps2;
    change_gear_of(vehicle, d, request, request_mps2, !stops, dt, v);
    const double highest_Nm = d.locked_rpm < s.limiter_rpm ? d.full_Nm : d.drag_Nm;
    const double highest_N = highest_Nm * d.gain_1pm * s.driveline_efficiency - d.resistance_N;
    return std::min(highest_N / d.inertia_kg, vehicle.friction_mps2 - d.resistance_N / vehicle.mass_kg);
}

}  // namespace stopline::reference_engine
