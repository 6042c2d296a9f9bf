#include "base/io/data_directory.h"

#include <cstdlib>
#include <system_error>

#include <fmt/format.h>

#include "base/input_error.h"

#ifndef STOPLINE_SOURCE_DATA_DIR
#define STOPLINE_SOURCE_DATA_DIR "data"
#endif

namespace stopline {

namespace {

constexpr const char* kAdvice = "set STOPLINE_DATA to the data folder of a complete copy of the project";

// Returns the folder PREFIX/share/stopline/data of a program that is installed in PREFIX/bin. Returns an empty path if
// this folder does not exist.
std::filesystem::path installed_data_directory() {
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) return {};
    const std::filesystem::path folder = program.parent_path().parent_path() / "share" / "stopline" / "data";
    return std::filesystem::is_directory(folder, error) ? folder : std::filesystem::path();
}

}  // namespace

std::filesystem::path data_directory() {
    // No thread changes the environment, so reading it is safe.
    const char* const chosen = std::getenv("STOPLINE_DATA");  // NOLINT(concurrency-mt-unsafe)
    if (chosen != nullptr && *chosen != '\0') return chosen;
    static const std::filesystem::path kInstalled = installed_data_directory();
    return kInstalled.empty() ? STOPLINE_SOURCE_DATA_DIR : kInstalled;
}

void require_data_directory() {
    const std::filesystem::path data = data_directory();
    std::error_code ignored;
    if (!std::filesystem::is_directory(data, ignored)) {
        throw InputError(fmt::format("there is no data folder {}; {}", data.string(), kAdvice));
    }
}

std::filesystem::path scenario_directory() {
    require_data_directory();
    const std::filesystem::path data = data_directory();
    const std::filesystem::path scenarios = (data / ".." / "scenarios").lexically_normal();
    std::error_code ignored;
    if (!std::filesystem::is_directory(scenarios, ignored)) {
        throw InputError(fmt::format(
            "there is no folder {}; the shipped scenarios must lie beside the data folder {}. Copy them there, or {}",
            scenarios.string(), data.string(), kAdvice));
    }
    return scenarios;
}

}  // namespace stopline
