// What a user says of a vehicle's powertrain (data/vehicles/*.yaml), in SI units unless the name says otherwise.
// Constant after loading; `PowertrainTables` (powertrain_tables.h) is what the step function reads.
#pragma once

#include <string>
#include <vector>

namespace stopline {

// Samples of y over x; x strictly rising, both of one length.
struct SampledCurve {
    std::vector<double> x;
    std::vector<double> y;
};

struct PowertrainSettings {
    std::string name;

    // Body
    double length_m = 5.15;
    double mass_kg = 1235.0;  // kerb mass
    double load_kg = 50.0;    // driver and luggage
    double drag_coefficient = 0.311;
    double frontal_area_m2 = 2.118;
    double rolling_r0 = 0.009;           // rolling resistance coefficient at rest, -
    double rolling_r1_s_per_m = 5.0e-5;  // its growth with speed
    double wheel_diameter_m = 0.606;

    // Engine or motor
    SampledCurve full_load;  // torque [N m] over engine speed [rpm]
    SampledCurve
        drag_torque;  // torque [N m], <= 0, over engine speed [rpm] without fuel (or recuperation limit of a motor)
    double idle_rpm = 798.0;  // 0 for an electric motor
    double limiter_rpm = 6500.0;

    // Transmission; a single gear makes an electric car: no shifts, no interruption, no clutch (launch_rpm 0)
    std::vector<double> gear_ratio;
    std::vector<double> rotating_mass_factor;  // effective over real mass, per gear (>= 1)
    double final_drive = 4.083;
    double driveline_efficiency = 0.92;
    double launch_rpm = 1500.0;              // engine speed held by the slipping clutch or converter while moving off
    double shift_up_part_load_rpm = 2000.0;  // upshift speed when little torque is asked for
    double shift_up_full_load_rpm = 4500.0;  // upshift speed at full load; linear between the two
    double shift_down_rpm = 1100.0;
    double torque_interruption_s = 0.45;  // drive torque is zero that long at each gear change
    double minimum_gear_time_s = 1.5;     // hysteresis: no further change sooner than this

    // First-order lag of the torque (drive) over engine speed and requested share of full load, times a factor per gear
    std::vector<double> lag_rpm;           // grid, rising
    std::vector<double> lag_torque_share;  // grid within 0..1, rising
    std::vector<double> lag_drive_s;       // [rpm][share], row-major
    std::vector<double> lag_gear_factor;   // per gear
    double brake_lag_s = 0.2;
    double brake_friction = 0.8;  // tyre-road friction coefficient that limits braking (and traction), -
};

}  // namespace stopline
