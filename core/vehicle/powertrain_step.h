// One time step of a vehicle in full dynamics: low-level controller, gearbox, lags of torque and brake, force balance.
// The low-level controller uses inverse dynamics: it converts the desired acceleration into engine torque and brake
// force. The step is a pure function without branches. It computes one vehicle (double) or several at a time (Batch,
// base/simd/simd.h). The loop over vehicles is in sim/full_dynamics/full_kernels.inl.
//
//   m lambda(gear) dv/dt = F_drive - F_brake - F_air(v) - F_roll(v) - F_grade      (force balance)
//
// lambda is the rotating-mass factor: a force must also accelerate the rotating engine and wheels (Mitschke and
// Wallentowitz, "Dynamik der Kraftfahrzeuge", chapter 2). Torque and brake force follow their requests with first-order
// lags. The time constant of the torque comes from a map over gear, engine speed and requested share of full load, as
// in Section III.D of the paper.
#pragma once

#include <type_traits>

#include "base/simd/arithmetic.h"
#include "base/units.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

// The state of a powertrain.
template <class R>
struct PowertrainState {
    R speed_mps;
    R acceleration_mps2;  // realised in the previous step
    R torque_Nm;          // torque at the crankshaft, after the lag
    R brake_N;            // brake force >= 0, after the lag
    R gear_time_s;        // time since the last gear change
    R lag_s;              // time constant of the brake if a brake force is requested, otherwise of the torque
    R gear;               // 0: first gear
    R available_mps2;     // acceleration that the full engine torque gives in this gear; 0 before the first step
};

// Returns the value of a table for this gear.
template <class R, class Number>
STOPLINE_INLINE R of_gear(const std::array<Number, PowertrainTables::kMaxGears>& table, const R& gear) {
    return look_up(table, gear);
}

// Returns the time constant of the torque from the lag map, by linear interpolation over the engine speed and over the
// share of full load.
template <class R, class Number>
STOPLINE_INLINE R torque_lag_s(const PowertrainTablesOf<Number>& t, const R& gear, const R& rpm, const R& share) {
    const R cell = rpm * t.lag_nodes_per_rpm;
    const R unloaded = interpolate_on_grid(t.lag_unloaded_s, cell);
    const R loaded = interpolate_on_grid(t.lag_loaded_s, cell);
    return (unloaded + share * (loaded - unloaded)) * of_gear(t.lag_factor, gear);
}

// Returns 1 if the next higher gear can provide the requested acceleration with 95 % of its full-load torque, else 0.
// Without this check, a car could shift up and right after that down again.
template <class R, class Number>
STOPLINE_INLINE R next_gear_suffices(const PowertrainTablesOf<Number>& t, const R& gear, const R& speed_mps,
                                     const R& request_mps2, const R& resistance_N) {
    const R next_gear = min_of(gear + 1.0, t.gears - 1.0);
    const R cell = speed_mps * of_gear(t.rpm_per_mps, next_gear) * t.torque_nodes_per_rpm;
    const R force_N = t.mass_kg * of_gear(t.rotating_mass, next_gear) * request_mps2 + resistance_N;
    const double per_efficiency = 1.0 / t.efficiency;
    const R torque_Nm = force_N * of_gear(t.mps_per_rpm, next_gear) * (per_efficiency / kRadpsPerRpm);
    return STOPLINE_FLAG(R, torque_Nm <= 0.95 * interpolate_on_grid(t.full_load_Nm, cell));
}

// The quantities that decide on a gear change. `locked_rpm`: engine speed with a closed clutch. `share`: requested
// torque as a share of the full-load torque. `wanted_Nm`: torque that the requested acceleration needs; the
// engine may provide less.
template <class R>
struct GearDemand {
    R locked_rpm;
    R share;
    R wanted_Nm;
    R full_Nm;
    R request_brake_N;
    R next_gear_suffices;  // 1 or 0
};

