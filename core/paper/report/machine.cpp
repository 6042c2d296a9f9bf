#include "paper/report/machine.h"

#include <unistd.h>

#include <cmath>
#include <fstream>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace stopline {

namespace {

// Finds the first line of the file that starts with `name` and contains the separator. Returns the text after the
// separator, without quotes. Returns an empty text if the file has no such line.
std::string value_of(const char* file, const std::string& name, char separator) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with(name)) continue;
        const std::size_t found = line.find(separator);
        if (found == std::string::npos) continue;
        std::string value = line.substr(found + 1);
        value.erase(0, value.find_first_not_of(" \t\""));
        while (!value.empty() && (value.back() == '"' || value.back() == ' ')) value.pop_back();
        return value;
    }
    return "";
}

}  // namespace

std::string machine_text() {
    constexpr double kGigabyte = 1e9;
    std::vector<std::string> parts;
    const auto add = [&parts](std::string part) {
        if (!part.empty()) parts.push_back(std::move(part));
    };
    add(value_of("/proc/cpuinfo", "model name", ':'));
    const long processors = ::sysconf(_SC_NPROCESSORS_CONF);
    if (processors > 0) add(fmt::format("{} processor{}", processors, processors == 1 ? "" : "s"));
    const double bytes = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGE_SIZE));
    if (bytes > 0.0) add(fmt::format("{:.0f} GB", std::round(bytes / kGigabyte)));
    add(value_of("/etc/os-release", "PRETTY_NAME", '='));
    return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace stopline
