// Example commands in help texts and 'Next' lines, written so that the user can run them as printed.
#pragma once

#include <string>

namespace stopline {

// Returns `text` with each word 'stopline-NAME' and 'scenarios/FILE.yaml' replaced by one that works on this machine.
// A program gets the folder by which this program was started: none if the shell found it through PATH.
// A shipped scenario keeps its relative path if the file is below the current folder, else it gets its absolute path.
std::string runnable(const std::string& text);

// Returns the command that starts `program` ("stopline-run"), quoted for a shell.
std::string program_command(const std::string& program);

}  // namespace stopline