// Sets the gear of `next` and the time since the last gear change. `s` is the state before the step. The engine speed
// of the upshift rises with the load. A car shifts down below the engine speed shift_down_rpm. It also shifts down to
// accelerate (kick-down) if the requested acceleration needs more than 1.5 times the full-load torque. For a smaller
// request, the torque interruption would cost more speed than the lower gear gains.
template <class R, class Number>
STOPLINE_INLINE void change_gear(const PowertrainTablesOf<Number>& t, const PowertrainState<R>& s,
                                 const GearDemand<R>& demand, double dt, PowertrainState<R>& next) {
    const auto load = clamped(2.5 * demand.share - 1.25, 0.0, 1.0);
    const auto up_rpm = t.shift_up_part_rpm + load * (t.shift_up_full_rpm - t.shift_up_part_rpm);
    const R gear_time_over = STOPLINE_FLAG(R, s.gear_time_s + 0.5 * dt >= t.minimum_gear_time_s);
    const R driving = STOPLINE_FLAG(R, demand.request_brake_N <= 0.0);
    const R upshift_due = STOPLINE_FLAG(R, demand.locked_rpm > up_rpm) * demand.next_gear_suffices;
    const R overspeed = STOPLINE_FLAG(R, demand.locked_rpm > t.shift_up_full_rpm);
    const R up = max_of(upshift_due, overspeed) * gear_time_over * driving * STOPLINE_FLAG(R, s.gear < t.gears - 1.5);
    const R lower_gear = max_of(s.gear - 1.0, 0.0);
    const R lower_rpm = s.speed_mps * of_gear(t.rpm_per_mps, lower_gear);
    const R kick_down = STOPLINE_FLAG(R, demand.wanted_Nm > 1.5 * demand.full_Nm) *
                        STOPLINE_FLAG(R, lower_rpm < 0.8 * t.shift_up_full_rpm) * gear_time_over;
    const R too_slow = STOPLINE_FLAG(R, demand.locked_rpm < t.shift_down_rpm) * max_of(gear_time_over, 1.0 - driving);
    const R down = max_of(kick_down, too_slow) * STOPLINE_FLAG(R, s.gear > 0.5) * (1.0 - up);
    const R moving = STOPLINE_FLAG(R, next.speed_mps > 0.0);
    next.gear = moving * (s.gear + up - down);
    // A gear change during braking or at standstill interrupts no drive torque, so gear_time_s is not reset.
    const R keeps_time = 1.0 - (up + down) * driving * moving;
    next.gear_time_s = keeps_time * min_of(s.gear_time_s + dt, 1000.0);
}

