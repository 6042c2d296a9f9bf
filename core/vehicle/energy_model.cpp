#include "vehicle/energy_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/simd/arithmetic.h"
#include "base/units.h"

namespace stopline {

namespace {

struct Resistances {
    double air_N, rolling_N, grade_N;
    double sum_N() const { return air_N + rolling_N + grade_N; }
};

Resistances resistances(const PowertrainTables& t, double speed_mps, double sine) {
    return {t.drag_Ns2pm2 * square(speed_mps), t.rolling_N + t.rolling_Nspm * speed_mps,
            t.mass_kg * kGravity_mps2 * sine};
}

// Returns the degree of closing of the clutch, 0 .. 1.
double clutch_closing(const PowertrainTables& t, std::size_t gear, double locked_rpm) {
    const double closing_1prpm = gear == 0 ? t.closing_launch_1prpm : t.closing_idle_1prpm;
    return std::clamp(locked_rpm * closing_1prpm - t.closing_offset, 0.0, 1.0);
}

double engine_rpm(const PowertrainTables& t, std::size_t gear, double locked_rpm) {
    return std::clamp(locked_rpm, gear == 0 ? t.launch_rpm : t.idle_rpm, t.limiter_rpm);
}

double drag_Nm(const PowertrainTables& t, double rpm) {
    return interpolate_on_grid(t.drag_Nm, rpm * t.torque_nodes_per_rpm);
}

// Returns the mass of the vehicle, with rotating parts. `coupling` is the degree to which the engine is connected.
double inertia_kg(const PowertrainTables& t, std::size_t gear, double coupling) {
    return t.mass_kg * (t.rotating_mass_open + coupling * (t.rotating_mass[gear] - t.rotating_mass_open));
}

// Returns the work of a step in which the vehicle moves by the mean of both speeds. `drive_N` and `brake_N` are mean
// forces.
StepWork work_of(const PowertrainTables& t, const Resistances& resistance, double drive_N, double brake_N,
                 double inertia, double acceleration_mps2, double distance_m) {
    StepWork work;
    work.distance_m = distance_m;
    (drive_N > 0.0 ? work.driven_J : work.overrun_J) = drive_N * distance_m;
    work.brake_J = brake_N * distance_m;
    work.air_J = resistance.air_N * distance_m;
    work.rolling_J = resistance.rolling_N * distance_m;
    work.grade_J = resistance.grade_N * distance_m;
    work.kinetic_J = t.mass_kg * acceleration_mps2 * distance_m;
    work.rotating_J = (inertia - t.mass_kg) * acceleration_mps2 * distance_m;
    return work;
}

// Returns the wheel force that an acceleration needs in a gear.
double wanted_N(const PowertrainTables& t, std::size_t gear, double speed_mps, double acceleration_mps2,
                double resistance_N) {
    const double closing = clutch_closing(t, gear, speed_mps * t.rpm_per_mps[gear]);
    return inertia_kg(t, gear, closing) * acceleration_mps2 + resistance_N;
}

// Returns the torque that this force needs, over the full-load torque in the gear.
double torque_share(const PowertrainTables& t, std::size_t gear, double speed_mps, double wheel_N) {
    const double rpm = engine_rpm(t, gear, speed_mps * t.rpm_per_mps[gear]);
    const double torque_Nm = wheel_N / (t.rpm_per_mps[gear] * kRadpsPerRpm * t.efficiency);
    return torque_Nm / std::max(interpolate_on_grid(t.full_load_Nm, rpm * t.torque_nodes_per_rpm), 1.0);
}

// Changes the gear as the gearbox of full dynamics does (change_gear() in powertrain_step.h), for an acceleration that
// the vehicle has realised.
void change_estimated_gear(const PowertrainTables& t, double acceleration_mps2, double resistance_N, double dt,
                           PowertrainReading& state) {
    const auto gear = static_cast<std::size_t>(state.gear);
    const double speed_mps = state.speed_mps;
    const double locked_rpm = speed_mps * t.rpm_per_mps[gear];
    const double wheel_N = wanted_N(t, gear, speed_mps, acceleration_mps2, resistance_N);
    const double share = torque_share(t, gear, speed_mps, wheel_N);
    const double load = std::clamp(2.5 * share - 1.25, 0.0, 1.0);
    const double up_rpm = t.shift_up_part_rpm + load * (t.shift_up_full_rpm - t.shift_up_part_rpm);
    const bool may_shift = state.gear_time_s + 0.5 * dt >= t.minimum_gear_time_s;
    const double drag_N = drag_Nm(t, engine_rpm(t, gear, locked_rpm)) * t.rpm_per_mps[gear] * kRadpsPerRpm;
    const bool brakes = wheel_N < drag_N / t.efficiency;
    int change = 0;
    if (!brakes && may_shift && gear + 1 < static_cast<std::size_t>(t.gears)) {
        const double next_N = wanted_N(t, gear + 1, speed_mps, acceleration_mps2, resistance_N);
        const bool next_suffices = torque_share(t, gear + 1, speed_mps, next_N) <= 0.95;
        if ((locked_rpm > up_rpm && next_suffices) || locked_rpm > t.shift_up_full_rpm) change = 1;
    }
    if (change == 0 && gear > 0) {
        const bool kick_down =
            may_shift && share > 1.5 && speed_mps * t.rpm_per_mps[gear - 1] < 0.8 * t.shift_up_full_rpm;
        if (kick_down || (locked_rpm < t.shift_down_rpm && (may_shift || brakes))) change = -1;
    }
    state.gear += change;
    state.gear_time_s = change != 0 && !brakes ? 0.0 : state.gear_time_s + dt;
}

// Returns the power that the battery supplies to give `terminal_W` at its terminals; below 0 while it is charged. The
// current I follows from terminal_W = V I - R I^2. The highest possible power is V^2 / (4 R).
double battery_W(const EnergySettings& s, double terminal_W) {
    if (s.battery_ohm <= 0.0) return terminal_W;
    const double root = std::max(square(s.battery_V) - 4.0 * s.battery_ohm * terminal_W, 0.0);
    return s.battery_V * (s.battery_V - std::sqrt(root)) / (2.0 * s.battery_ohm);
}

double engine_fuel_g_per_h(const EnergySettings& s, const PowertrainTables& t, const EngineLoad& engine) {
    if (engine.is_at_rest || (engine.clutch_is_open && engine.torque_Nm <= 0.0)) return s.idle_fuel_g_per_h;
    const double radps = engine.rpm * kRadpsPerRpm;
    // The data behind the curve may compute engine power from wheel power with a driveline efficiency of their own. The
    // factor converts our engine power to theirs at the same wheel power.
    const double factor = s.map_efficiency < 1.0 ? t.efficiency / s.map_efficiency : 1.0;
    const double power_W = engine.torque_Nm * radps * factor;
    if (engine.torque_Nm >= 0.0) return fuel_g_per_h(s, power_W + s.auxiliaries_W);
    const double total_W = engine.torque_Nm * radps + s.auxiliaries_W;
    if (total_W >= 0.0) return fuel_g_per_h(s, total_W);
    // The fuel is cut at the drag torque.
    const double drag_W = engine.drag_Nm * radps;
    const double share = drag_W < 0.0 ? std::clamp(1.0 - total_W / drag_W, 0.0, 1.0) : 0.0;
    return share * s.fuel_rate.y.front();
}

}  // namespace

StepWork& StepWork::operator+=(const StepWork& other) {
    driven_J += other.driven_J;
    overrun_J += other.overrun_J;
    brake_J += other.brake_J;
    air_J += other.air_J;
    rolling_J += other.rolling_J;
    grade_J += other.grade_J;
    kinetic_J += other.kinetic_J;
    rotating_J += other.rotating_J;
    distance_m += other.distance_m;
    return *this;
}

double StepWork::residual_J() const {
    return driven_J + overrun_J - (brake_J + air_J + rolling_J + grade_J + kinetic_J + rotating_J);
}

FinishedStep finished_step(const PowertrainTables& t, const PowertrainReading& before, const PowertrainReading& after,
                           double sine, double dt) {
    FinishedStep step;
    const auto gear = static_cast<std::size_t>(before.gear);
    const double locked_rpm = before.speed_mps * t.rpm_per_mps[gear];
    const double rpm = engine_rpm(t, gear, locked_rpm);
    const double connected = std::clamp((before.gear_time_s + (dt - t.torque_interruption_s)) / dt, 0.0, 1.0);
    const double closing = clutch_closing(t, gear, locked_rpm);
    const double torque_Nm = 0.5 * (before.torque_Nm + after.torque_Nm);
    step.engine = {rpm, torque_Nm, drag_Nm(t, rpm), connected * closing <= 0.0,
                   before.speed_mps <= 0.0 && after.speed_mps <= 0.0};
    if (step.engine.is_at_rest) return step;

    const double transmitted_Nm = connected * torque_Nm;
    const double drive_N = transmitted_Nm * t.rpm_per_mps[gear] * kRadpsPerRpm *
                           (transmitted_Nm > 0.0 ? t.efficiency : 1.0 / t.efficiency);
    const Resistances resistance = resistances(t, before.speed_mps, sine);
    const double inertia = inertia_kg(t, gear, connected * closing);
    const double acceleration_mps2 = (after.speed_mps - before.speed_mps) / dt;
    double brake_N = 0.5 * (before.brake_N + after.brake_N);
    // A vehicle that comes to rest within the step, or slides at the limit of friction, does not use the whole brake
    // force.
    const bool brakes_less = after.speed_mps <= 0.0 ||
                             acceleration_mps2 <= -t.friction_mps2 - resistance.sum_N() * t.inverse_mass_1pkg + 1e-3;
    if (brakes_less) brake_N = drive_N - resistance.sum_N() - inertia * acceleration_mps2;
    step.work = work_of(t, resistance, drive_N, brake_N, inertia, acceleration_mps2,
                        0.5 * (before.speed_mps + after.speed_mps) * dt);
    return step;
}

PowertrainReading estimated_start(const PowertrainTables& tables, double speed_mps) {
    constexpr double kLongSince_s = 1000.0;
    return {speed_mps, 0.0, 0.0, kLongSince_s, cruising_gear(tables, speed_mps)};
}

FinishedStep estimated_step(const PowertrainTables& t, double after_mps, double sine, double dt,
                            PowertrainReading& state) {
    FinishedStep step;
    const double before_mps = state.speed_mps;
    step.engine.is_at_rest = before_mps <= 0.0 && after_mps <= 0.0;
    const double speed_mps = 0.5 * (before_mps + after_mps);
    const double acceleration_mps2 = (after_mps - before_mps) / dt;
    const Resistances resistance = resistances(t, speed_mps, sine);
    const auto gear = static_cast<std::size_t>(state.gear);
    change_estimated_gear(t, acceleration_mps2, resistance.sum_N(), dt, state);
    state.speed_mps = after_mps;
    if (after_mps <= 0.0) state.gear = 0;
    if (step.engine.is_at_rest) return step;
    const double locked_rpm = speed_mps * t.rpm_per_mps[gear];
    const double rpm = engine_rpm(t, gear, locked_rpm);
    const double closing = clutch_closing(t, gear, locked_rpm);
    const double wheel_N = wanted_N(t, gear, speed_mps, acceleration_mps2, resistance.sum_N());
    const double gain = t.rpm_per_mps[gear] * kRadpsPerRpm;
    const double drive_N = std::max(wheel_N, closing * drag_Nm(t, rpm) * gain / t.efficiency);
    const double torque_Nm = drive_N / gain * (drive_N > 0.0 ? 1.0 / t.efficiency : t.efficiency);
    step.engine = {rpm, torque_Nm, drag_Nm(t, rpm), closing <= 0.0, false};
    step.work = work_of(t, resistance, drive_N, drive_N - wheel_N, inertia_kg(t, gear, closing), acceleration_mps2,
                        speed_mps * dt);
    return step;
}

double fuel_g_per_h(const EnergySettings& settings, double power_W) {
    const SampledCurve& curve = settings.fuel_rate;
    const std::size_t points = curve.x.size();
    if (points < 2 || power_W <= curve.x.back()) return interpolate(curve, power_W);
    const double slope = (curve.y.back() - curve.y[points - 2]) / (curve.x.back() - curve.x[points - 2]);
    return curve.y.back() + slope * (power_W - curve.x.back());
}

double motor_loss_W(const EnergySettings& s, double rpm, double torque_Nm) {
    const std::size_t columns = s.loss_torque_Nm.size();
    const auto row_loss_W = [&](std::size_t row) {
        const auto upper = std::upper_bound(s.loss_torque_Nm.begin(), s.loss_torque_Nm.end(), std::abs(torque_Nm));
        const auto k = static_cast<std::size_t>(upper - s.loss_torque_Nm.begin());
        const std::size_t first = row * columns;
        if (k == 0 || k == columns) return s.loss_W[first + (k == 0 ? 0 : columns - 1)];
        const double share =
            (std::abs(torque_Nm) - s.loss_torque_Nm[k - 1]) / (s.loss_torque_Nm[k] - s.loss_torque_Nm[k - 1]);
        return s.loss_W[first + k - 1] + share * (s.loss_W[first + k] - s.loss_W[first + k - 1]);
    };
    const auto upper = std::upper_bound(s.loss_rpm.begin(), s.loss_rpm.end(), rpm);
    const auto row = static_cast<std::size_t>(upper - s.loss_rpm.begin());
    if (row == 0 || row == s.loss_rpm.size()) return row_loss_W(row == 0 ? 0 : row - 1);
    const double share = (rpm - s.loss_rpm[row - 1]) / (s.loss_rpm[row] - s.loss_rpm[row - 1]);
    return (1.0 - share) * row_loss_W(row - 1) + share * row_loss_W(row);
}

EnergyUse energy_use(const EnergySettings& settings, const PowertrainTables& tables, const EngineLoad& engine,
                     double time_s) {
    if (settings.source == "fuel") {
        return {engine_fuel_g_per_h(settings, tables, engine) * time_s / kSecondsPerHour, 0.0};
    }
    double terminal_W = settings.auxiliaries_W;
    if (!engine.is_at_rest) {
        terminal_W +=
            engine.torque_Nm * engine.rpm * kRadpsPerRpm + motor_loss_W(settings, engine.rpm, engine.torque_Nm);
    }
    return {0.0, battery_W(settings, terminal_W) * time_s};
}

}  // namespace stopline
