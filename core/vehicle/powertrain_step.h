// One time step of the full-dynamics vehicle: low-level controller (inverse dynamics: desired acceleration to engine torque
// and brake force), gearbox, torque and brake lags, force balance. A pure function without branches, so that a loop
// over vehicles vectorises; the loop itself is in sim/full_dynamics.cpp.
//
//   m lambda(gear) dv/dt = F_drive - F_brake - F_air(v) - F_roll(v) - F_grade      (force balance)
//
// lambda is the rotating-mass factor: the engine and wheels must be spun up too (Mitschke and Wallentowitz, "Dynamik der
// Kraftfahrzeuge", chapter 2). Torque and brake force follow their requests with first-order lags; the torque's lag comes
// from a map over gear, engine speed and requested share of full load, as in Section III.D of the paper.
#pragma once

#include "base/arithmetic.h"
#include "base/units.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

// What changes in a powertrain from step to step.
struct PowertrainState {
    double speed_mps;
    double acceleration_mps2;  // realised in the last step
    double torque_Nm;          // at the crank, after its lag
    double brake_N;            // >= 0, after its lag
    double gear_time_s;        // since the last gear change
    double lag_s;              // time constant in force: torque's when driving, brake's when braking
    int gear;                  // 0 is first gear
};

// Linear interpolation on a uniform grid; `at` is in cells, within 0 .. cells.
STOPLINE_INLINE double on_grid(const double* node, double at, int cells) {
    const int k = static_cast<int>(lesser(at, static_cast<double>(cells - 1)));
    return node[k] + (at - k) * (node[k + 1] - node[k]);
}

STOPLINE_INLINE double torque_lag_s(const PowertrainTables& t, int gear, double rpm, double share) {
    constexpr int kRows = PowertrainTables::kLagRpmNodes;
    constexpr int kColumns = PowertrainTables::kLagShareNodes;
    const double row = rpm * t.lag_nodes_per_rpm;
    const double column = share * (kColumns - 1);
    const int r = static_cast<int>(lesser(row, kRows - 2.0));
    const int c = static_cast<int>(lesser(column, kColumns - 2.0));
    const double* node = t.lag_s.data() + r * kColumns + c;
    const double low = node[0] + (column - c) * (node[1] - node[0]);
    const double high = node[kColumns] + (column - c) * (node[kColumns + 1] - node[kColumns]);
    return (low + (row - r) * (high - low)) * t.lag_factor[static_cast<unsigned>(gear)];
}

