// The results of the meters of a run (driving_meters.h).
#pragma once

#include "runs/driving/energy_results.h"
#include "runs/driving/safety_results.h"

namespace stopline {

struct DrivingResults {
    EnergyResult energy;  // empty without measure.energy
    SafetyResult safety;  // empty without measure.surrogate_safety
};

}  // namespace stopline
