// Looking on at runs from outside, for what is written while they run: recordings, tables of other programs.
#pragma once

#include <cstddef>
#include <functional>

#include "sim/simulation.h"

namespace stopline {

struct Observation {
    // Before each step of each population's run, and once after its last. Populations run side by side in threads.
    std::function<void(std::size_t population, const Simulation& simulation)> look;
    bool all_detectors = false;  // their crossings are kept, whatever else the run records

    // What the model must do for it; none of that changes where vehicles drive.
    void prepare(Model& model) const;
    void call(std::size_t population, const Simulation& simulation) const {
        if (look) look(population, simulation);
    }
};

}  // namespace stopline
