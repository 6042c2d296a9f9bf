#include "scenario/axis_column.h"

#include <algorithm>
#include <memory>
#include <set>
#include <string_view>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenario/field_path.h"
#include "scenario/fields.h"
#include "scenario/load_sweep.h"
#include "scenario/quantity.h"
#include "scenario/yaml_source.h"

namespace stopline {

namespace {

// "km/h" as the end of a column's name: kmh; "m/s2": mps2.
std::string column_suffix(std::string_view unit_text) {
    if (unit_text.empty()) return {};
    if (unit_text == "%") return "_percent";
    if (unit_text == "km/h") return "_kmh";
    std::string suffix = "_";
    for (const char c : unit_text) suffix += c == '/' ? std::string("p") : std::string(1, c);
    return suffix;
}

// The unit of a field's numbers; null where its values are texts, whole numbers or lists.
const Unit* unit_of(const std::string& path) {
    const Field* const field = find_field(scenario_table(), path).field;
    const auto* const number = field == nullptr ? nullptr : std::get_if<NumberField>(&field->kind);
    return number == nullptr ? nullptr : number->shown;
}

// "10 s" becomes "10" where seconds are shown.
std::string number_of(const std::string& text, const Unit& shown) {
    const double si = parse_quantity(text, shown).si;
    const std::string exact = exact_text(si, shown);
    const auto space = exact.find(' ');
    const std::string number = exact.substr(0, space);
    const std::string written = space == std::string::npos ? "" : exact.substr(space + 1);
    return written == shown.text ? number : fmt::format("{}", from_si(si, shown));
}

std::vector<std::string> texts_of(const SweepAxis& axis, std::size_t value) {
    std::vector<std::string> texts = axis_overrides(axis, value);
    for (std::size_t k = 0; k < texts.size(); ++k) texts[k] = texts[k].substr(axis.paths[k].size() + 1);
    return texts;
}

// {kind: saturated, left: 5 %} as "saturated, left 5 %".
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
            words.push_back(part);  // the combinations say what is wrong with it
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
        const Unit* const shown = unit_of(axis.paths[k]);
        if (shown == nullptr) continue;
        parts[k] = number_of(parts[k], *shown) + (shown->text.empty() ? "" : " ") + std::string(shown->text);
    }
    return parts;
}

AxisColumn axis_column(const SweepAxis& axis) {
    AxisColumn column;
    const Unit* const shown = unit_of(axis.paths.front());
    std::set<std::string> firsts;
    for (std::size_t i = 0; i < axis.values.size(); ++i) {
        const std::string first = texts_of(axis, i).front();
        column.cells.push_back(shown == nullptr ? first : number_of(first, *shown));
        column.titles.push_back(title_of(axis_parts(axis, i)));
        firsts.insert(column.cells.back());
    }
    column.name = axis.name + (shown == nullptr ? "" : column_suffix(shown->text));
    if (firsts.size() == axis.values.size()) return column;
    column.name = axis.name;
    for (std::size_t i = 0; i < axis.values.size(); ++i) {
        column.cells[i] = fmt::format("{}", fmt::join(axis_parts(axis, i), " / "));
    }
    return column;
}

}  // namespace stopline
