// Drives a platoon in full dynamics on a straight road, behind a leader whose acceleration is prescribed. The platoon
// starts as a queue at a red signal. For the manoeuvres `swing` and `brake` it first drives until all vehicles are in
// equilibrium.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "sim/state/events.h"

namespace stopline {

// A motion of the platoon leader.
struct Manoeuvre {
    enum class Kind { swing, brake, start };
    Kind kind = Kind::swing;
    double speed_mps = 10.0;         // speed before the manoeuvre; the leader swings around it
    double frequency_radps = 1.0;    // swing: angular frequency
    double amplitude_mps2 = 0.3;     // swing: amplitude of the prescribed acceleration
    double deceleration_mps2 = 6.0;  // brake: prescribed deceleration, down to rest
};

// The motion of all vehicles during a manoeuvre. The lists hold [sample * vehicles + position]; position 0 is the
// platoon leader. There is one sample for each step.
struct PlatoonMotion {
    double step_s = 0.01;
    std::size_t vehicles = 0;
    std::size_t samples = 0;
    std::vector<float> acceleration_mps2;
    std::vector<float> speed_mps;
    std::vector<float> gap_m;              // net gap to the leader; 0 for the platoon leader
    std::vector<float> gap_error_m;        // net gap minus the gap of the spacing policy at the own speed
    std::vector<double> standstill_gap_m;  // [position]
    double follower_lag_s = 0.0;           // mean lag of the powertrains of the followers
    bool was_settled = true;               // false: the platoon had not reached its equilibrium before the manoeuvre
    Violations violations;
    std::int64_t updates = 0;  // moved vehicles, summed over all steps
    std::uint64_t state_hash = 0;

    double value(const std::vector<float>& list, std::size_t sample, std::size_t position) const {
        return static_cast<double>(list[sample * vehicles + position]);
    }
};

// Throws InputError unless the scenario is a straight road in full dynamics.
void check_platoon_scenario(const Scenario& scenario);

// Runs a platoon of `vehicles` vehicles of scenario.populations[population]. `report` gets the completed share of the
// run. If it returns false, the run ends at once, and the result is incomplete.
PlatoonMotion drive_platoon(const Scenario& scenario, std::size_t population, int vehicles, const Manoeuvre& manoeuvre,
                            const std::function<bool(double)>& report = {});

}  // namespace stopline
