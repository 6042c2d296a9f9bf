// Example commands in help texts and in the 'Next:' hint after a run. The user can run them as printed.
#pragma once

#include <string>

namespace stopline {

// Returns `text` with each program name (stopline-NAME) and each shipped scenario (scenarios/FILE.yaml) replaced by a
// path that works on this machine. A program name gets the folder from which this program was started, or no folder if
// the shell found this program through PATH. A scenario keeps its relative path if the file exists below the current
// folder. Otherwise it gets its absolute path.
std::string runnable(const std::string& text);

// Returns the command that starts `program` (such as "stopline-run"), quoted for a shell.
std::string program_command(const std::string& program);

}  // namespace stopline
