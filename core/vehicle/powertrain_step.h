// One time step of the full-dynamics vehicle: low-level controller (inverse dynamics: desired acceleration to engine torque
// and brake force), gearbox, torque and brake lags, force balance. A pure function without branches, over
// double or Batch (base/simd.h); the loop over vehicles is in sim/full_dynamics.cpp.
//
//   m lambda(gear) dv/dt = F_drive - F_brake - F_air(v) - F_roll(v) - F_grade      (force balance)
//
// lambda is the rotating-mass factor: the engine and wheels must be spun up too (Mitschke and Wallentowitz, "Dynamik der
// Kraftfahrzeuge", chapter 2). Torque and brake force follow their requests with first-order lags; the torque's lag comes
// from a map over gear, engine speed and requested share of full load, as in Section III.D of the paper.
#pragma once

#include <type_traits>

#include "base/arithmetic.h"
#include "base/units.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

// What changes in a powertrain from step to step.
template <class R>
struct PowertrainState {
    R speed_mps;
    R acceleration_mps2;  // realised in the last step
    R torque_Nm;          // at the crank, after its lag
    R brake_N;            // >= 0, after its lag
    R gear_time_s;        // since the last gear change
    R lag_s;              // time constant in force: torque's when driving, brake's when braking
    R gear;               // 0 is first gear
};

// Entry of a table over gears.
template <class R, class Number>
STOPLINE_INLINE R of_gear(const std::array<Number, PowertrainTables::kMaxGears>& table, const R& gear) {
    return look_up(table, gear);
}

// The lag map: linear over engine speed, for no torque and for full load, and linear between these two.
template <class R, class Number>
STOPLINE_INLINE R torque_lag_s(const PowertrainTablesOf<Number>& t, const R& gear, const R& rpm, const R& share) {
    const R cell = rpm * t.lag_nodes_per_rpm;
    const R unloaded = on_grid(t.lag_unloaded_s, cell);
    const R loaded = on_grid(t.lag_loaded_s, cell);
    return (unloaded + share * (loaded - unloaded)) * of_gear(t.lag_factor, gear);
}

// Whether the next gear can give what is asked for (1 or 0); without it a car would kick down at once and hunt.
template <class R, class Number>
STOPLINE_INLINE R next_gear_suffices(const PowertrainTablesOf<Number>& t, const R& gear, const R& speed_mps,
                                     const R& request_mps2, const R& resistance_N) {
    const R upper = lesser(gear + 1.0, t.gears - 1.0);
    const R cell = speed_mps * of_gear(t.rpm_per_mps, upper) * t.torque_nodes_per_rpm;
    const R force_N = t.mass_kg * of_gear(t.rotating_mass, upper) * request_mps2 + resistance_N;
    const double per_efficiency = 1.0 / t.efficiency;
    const R torque_Nm = force_N * of_gear(t.mps_per_rpm, upper) * (per_efficiency / kRadpsPerRpm);
    return STOPLINE_FLAG(R, torque_Nm <= 0.95 * on_grid(t.full_load_Nm, cell));
}

