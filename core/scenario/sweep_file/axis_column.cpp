#include "scenario/sweep_file/axis_column.h"

#include <algorithm>
#include <memory>
#include <set>
#include <string_view>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenario/schema/field_path.h"
#include "scenario/schema/fields.h"
#include "scenario/schema/quantity.h"
#include "scenario/sweep_file/load_sweep.h"
#include "scenario/yaml/yaml_source.h"

namespace stopline {

namespace {

// Returns the suffix of a column name for a unit, such as "_kmh" for km/h and "_mps2" for m/s2.
std::string column_suffix(std::string_view unit_text) {
    if (unit_text.empty()) return {};
    if (unit_text == "%") return "_percent";
    if (unit_text == "km/h") return "_kmh";
    std::string suffix = "_";
    for (const char c : unit_text) suffix += c == '/' ? std::string("p") : std::string(1, c);
    return suffix;
}

// Returns the unit of the number field at `path`; null if the field is of another kind.
const Unit* unit_of(const std::string& path) {
    const Field* const field = find_field(scenario_table(), path).field;
    const auto* const number = field == nullptr ? nullptr : std::get_if<NumberField>(&field->kind);
    return number == nullptr ? nullptr : number->unit;
}

// Returns the quantity `text` as a number in `unit`, without the unit: "10" for "10 s" in seconds.
std::string number_of(const std::string& text, const Unit& unit) {
    const double si = parse_quantity(text, unit).si;
    const std::string exact = exact_text(si, unit);
    const auto space = exact.find(' ');
    const std::string number = exact.substr(0, space);
    const std::string written = space == std::string::npos ? "" : exact.substr(space + 1);
    return written == unit.text ? number : fmt::format("{}", from_si(si, unit));
}

std::vector<std::string> texts_of(const SweepAxis& axis, std::size_t value) {
    std::vector<std::string> texts = axis_overrides(axis, value);
    for (std::size_t k = 0; k < texts.size(); ++k) texts[k] = texts[k].substr(axis.paths[k].size() + 1);
    return texts;
}

// Returns a value as text for a title: "saturated, left 5 %" for {kind: saturated, left: 5 %}.
std::string words_of(const SourceNode& node) {
    if (node.kind != SourceNode::Kind::map && node.kind != SourceNode::Kind::list) return node.text;
    std::vector<std::string> words;
    for (std::size_t k = 0; k < node.items.size(); ++k) {
        const bool named = node.kind == SourceNode::Kind::map && node.keys[k].text != "kind";
        words.push_back((named ? node.keys[k].text + " " : "") + words_of(node.items[k]));
    }
    return fmt::format("{}", fmt::join(words, ", "));
}

std::string title_of(const std::vector<std::string>& parts) {
    std::vector<std::string> words;
    for (const std::string& part : parts) {
        try {
            words.push_back(words_of(parse_yaml(part, std::make_shared<Source>())));
        } catch (const YamlError&) {
            words.push_back(part);  // the class Sweep reports the error when it loads the combinations
        }
    }
    const bool same =
        std::count(words.begin(), words.end(), words.front()) == static_cast<std::ptrdiff_t>(words.size());
    return same ? words.front() : fmt::format("{}", fmt::join(words, " / "));
}

}  // namespace

std::vector<std::string> axis_parts(const SweepAxis& axis, std::size_t value) {
    std::vector<std::string> parts = texts_of(axis, value);
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const Unit* const unit = unit_of(axis.paths[k]);
        if (unit == nullptr) continue;
        parts[k] = number_of(parts[k], *unit) + (unit->text.empty() ? "" : " ") + std::string(unit->text);
    }
    return parts;
}

AxisColumn axis_column(const SweepAxis& axis) {
    AxisColumn column;
    const Unit* const unit = unit_of(axis.paths.front());
    std::set<std::string> distinct_cells;
    for (std::size_t i = 0; i < axis.values.size(); ++i) {
        const std::string first = texts_of(axis, i).front();
        column.cells.push_back(unit == nullptr ? first : number_of(first, *unit));
        column.titles.push_back(title_of(axis_parts(axis, i)));
        distinct_cells.insert(column.cells.back());
    }
    column.name = axis.name + (unit == nullptr ? "" : column_suffix(unit->text));
    if (distinct_cells.size() == axis.values.size()) return column;
    column.name = axis.name;
    for (std::size_t i = 0; i < axis.values.size(); ++i) {
        column.cells[i] = fmt::format("{}", fmt::join(axis_parts(axis, i), " / "));
    }
    return column;
}

}  // namespace stopline
