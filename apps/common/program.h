// What all programs share: exit codes, the interrupt, and the one place where errors become messages.
#pragma once

#include <functional>
#include <string>

#include "experiment/interrupted.h"

namespace stopline {

// Exit codes of all programs; they are also in every --help.
enum class ExitCode : int {
    done = 0,
    check_failed = 1,  // a result is not as it must be, or an error of the program itself
    bad_input = 2,     // what the user gave cannot be used, or the output cannot be written
    interrupted = 130
};

inline constexpr const char* kExitCodesText =
    "Exit codes: 0 done, 1 a check failed, 2 bad input or output that cannot be written, 130 interrupted.\n";

// Runs a program's body: installs the interrupt handler, turns InputError, Interrupted and other exceptions into a message on
// standard error and an exit code, and reports where standard output could not be written.
int run_program(const std::string& name, const std::function<ExitCode()>& body);

// Whether the user has pressed Ctrl-C. Work in progress looks at it now and then.
bool interrupted();

// Threads to use: what was asked for, or all of the machine where that is 0.
int threads_or_all(int threads);

}  // namespace stopline
