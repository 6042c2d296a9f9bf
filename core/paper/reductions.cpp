#include "paper/reductions.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "base/io/csv.h"
#include "base/io/output.h"
#include "runs/tables/column_aliases.h"

namespace stopline {

namespace {

constexpr const char* kRepetitions = "repetitions";
constexpr const char* kAxis = "axis ";

std::string trimmed(const std::string& text) {
    const std::size_t from = text.find_first_not_of(' ');
    return from == std::string::npos ? "" : text.substr(from, text.find_last_not_of(' ') - from + 1);
}

std::vector<std::string> values_of(const std::string& text) {
    std::vector<std::string> values;
    std::istringstream in(text);
    for (std::string value; std::getline(in, value, ';');) values.push_back(trimmed(value));
    return values;
}

bool is_axis(const Reductions::Row& row) { return row.field.starts_with(kAxis); }

void keep(SweepSettings& sweep, const Reductions::Row& row) {
    const std::string name = row.field.substr(std::string(kAxis).size());
    const auto axis =
        std::find_if(sweep.axes.begin(), sweep.axes.end(), [&](const SweepAxis& a) { return a.name == name; });
    if (axis == sweep.axes.end()) throw InputError(fmt::format("the sweep {} has no axis '{}'", sweep.name, name));
    std::vector<std::string>& available = axis->values.empty() ? axis->populations : axis->values;
    const std::vector<std::string> wanted = values_of(row.value);
    for (const std::string& value : wanted) {
        const bool all_populations = axis->values.empty() && available == std::vector<std::string>{kAllPopulations};
        if (all_populations || std::find(available.begin(), available.end(), value) != available.end()) continue;
        throw InputError(fmt::format("the axis '{}' of the sweep {} has no value '{}'; its values: {}", name,
                                     sweep.name, value, fmt::join(available, "; ")));
    }
    available = wanted;
}

}  // namespace

Reductions Reductions::load(const std::filesystem::path& file) {
    Reductions reductions;
    CsvTable table = parse_csv(read_file(file), file.string());
    reductions.warnings_ = use_current_column_names("data/paper/quick.csv", table);
    const std::size_t applies_to = table.column("applies_to"), field = table.column("field"),
                      value = table.column("value");
    for (std::size_t k = 0; k < table.rows.size(); ++k) {
        const std::vector<std::string>& row = table.rows[k];
        const auto number = parse_number(row[value]);
        if (row[field] == kRepetitions && (!number || *number < 1.0 || *number > 1000.0)) {
            throw InputError(fmt::format("{}:{}: '{}' is not a number of repetitions (allowed: 1 to 1000)", table.label,
                                         table.lines[k], row[value]));
        }
        if (row[applies_to].empty() || row[field].empty() || row[value].empty()) {
            throw InputError(fmt::format("{}:{}: a field is empty", table.label, table.lines[k]));
        }
        reductions.rows_.push_back({row[applies_to], row[field], row[value]});
    }
    return reductions;
}

std::vector<std::string> Reductions::settings(const std::string& applies_to) const {
    std::vector<std::string> settings;
    for (const Row& row : rows_) {
        if (row.applies_to == applies_to && row.field != kRepetitions && !is_axis(row)) {
            settings.push_back(row.field + "=" + row.value);
        }
    }
    return settings;
}

std::optional<int> Reductions::repetitions(const std::string& applies_to) const {
    for (const Row& row : rows_) {
        if (row.applies_to == applies_to && row.field == kRepetitions) {
            return static_cast<int>(parse_number(row.value).value_or(1.0));
        }
    }
    return std::nullopt;
}

void Reductions::apply(SweepSettings& sweep) const {
    const std::string applies_to = "sweeps/" + sweep.name;
    for (const Row& row : rows_) {
        if (row.applies_to == applies_to && is_axis(row)) keep(sweep, row);
    }
    if (const std::optional<int> reduced = repetitions(applies_to)) sweep.repetitions = *reduced;
}

}  // namespace stopline
