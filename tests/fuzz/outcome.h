// Each fuzz target must succeed, or throw an InputError with a printable message.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/input_error.h"
#include "base/io/printable.h"

namespace stopline::fuzz {

// Ends the process with a message, which libFuzzer reports as a crash.
[[noreturn]] inline void fail(const std::string& message) {
    static_cast<void>(std::fprintf(stderr, "fuzz target: %s\n", message.c_str()));
    std::abort();
}

inline void require(bool holds, const char* what) {
    if (!holds) fail(std::string("this does not hold: ") + what);
}

// Fails if the message is empty or contains characters that would control a terminal.
inline void require_printable(std::string_view message) {
    require(!message.empty(), "a message is not empty");
    if (has_control_characters(message)) fail("control character in: " + std::string(message));
}

// Runs the action. Other exceptions than InputError end the process.
template <class Action>
void expect_success_or_input_error(const Action& action) {
    try {
        action();
    } catch (const InputError& error) {
        require_printable(error.what());
    }
}

// A file in memory with a path, for functions that read files. There is one for the whole process, because opening a
// new one for each input would take longer than reading it.
class MemoryFile {
public:
    // Returns the path of a file with this content. The content stays until the next call.
    static std::filesystem::path with(std::string_view content);
};

}  // namespace stopline::fuzz
