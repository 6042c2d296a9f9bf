#include "paper/measurements.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/csv.h"
#include "base/io/output.h"
#include "base/text_hash.h"
#include "runs/program_identity.h"

namespace stopline {

namespace {

constexpr const char* kKeyRow = "key";
constexpr const char* kChecksumRow = "checksum";  // last row of the file

std::string checksum_of(const Measurements& measurements) {
    std::string text;
    for (const auto& [name, value] : measurements.values())
        text += name + (std::isnan(value) ? " nan\n" : fmt::format(" {:a}\n", value));
    return fmt::format("{:016x}", hash_of(text));
}

}  // namespace

std::optional<double> Measurements::find(const std::string& name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) return std::nullopt;
    return found->second;
}

std::optional<std::string> results_key(const Scenario& scenario) {
    const std::optional<std::string> program = program_identity();
    if (!program) return std::nullopt;
    return fmt::format("scenario {:016x}, {}", scenario.hash, *program);
}

std::optional<Measurements> load_measurements(const std::filesystem::path& file, const std::string& key) {
    if (!std::filesystem::exists(file)) return std::nullopt;
    try {
        const CsvTable table = parse_csv(read_file(file), file.string());
        const std::size_t name = table.column("name");
        const std::size_t value = table.column("value");
        Measurements measurements;
        bool same_key = false;
        std::string checksum;
        for (const std::vector<std::string>& row : table.rows) {
            if (row[name] == kKeyRow) {
                same_key = row[value] == key;
                continue;
            }
            if (row[name] == kChecksumRow) {
                checksum = row[value];
                continue;
            }
            const std::optional<double> number =
                row[value] == "nan" ? std::numeric_limits<double>::quiet_NaN() : parse_number(row[value]);
            if (!number) return std::nullopt;
            measurements.set(row[name], *number);
        }
        if (!same_key || checksum != checksum_of(measurements)) return std::nullopt;
        return measurements;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

void store_measurements(const std::filesystem::path& file, const std::string& key, const Measurements& measurements) {
    CsvWriter csv({"name", "value"});
    csv.row({kKeyRow, key});
    for (const auto& [name, value] : measurements.values()) {
        // fmt writes the shortest text that reads back as the same double.
        csv.row({name, std::isnan(value) ? "nan" : fmt::format("{}", value)});
    }
    csv.row({kChecksumRow, checksum_of(measurements)});
    write_file(file, csv.text());
}

}  // namespace stopline
