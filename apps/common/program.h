// The common frame of all programs: exit codes, Ctrl-C, and messages for exceptions.
#pragma once

#include <functional>
#include <string>

#include "runs/interrupted.h"

namespace stopline {

// Exit codes of all programs. Every --help lists them.
enum class ExitCode : int {
    done = 0,
    check_failed = 1,  // a check of the results failed, or the program has a bug
    bad_input = 2,     // the input is wrong, or the output cannot be written
    interrupted = 130
};

inline constexpr const char* kExitCodesText =
    "Exit codes: 0 done, 1 a check failed, 2 bad input or output that cannot be written, 130 interrupted.\n";

// Installs the handler of Ctrl-C, runs `body` and returns the exit code of the program. Prints a message on standard
// error for an exception from `body` and for a failure to write standard output.
int run_program(const std::string& name, const std::function<ExitCode()>& body);

// Returns true after the user has pressed Ctrl-C. Long-running code must poll this function.
bool interrupted();

// Returns `requested`, or the default of OpenMP (all processors) if `requested` is 0.
int thread_count(int requested);

}  // namespace stopline
