#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/units.h"
#include "experiment/startup.h"

namespace stopline {

namespace {

std::vector<double> numbers_in(const std::string& line, const std::filesystem::path& file, int number) {
    std::vector<double> values;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) {
        std::size_t used = 0;
        try {
            values.push_back(std::stod(cell, &used));
        } catch (const std::exception&) {
            used = 0;
        }
        if (used == 0) throw InputError(fmt::format("{}:{}: '{}' is not a number", file.string(), number, cell));
    }
    return values;
}

}  // namespace

StartupCurve load_startup_curve(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string line;
    if (!std::getline(in, line)) throw InputError(fmt::format("{}: cannot be read or is empty", file.string()));
    StartupCurve curve;
    for (int number = 2; std::getline(in, line); ++number) {
        if (line.empty() || line[0] == '#') continue;
        const std::vector<double> v = numbers_in(line, file, number);
        if (v.size() < 6) {
            throw InputError(
                fmt::format("{}:{}: six columns are needed: t_s, mean_kmh, sd_kmh, ci95_of_mean, p2.5, p97.5",
                            file.string(), number));
        }
        curve.time_s.push_back(v[0]);
        curve.mean_mps.push_back(v[1] * kMpsPerKmh);
        curve.mean_ci_mps.push_back(v[3] * kMpsPerKmh);
        curve.low_mps.push_back(v[4] * kMpsPerKmh);
        curve.high_mps.push_back(v[5] * kMpsPerKmh);
    }
    if (curve.time_s.size() < 2) throw InputError(fmt::format("{}: at least two rows are needed", file.string()));
    return curve;
}

}  // namespace stopline
