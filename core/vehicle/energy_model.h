// The work and the energy use of one vehicle in a finished step. These functions read the state before and after the
// step. They never change it. Runs call them only while energy is measured.
//
//   fuel      fuel rate of the engine by a curve over engine power (EnergySettings::fuel_rate)
//   battery   mechanical power + losses of motor and inverter + auxiliaries = power at the terminals; the internal
//             resistance of the battery adds its own losses
#pragma once

#include "vehicle/energy_settings.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

// Engine or motor during a step.
struct EngineLoad {
    double rpm = 0.0;
    double torque_Nm = 0.0;  // mean over the step; below 0: overrun or recuperation
    double drag_Nm = 0.0;    // torque without fuel at this speed, <= 0
    bool clutch_is_open = false;
    bool is_at_rest = false;  // the vehicle stands during the whole step
};

// Work at the wheels, J. Losses are positive.
struct StepWork {
    double driven_J = 0.0;    // positive work of engine or motor
    double overrun_J = 0.0;   // work that engine drag or recuperation absorbs, <= 0
    double brake_J = 0.0;     // friction brake
    double air_J = 0.0;       // air resistance
    double rolling_J = 0.0;   // rolling resistance
    double grade_J = 0.0;     // work against the slope; below 0 downhill
    double kinetic_J = 0.0;   // change of the kinetic energy of the vehicle mass
    double rotating_J = 0.0;  // work into rotating parts; a gear change turns some of it into heat
    double distance_m = 0.0;

    StepWork& operator+=(const StepWork& other);
    // Returns the work of engine and motor minus all other terms. It is 0 if the balance closes.
    double residual_J() const;
};

struct FinishedStep {
    EngineLoad engine;
    StepWork work;
};

// The state of a powertrain between two steps.
struct PowertrainReading {
    double speed_mps = 0.0;
    double torque_Nm = 0.0;
    double brake_N = 0.0;
    double gear_time_s = 0.0;
    int gear = 0;
};

// Full dynamics: returns load and work from torque, gear and brake force, with the forces of powertrain_step().
FinishedStep finished_step(const PowertrainTables& tables, const PowertrainReading& before,
                           const PowertrainReading& after, double sine, double dt);

// Mesoscale mode: estimates load and work from the speeds before and after the step, by inverse dynamics. `state` has
// the speed before the step, the gear and the time since the last gear change. The function sets them to those after
// the step. The gearbox shifts as in full dynamics, but without interruption of the torque. Engine drag comes before
// the brake.
FinishedStep estimated_step(const PowertrainTables& tables, double after_mps, double sine, double dt,
                            PowertrainReading& state);
// Returns the state for the first estimated step of a vehicle with this speed.
PowertrainReading estimated_start(const PowertrainTables& tables, double speed_mps);

struct EnergyUse {
    double fuel_g = 0.0;
    double battery_J = 0.0;  // energy drawn from the battery minus recuperated energy, losses included

    EnergyUse& operator+=(const EnergyUse& other) {
        fuel_g += other.fuel_g;
        battery_J += other.battery_J;
        return *this;
    }
};

// Returns the fuel rate. `power_W` is the power at the crankshaft, auxiliaries included. Beyond the last point of the
// curve, the fuel rate rises with the slope of its last segment.
double fuel_g_per_h(const EnergySettings& settings, double power_W);

// Returns the losses of motor and inverter.
double motor_loss_W(const EnergySettings& settings, double rpm, double torque_Nm);

// Returns the energy use of a vehicle with this engine load for a time.
EnergyUse energy_use(const EnergySettings& settings, const PowertrainTables& tables, const EngineLoad& engine,
                     double time_s);

}  // namespace stopline
