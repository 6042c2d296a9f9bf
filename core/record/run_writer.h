// A file that is written while a run goes on, from what can be seen of it between two steps.
#pragma once

#include <string>

#include "sim/state.h"

namespace stopline {

class RunWriter {
public:
    RunWriter() = default;
    RunWriter(const RunWriter&) = delete;
    RunWriter& operator=(const RunWriter&) = delete;
    RunWriter(RunWriter&&) = delete;
    RunWriter& operator=(RunWriter&&) = delete;
    virtual ~RunWriter() = default;

    // Before each step, and once after the last.
    virtual void look(const State& state) = 0;
    // Puts the file in its place. What it holds, for the user. The model is not needed any more.
    virtual std::string finish() = 0;
};

}  // namespace stopline
