#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/csv.h"
#include "base/io/output.h"
#include "base/nearest_name.h"
#include "base/units.h"
#include "calibration/startup.h"

namespace stopline {

namespace {

namespace fs = std::filesystem;

constexpr double kMaxTime_s = 600.0;
constexpr double kMaxSpeed_kmh = 500.0;
constexpr double kMaxStarts = 1e6;

// Reads a text file. Rejects control characters and non-ASCII bytes, because error messages print parts of the file on
// the terminal.
std::string plain_text(const fs::path& file) {
    constexpr std::uintmax_t kMaxBytes = 4U << 20U;
    if (fs::exists(file) && !fs::is_directory(file) && !fs::is_regular_file(file)) {
        throw InputError(fmt::format("{}: is not a regular file", file.string()));
    }
    if (fs::is_regular_file(file) && fs::file_size(file) > kMaxBytes) {
        throw InputError(fmt::format("{}: the file is larger than the allowed {} bytes", file.string(), kMaxBytes));
    }
    std::string text = read_file(file);
    int line = 1;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '\n') ++line;
        if (c == '\n' || c == '\r' || c == '\t' || (byte >= 0x20 && byte < 0x7F)) continue;
        throw InputError(fmt::format("{}:{}: byte 0x{:02X} is not plain ASCII text", file.string(), line, byte));
    }
    return text;
}

// Tries the names in their order. Returns the index of the column with the first name that the table has; nothing if it
// has none of them.
std::optional<std::size_t> find_column(const CsvTable& table, std::initializer_list<const char*> names) {
    for (const char* const name : names) {
        const auto found = std::find(table.columns.begin(), table.columns.end(), name);
        if (found != table.columns.end()) return static_cast<std::size_t>(found - table.columns.begin());
    }
    return std::nullopt;
}

std::size_t needed_column(const CsvTable& table, const char* name, std::initializer_list<const char*> names) {
    if (const std::optional<std::size_t> column = find_column(table, names)) return *column;
    throw InputError(fmt::format(
        "{}:1: column '{}' is missing; required columns: t_s, mean_kmh; optional columns: ci95_of_mean (half "
        "width), p2.5 and p97.5 (km/h), n (starts)",
        table.label, name));
}

[[noreturn]] void refuse(const CsvTable& table, std::size_t row, std::size_t column, const std::string& problem) {
    throw InputError(fmt::format("{}:{}: column '{}': value '{}' {}", table.label, table.lines[row],
                                 shortened(table.columns[column]), shortened(table.rows[row][column]), problem));
}

// Returns all numbers of a column, multiplied by `factor`. Throws InputError for a value outside the range.
std::vector<double> numbers(const CsvTable& table, std::size_t column, double min, double max, double factor = 1.0) {
    std::vector<double> values;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const std::optional<double> number = parse_number(table.rows[row][column]);
        if (!number) refuse(table, row, column, "is not a number");
        if (*number < min || *number > max) {
            refuse(table, row, column, fmt::format("is out of range (allowed: {:g} to {:g})", min, max));
        }
        values.push_back(*number * factor);
    }
    return values;
}

std::vector<double> speeds_mps(const CsvTable& table, std::size_t column) {
    return numbers(table, column, 0.0, kMaxSpeed_kmh, kMpsPerKmh);
}

std::vector<double> rising_times_s(const CsvTable& table, std::size_t column) {
    std::vector<double> times_s = numbers(table, column, 0.0, kMaxTime_s);
    if (times_s.size() < 2) throw InputError(fmt::format("{}: the file must have at least two rows", table.label));
    if (times_s.front() != 0.0) refuse(table, 0, column, "must be 0, the time at which the car moves");
    for (std::size_t row = 1; row < times_s.size(); ++row) {
        if (times_s[row] <= times_s[row - 1]) refuse(table, row, column, "must be greater than the time before it");
    }
    return times_s;
}

}  // namespace

StartupCurve load_startup_curve(const fs::path& file) {
    const CsvTable table = parse_csv(plain_text(file), file.string());
    StartupCurve curve;
    const std::size_t time = needed_column(table, "t_s", {"t_s"});
    const std::size_t mean = needed_column(table, "mean_kmh", {"mean_kmh"});
    curve.time_s = rising_times_s(table, time);
    curve.mean_mps = speeds_mps(table, mean);
    if (const auto width = find_column(table, {"ci95_of_mean", "ci95_of_mean_kmh"})) {
        curve.mean_ci_mps = speeds_mps(table, *width);
    }
    const bool band = find_column(table, {"p2.5", "p2.5_kmh", "p97.5", "p97.5_kmh"}).has_value();
    if (band) {
        curve.low_mps = speeds_mps(table, needed_column(table, "p2.5", {"p2.5", "p2.5_kmh"}));
        curve.high_mps = speeds_mps(table, needed_column(table, "p97.5", {"p97.5", "p97.5_kmh"}));
    }
    if (const auto starts = find_column(table, {"n"})) curve.starts = numbers(table, *starts, 1.0, kMaxStarts);
    return curve;
}

}  // namespace stopline