// Returns the state after dt. `request_mps2` is the desired acceleration, and `grade_N` = m g sin(slope) is positive
// uphill.
template <class R, class Number>
STOPLINE_INLINE PowertrainState<R> powertrain_step(const PowertrainTablesOf<Number>& t, const PowertrainState<R>& s,
                                                   const R& request_mps2, const std::type_identity_t<R>& grade_N,
                                                   double dt) {
    // Engine speed. In first gear the clutch slips: the engine runs at launch speed until the car is fast enough.
    const R rpm_per_mps = of_gear(t.rpm_per_mps, s.gear);
    const R locked_rpm = s.speed_mps * rpm_per_mps;
    const auto floor_rpm = select(s.gear < 0.5, splat<R>(t.launch_rpm), splat<R>(t.idle_rpm));
    const auto rpm = clamped(locked_rpm, floor_rpm, t.limiter_rpm);
    // Share of the step that lies after the torque interruption of a gear change. Only then engine and wheels are
    // connected.
    const R connected = clamped((s.gear_time_s + (dt - t.torque_interruption_s)) * (1.0 / dt), 0.0, 1.0);

    // The rotating mass of the engine is included in proportion to the degree of closing of the clutch.
    const auto closing_1prpm = select(s.gear < 0.5, splat<R>(t.closing_launch_1prpm), splat<R>(t.closing_idle_1prpm));
    const R closed = clamped(locked_rpm * closing_1prpm - t.closing_offset, 0.0, 1.0);
    const R coupling = connected * closed;
    const auto rotating = t.rotating_mass_open + coupling * (of_gear(t.rotating_mass, s.gear) - t.rotating_mass_open);
    const auto inertia_kg = t.mass_kg * rotating;

    // Inverse dynamics: compute the force for the requested acceleration, and divide it into engine torque and brake
    // force.
    const auto speed = s.speed_mps;
    const auto resistance_N = t.drag_Ns2pm2 * speed * speed + t.rolling_N + t.rolling_Nspm * speed + grade_N;
    // Friction limits the tyre force, which is m a + resistance. `wanted_N` also contains the force for the rotating
    // masses, which the tyres do not transmit.
    const auto resistance_mps2 = resistance_N * t.inverse_mass_1pkg;
    const R lowest_mps2 = -t.friction_mps2 - resistance_mps2;
    const R reachable_mps2 = clamped(request_mps2, lowest_mps2, t.friction_mps2 - resistance_mps2);
    const auto wanted_N = inertia_kg * reachable_mps2 + resistance_N;
    const auto cell = rpm * t.torque_nodes_per_rpm;
    const auto full_Nm = interpolate_on_grid(t.full_load_Nm, cell);
    const auto drag_Nm = coupling * interpolate_on_grid(t.drag_Nm, cell);
    const R gain = rpm_per_mps * kRadpsPerRpm;  // wheel force over crank torque, without losses
    const R inverse_gain = of_gear(t.mps_per_rpm, s.gear) * (1.0 / kRadpsPerRpm);
    const double per_efficiency = 1.0 / t.efficiency;  // losses reduce drive torque and increase engine braking
    const auto wanted_Nm =
        wanted_N * inverse_gain * select(wanted_N > 0.0, splat<R>(per_efficiency), splat<R>(t.efficiency));
    const auto limited_Nm = select(locked_rpm < t.limiter_rpm, clamped(wanted_Nm, drag_Nm, full_Nm), drag_Nm);
    const auto request_Nm = connected * limited_Nm;
    const auto engine_brake_N = connected * drag_Nm * gain * per_efficiency;
    const auto request_brake_N = max_of(engine_brake_N - wanted_N, 0.0);

    // First-order lags of torque and brake force.
    const auto share = clamped(request_Nm / max_of(full_Nm, 1.0), 0.0, 1.0);
    const auto drive_lag_s = torque_lag_s(t, s.gear, rpm, share);
    PowertrainState<R> next{};
    next.torque_Nm = flush_tiny(s.torque_Nm + (request_Nm - s.torque_Nm) * lag_share(dt, drive_lag_s));
    next.brake_N = flush_tiny(s.brake_N + (request_brake_N - s.brake_N) * lag_share<double>(dt, t.brake_lag_s));
    next.lag_s = select(request_brake_N > 0.0, splat<R>(t.brake_lag_s), drive_lag_s);

    // Force balance. Brakes and resistances stop a vehicle but never push it back, so a speed below 0 becomes 0. The
    // balance uses the means of torque and brake force over the step, so that the length of the step has no first-order
    // effect.
    const R transmitted_Nm = connected * (0.5 * (s.torque_Nm + next.torque_Nm));
    const auto drive_N =
        transmitted_Nm * gain * select(transmitted_Nm > 0.0, splat<R>(t.efficiency), splat<R>(per_efficiency));
    const auto force_N = drive_N - 0.5 * (s.brake_N + next.brake_N) - resistance_N;
    // Friction limits the deceleration a second time. When the clutch opens, a brake force computed for the closed
    // clutch could otherwise lock the wheels.
    const R moving_mps2 = max_of<R>(flush_tiny<R>(force_N / inertia_kg), lowest_mps2);
    const R stops_in_step = STOPLINE_FLAG(R, speed + moving_mps2 * dt <= 0.0);
    next.speed_mps = choose(stops_in_step, splat<R>(0.0), speed + moving_mps2 * dt);
    next.acceleration_mps2 = choose(stops_in_step, (0.0 - speed) * (1.0 / dt), moving_mps2);

    // The available acceleration ignores that a gear change interrupts the torque, because the interruption is short.
    const auto highest_Nm = select(locked_rpm < t.limiter_rpm, full_Nm, drag_Nm);
    const auto highest_N = highest_Nm * gain * t.efficiency - resistance_N;
    next.available_mps2 = min_of<R>(highest_N / inertia_kg, t.friction_mps2 - resistance_mps2);

    const R next_gear = next_gear_suffices<R>(t, s.gear, speed, request_mps2, resistance_N);
    change_gear(t, s, GearDemand<R>{locked_rpm, share, wanted_Nm, full_Nm, request_brake_N, next_gear}, dt, next);
    return next;
}

}  // namespace stopline
