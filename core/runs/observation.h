// Lets a program observe a run step by step, for instance to write a recording during the run.
#pragma once

#include <cstddef>
#include <functional>

#include "sim/step/simulation.h"

namespace stopline {

struct Observation {
    // Called before each step of a run, and once after its last step. The runs of several populations may call it from
    // several threads at the same time.
    std::function<void(std::size_t population, const Simulation& simulation)> look;
    bool all_detectors = false;  // true: the run records the crossings of all detectors

    // Makes the run record delay causes (in networks with conflict areas) and, if all_detectors is true, the crossings
    // of all detectors. These records do not change the movement of vehicles.
    void prepare(Model& model) const;
    // Calls `look` if there is one.
    void call(std::size_t population, const Simulation& simulation) const {
        if (look) look(population, simulation);
    }
};

}  // namespace stopline