// Advances `s` by dt. `request_mps2` is the desired acceleration, `grade_N` = m g sin(slope), positive uphill.
template <class R, class Number>
STOPLINE_INLINE PowertrainState<R> powertrain_step(const PowertrainTablesOf<Number>& t, const PowertrainState<R>& s,
                                                   const R& request_mps2, const std::type_identity_t<R>& grade_N,
                                                   double dt) {
    // Engine speed. In first gear the clutch slips and the engine turns at launch speed until the wheels have caught up.
    const R rpm_per_mps = of_gear(t.rpm_per_mps, s.gear);
    const R locked_rpm = s.speed_mps * rpm_per_mps;
    const auto floor_rpm = select(s.gear < 0.5, splat<R>(t.launch_rpm), splat<R>(t.idle_rpm));
    const auto rpm = limited(locked_rpm, floor_rpm, t.limiter_rpm);
    // The share of the step after a gear change's interruption of the torque: 0 in it, 1 long after.
    const R connected = limited((s.gear_time_s + (dt - t.torque_interruption_s)) * (1.0 / dt), 0.0, 1.0);

    // The engine takes part in the motion as far as the clutch is closed.
    const auto per_floor = select(s.gear < 0.5, splat<R>(t.closing_launch_1prpm), splat<R>(t.closing_idle_1prpm));
    const R closed = limited(locked_rpm * per_floor - t.closing_offset, 0.0, 1.0);
    const R coupling = connected * closed;
    const auto rotating = t.rotating_mass_open + coupling * (of_gear(t.rotating_mass, s.gear) - t.rotating_mass_open);
    const auto inertia_kg = t.mass_kg * rotating;

    // Inverse dynamics: the force that gives the requested acceleration, as torque and brake force.
    const auto speed = s.speed_mps;
    const auto resistance_N = t.drag_Ns2pm2 * speed * speed + t.rolling_N + t.rolling_Nspm * speed + grade_N;
    // What the tyres transfer, m a + resistance, is limited by friction; the wheels' brakes also slow down the rotating masses.
    const auto by_resistance_mps2 = resistance_N * t.inverse_mass_1pkg;
    const R lowest_mps2 = -t.friction_mps2 - by_resistance_mps2;
    const R reachable_mps2 = limited(request_mps2, lowest_mps2, t.friction_mps2 - by_resistance_mps2);
    const auto wanted_N = inertia_kg * reachable_mps2 + resistance_N;
    const auto cell = rpm * t.torque_nodes_per_rpm;
    const auto full_Nm = on_grid(t.full_load_Nm, cell);
    const auto drag_Nm = coupling * on_grid(t.drag_Nm, cell);
    const R gain = rpm_per_mps * kRadpsPerRpm;  // wheel force over crank torque, without losses
    const R inverse_gain = of_gear(t.mps_per_rpm, s.gear) * (1.0 / kRadpsPerRpm);
    const double per_efficiency = 1.0 / t.efficiency;  // losses hinder driving and help braking
    const auto wanted_Nm =
        wanted_N * inverse_gain * select(wanted_N > 0.0, splat<R>(per_efficiency), splat<R>(t.efficiency));
    const auto limited_Nm = select(locked_rpm < t.limiter_rpm, limited(wanted_Nm, drag_Nm, full_Nm), drag_Nm);
    const auto request_Nm = connected * limited_Nm;
    const auto engine_brake_N = connected * drag_Nm * gain * per_efficiency;
    const auto request_brake_N = greater(engine_brake_N - wanted_N, 0.0);

    // Lags.
    const auto share = limited(request_Nm / greater(full_Nm, 1.0), 0.0, 1.0);
    const auto drive_lag_s = torque_lag_s(t, s.gear, rpm, share);
    PowertrainState<R> next{};
    next.torque_Nm = without_tiny(s.torque_Nm + (request_Nm - s.torque_Nm) * lag_share(dt, drive_lag_s));
    next.brake_N = without_tiny(s.brake_N + (request_brake_N - s.brake_N) * lag_share<double>(dt, t.brake_lag_s));
    next.lag_s = select(request_brake_N > 0.0, splat<R>(t.brake_lag_s), drive_lag_s);

    // Force balance. Brakes and resistances stop a vehicle but never push it back: below zero speed is standstill.
    // Means over the step, so that results do not depend on its length to first order.
    const R transmitted_Nm = connected * (0.5 * (s.torque_Nm + next.torque_Nm));
    const auto drive_N =
        transmitted_Nm * gain * select(transmitted_Nm > 0.0, splat<R>(t.efficiency), splat<R>(per_efficiency));
    const auto force_N = drive_N - 0.5 * (s.brake_N + next.brake_N) - resistance_N;
    // Brakes set for a closed clutch would lock the wheels when it opens: no more than friction gives.
    const R free_mps2 = greater<R>(without_tiny<R>(force_N / inertia_kg), lowest_mps2);
    const R stops = STOPLINE_FLAG(R, speed + free_mps2 * dt <= 0.0);
    next.speed_mps = choose(stops, splat<R>(0.0), speed + free_mps2 * dt);
    next.acceleration_mps2 = choose(stops, (0.0 - speed) * (1.0 / dt), free_mps2);

    // Gear changes. More load, later shifts; an engine that is asked for half as much again as it has kicks down: for less
    // than that, the lower gear would not win back what the interruption costs. The hysteresis is the distance
    // between the up- and downshift speeds and the minimum time in a gear; at standstill first gear goes in.
    const auto load = limited(2.5 * share - 1.25, 0.0, 1.0);  // part-load schedule up to half load, full from 0.9
    const auto up_rpm = t.shift_up_part_rpm + load * (t.shift_up_full_rpm - t.shift_up_part_rpm);
    const R settled = STOPLINE_FLAG(R, s.gear_time_s + 0.5 * dt >= t.minimum_gear_time_s);
    const R driving = STOPLINE_FLAG(R, request_brake_N <= 0.0);
    const R strong = next_gear_suffices<R>(t, s.gear, speed, request_mps2, resistance_N);
    const R due = STOPLINE_FLAG(R, locked_rpm > up_rpm) * strong;
    const R revved = STOPLINE_FLAG(R, locked_rpm > t.shift_up_full_rpm);
    const R up = greater(due, revved) * settled * driving * STOPLINE_FLAG(R, s.gear < t.gears - 1.5);
    const R lower = greater(s.gear - 1.0, 0.0);
    const R lower_rpm = speed * of_gear(t.rpm_per_mps, lower);
    const R kick_down =
        STOPLINE_FLAG(R, wanted_Nm > 1.5 * full_Nm) * STOPLINE_FLAG(R, lower_rpm < 0.8 * t.shift_up_full_rpm) * settled;
    const R slow = STOPLINE_FLAG(R, locked_rpm < t.shift_down_rpm) * greater(settled, 1.0 - driving);
    const R down = greater(kick_down, slow) * STOPLINE_FLAG(R, s.gear > 0.5) * (1.0 - up);
    const R moving = STOPLINE_FLAG(R, next.speed_mps > 0.0);
    next.gear = moving * (s.gear + up - down);
    // A change while braking costs no drive torque, so it does not interrupt.
    const R lasting = 1.0 - (up + down) * driving * moving;
    next.gear_time_s = lasting * lesser(s.gear_time_s + dt, 1000.0);
    return next;
}

}  // namespace stopline
