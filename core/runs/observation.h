// Observes runs from outside, for files that are written during a run: recordings and tables for other programs.
#pragma once

#include <cstddef>
#include <functional>

#include "sim/step/simulation.h"

namespace stopline {

struct Observation {
    // Called before each step of each population's run, and once after its last step. Populations run in several
    // threads.
    std::function<void(std::size_t population, const Simulation& simulation)> look;
    bool all_detectors = false;  // record the crossings of all detectors

    // Switches on what the model has to record for the observer. The movement of vehicles does not change.
    void prepare(Model& model) const;
    // Calls `look` if there is one.
    void call(std::size_t population, const Simulation& simulation) const {
        if (look) look(population, simulation);
    }
};

}  // namespace stopline
