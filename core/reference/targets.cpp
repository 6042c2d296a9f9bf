#include "reference/targets.h"

#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/csv.h"
#include "base/io/data_directory.h"
#include "base/io/output.h"

namespace stopline {

std::vector<Target> load_targets(const std::filesystem::path& file) {
    const CsvTable table = parse_csv(read_file(file), file.string());
    const auto column = [&](const char* name) { return table.column(name); };
    const std::size_t id = column("id"), section = column("section"), scenario = column("scenario");
    const std::size_t kind = column("kind"), quantity = column("quantity"), condition = column("condition");
    const std::size_t value = column("value"), unit = column("unit"), tolerance = column("tolerance");
    const std::size_t tolerance_kind = column("tolerance_kind"), note = column("note");
    std::vector<Target> targets;
    std::set<std::string> ids;
    for (const std::vector<std::string>& row : table.rows) {
        if (!ids.insert(row[id]).second)
            throw InputError(fmt::format("{}: the id {} appears twice", table.label, row[id]));
        targets.push_back({row[id], row[section], row[scenario], row[kind], row[quantity], row[condition], row[value],
                           row[unit], row[tolerance], row[tolerance_kind], row[note]});
    }
    return targets;
}

std::vector<Target> load_targets() { return load_targets(data_directory() / "paper" / "targets.csv"); }
std::vector<Target> load_own_rows() { return load_targets(data_directory() / "paper" / "own_rows.csv"); }

bool in_section(const Target& target, const std::string& section) {
    if (!target.section.starts_with(section)) return false;
    const std::string rest = target.section.substr(section.size());
    return rest.empty() || rest.front() == '.' || rest.front() == ' ';
}

std::optional<GreenCondition> parse_green_condition(const std::string& condition) {
    const std::size_t green = condition.find(" green");
    if (green == std::string::npos) return std::nullopt;
    std::string population = condition.substr(0, green);
    const std::string pattern = " alternating";
    if (population.ends_with(pattern)) population.erase(population.size() - pattern.size());
    std::string rest = condition.substr(green + std::string(" green").size());
    const bool and_above = rest.starts_with(">=");
    if (!and_above && !rest.starts_with("=")) return std::nullopt;
    const std::optional<double> seconds = parse_number(rest.substr(and_above ? 2 : 1));
    if (!seconds || population.find(' ') != std::string::npos) return std::nullopt;
    return GreenCondition{population, *seconds, and_above};
}

std::optional<TurnCondition> parse_turn_condition(const std::string& condition) {
    std::istringstream words(condition);
    TurnCondition result;
    if (!(words >> result.population)) return std::nullopt;
    if (result.population == "MIX") result.population = "P50";
    // Returns the number in the next word, which must have the form name=NUMBER; std::nullopt otherwise.
    const auto number = [&](const std::string& name) {
        std::string word;
        if (!(words >> word) || !word.starts_with(name + "=")) return std::optional<double>();
        return parse_number(word.substr(name.size() + 1));
    };
    const std::optional<double> green_s = number("green");
    const std::optional<double> left = number("left");
    const std::optional<double> right = number("right");
    if (!green_s || !left || !right) return std::nullopt;
    result.green_s = *green_s;
    result.left_percent = *left;
    result.right_percent = *right;
    return result;
}

}  // namespace stopline
