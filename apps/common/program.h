// The common frame of all programs: exit codes, signals, and messages for exceptions.
#pragma once

#include <functional>
#include <string>

#include "runs/interrupted.h"

namespace stopline {

// Exit codes of all programs. Every --help lists them.
enum class ExitCode : int {
    done = 0,
    check_failed = 1,  // a check of the results failed, or the program has a bug
    bad_input = 2,     // the input is wrong or needs too much memory, or the output cannot be written
    interrupted = 130  // SIGINT; run_program() returns 128 + the number of the signal for other signals
};

inline constexpr const char* kExitCodesText =
    "Exit codes: 0 done, 1 a check failed, 2 bad input, too little memory, or output that cannot be written,\n"
    "130 interrupted (143 by SIGTERM, 129 by SIGHUP).\n";

// Installs the signal handlers, runs `body` and returns the exit code of the program. Prints a message on standard
// error for an exception from `body` and for a failure to write standard output.
int run_program(const std::string& name, const std::function<ExitCode()>& body);

// Returns true after SIGINT (Ctrl-C), SIGTERM, SIGHUP or SIGPIPE. Long-running code must poll this function.
bool interrupted();

// Lets SIGTERM and SIGHUP end this process at once. Call it after run_program() has begun. It is meant for processes
// that hold no files.
void end_at_once_on_termination();

// Names the input in the message about too little memory. Options::parse() passes the argument of the command.
void set_input_name(const std::string& name);

// Returns `requested`, or the default of OpenMP (all processors) if `requested` is 0.
int thread_count(int requested);

}  // namespace stopline
