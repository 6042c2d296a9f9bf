// Another program, run to its end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stopline {

struct EndedProcess {
    int error = 0;      // of starting it, as errno
    int status = 0;     // as waitpid gives it; 0: it ended well
    std::string words;  // that it wrote to standard output and standard error

    bool failed() const { return error != 0 || status != 0; }
};

// The first word is the program, looked for in PATH. Runs in `folder`, without standard input.
EndedProcess run_process(std::vector<std::string> words, const std::filesystem::path& folder);

}  // namespace stopline
