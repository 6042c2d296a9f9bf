// Runs another program and waits until it ends.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace stopline {

struct ProcessResult {
    int start_error = 0;   // errno if the program could not be started, else 0
    int wait_status = 0;   // status from waitpid(); 0: success
    std::string output;    // standard output and standard error, interleaved
    bool stopped = false;  // true: the watch function returned false, so the program was killed

    bool failed() const { return start_error != 0 || wait_status != 0; }
};

// A function that gets the output of the program so far, several times a second. If the function returns false, the
// program is killed.
using ProcessWatch = std::function<bool(const std::string& output)>;

// Runs `command` in `folder` with empty standard input. The first word is the name of the program, which is searched in
// PATH. A failure is reported in the result. `watch` may be empty. If `watch` throws an exception, the program is
// killed and the caller gets the exception.
ProcessResult run_process(std::vector<std::string> command, const std::filesystem::path& folder,
                          const ProcessWatch& watch = {});

}  // namespace stopline