// Advances `s` by dt. `request_mps2` is the desired acceleration, `grade_N` = m g sin(slope), positive uphill.
STOPLINE_INLINE PowertrainState powertrain_step(const PowertrainTables& t, const PowertrainState& s,
                                                double request_mps2, double grade_N, double dt) {
    const bool has_clutch = t.launch_rpm > 0.0;
    const auto g = static_cast<unsigned>(s.gear);

    // Engine speed. In first gear the clutch slips and the engine turns at launch speed until the wheels have caught up.
    const double locked_rpm = s.speed_mps * t.rpm_per_mps[g];
    const double floor_rpm = select(s.gear == 0, t.launch_rpm, t.idle_rpm);
    const double rpm = limited(locked_rpm, floor_rpm, t.limiter_rpm);
    const bool interrupted = s.gear_time_s < t.torque_interruption_s;

    // The engine takes part in the motion as far as the clutch is closed.
    const double closed = has_clutch ? limited(4.0 * locked_rpm / greater(floor_rpm, 1.0) - 3.0, 0.0, 1.0) : 1.0;
    const double coupling = select(interrupted, 0.0, closed);
    const double rotating = t.rotating_mass_open + coupling * (t.rotating_mass[g] - t.rotating_mass_open);
    const double inertia_kg = t.mass_kg * rotating;

    // Inverse dynamics: the force that gives the requested acceleration, as torque and brake force.
    const double speed = s.speed_mps;
    const double resistance_N = t.drag_Ns2pm2 * speed * speed + t.rolling_N + t.rolling_Nspm * speed + grade_N;
    const double wanted_N = limited(inertia_kg * request_mps2 + resistance_N, -t.traction_limit_N, t.traction_limit_N);
    const double cell = rpm * t.rpm_cells_per_rpm;
    const double full_Nm = on_grid(t.full_load_Nm.data(), cell, PowertrainTables::kRpmCells);
    const double drag_Nm = coupling * on_grid(t.drag_Nm.data(), cell, PowertrainTables::kRpmCells);
    const double gain = t.force_per_torque[g];
    const double drive_gain = gain * t.efficiency;
    const double brake_gain = gain / t.efficiency;  // losses help to brake
    const double wanted_Nm = wanted_N / select(wanted_N > 0.0, drive_gain, brake_gain);
    const double limited_Nm = select(locked_rpm < t.limiter_rpm, limited(wanted_Nm, drag_Nm, full_Nm), drag_Nm);
    const double request_Nm = select(interrupted, 0.0, limited_Nm);
    const double engine_brake_N = select(interrupted, 0.0, drag_Nm * brake_gain);
    const double request_brake_N = greater(engine_brake_N - wanted_N, 0.0);

    // Lags.
    const double share = limited(request_Nm / greater(full_Nm, 1.0), 0.0, 1.0);
    const double drive_lag_s = torque_lag_s(t, s.gear, rpm, share);
    PowertrainState next;
    next.torque_Nm = without_tiny(s.torque_Nm + (request_Nm - s.torque_Nm) * lag_share(dt, drive_lag_s));
    next.brake_N = without_tiny(s.brake_N + (request_brake_N - s.brake_N) * lag_share(dt, t.brake_lag_s));
    next.lag_s = select(request_brake_N > 0.0, t.brake_lag_s, drive_lag_s);

    // Force balance. Brakes and resistances stop a vehicle but never push it back: below zero speed is standstill.
    const double transmitted_Nm = select(interrupted, 0.0, next.torque_Nm);
    const double drive_N = transmitted_Nm * select(transmitted_Nm > 0.0, drive_gain, brake_gain);
    const double force_N = drive_N - next.brake_N - resistance_N;
    const double free_speed = speed + force_N / inertia_kg * dt;
    const double next_speed = greater(free_speed, 0.0);
    next.speed_mps = next_speed;
    next.acceleration_mps2 = without_tiny((next_speed - speed) / dt);

    // Gear changes. More load, later shifts; a saturated engine at low speed kicks down. The hysteresis is the distance
    // between the up- and downshift speeds and the minimum time in a gear; at standstill first gear goes in.
    const double load = limited(2.5 * share - 1.25, 0.0, 1.0);  // part-load schedule up to half load, full from 0.9
    const double up_rpm = t.shift_up_part_rpm + load * (t.shift_up_full_rpm - t.shift_up_part_rpm);
    const bool settled = s.gear_time_s >= t.minimum_gear_time_s;
    const bool driving = request_brake_N <= 0.0;
    const bool up = (locked_rpm > up_rpm) & settled & driving & (s.gear + 1 < t.gears);
    const unsigned lower = g - static_cast<unsigned>(s.gear > 0);
    const double lower_rpm = speed * t.rpm_per_mps[lower];
    const bool kick_down = (share >= 0.98) & settled & (lower_rpm < 0.8 * t.shift_up_full_rpm);
    const bool slow = (locked_rpm < t.shift_down_rpm) & (settled | !driving);
    const bool down = (kick_down | slow) & (s.gear > 0);
    const bool stopped = next_speed <= 0.0;
    const int step_gear = s.gear + static_cast<int>(up) - static_cast<int>(down & !up);
    next.gear = stopped ? 0 : step_gear;
    // A change while braking costs no drive torque, so it does not interrupt.
    const bool interrupts = (next.gear != s.gear) & driving & !stopped;
    next.gear_time_s = select(interrupts, 0.0, lesser(s.gear_time_s + dt, 1000.0));
    return next;
}

}  // namespace stopline
