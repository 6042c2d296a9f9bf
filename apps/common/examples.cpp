#include "common/examples.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "base/io/data_directory.h"
#include "common/command_line.h"

namespace stopline {

namespace {

// Characters that separate the words of an example.
constexpr std::string_view kSeparators = " \n'\"(),;:";

bool is_program(const std::string& word) {
    constexpr std::string_view kPrefix = "stopline-";
    constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz";
    return word.size() > kPrefix.size() && word.starts_with(kPrefix) &&
           word.find_first_not_of(kLetters, kPrefix.size()) == std::string::npos;
}

bool is_shipped_scenario(const std::string& word) { return word.starts_with("scenarios/") && word.ends_with(".yaml"); }

// Returns the absolute path of the shipped scenario `word`, quoted for a shell. If `word` is a file below the current
// folder, or if there is no such shipped scenario, returns `word` unchanged.
std::string scenario_path(const std::string& word) {
    std::error_code ignored;
    if (std::filesystem::exists(word, ignored)) return word;
    const std::filesystem::path data = std::filesystem::absolute(data_directory(), ignored).lexically_normal();
    const std::filesystem::path shipped = data.parent_path() / word;
    return std::filesystem::exists(shipped, ignored) ? shell_word(shipped.string()) : word;
}

std::string runnable_word(const std::string& word) {
    if (is_program(word)) return program_command(word);
    return is_shipped_scenario(word) ? scenario_path(word) : word;
}

}  // namespace

std::string program_command(const std::string& program) {
    const std::string started_as = program_invocation_name;  // argv[0], from the C library
    const std::size_t slash = started_as.rfind('/');
    return slash == std::string::npos ? program : shell_word(started_as.substr(0, slash + 1) + program);
}

std::string runnable(const std::string& text) {
    std::string result;
    std::size_t begin = 0;
    while (begin < text.size()) {
        const std::size_t end = std::min(text.find_first_of(kSeparators, begin), text.size());
        result += runnable_word(text.substr(begin, end - begin));
        if (end < text.size()) result += text[end];
        begin = end + 1;
    }
    return result;
}

}  // namespace stopline
