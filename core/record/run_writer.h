// Interface of the writers that record the state of a run in a file, step by step.
#pragma once

#include <string>

#include "sim/state/state.h"

namespace stopline {

class RunWriter {
public:
    RunWriter() = default;
    RunWriter(const RunWriter&) = delete;
    RunWriter& operator=(const RunWriter&) = delete;
    RunWriter(RunWriter&&) = delete;
    RunWriter& operator=(RunWriter&&) = delete;
    virtual ~RunWriter() = default;

    // Records the state. Call it before each step, and once after the last step.
    virtual void observe(const State& state) = 0;
    // Completes the file and returns a summary of its contents for the user. The simulation and its model may already
    // be destroyed, so this function must not use them.
    virtual std::string finish() = 0;
};

}  // namespace stopline
