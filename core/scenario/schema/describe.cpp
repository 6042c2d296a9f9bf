// Writes the list of all fields, as text for a terminal and as a Markdown page.
#include <algorithm>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "base/io/escape.h"
#include "base/nearest_name.h"
#include "scenario/load_scenario.h"
#include "scenario/schema/fields.h"
#include "scenario/schema/report.h"
#include "scenario/schema/write_fields.h"
#include "scenario/sweep_file/load_sweep.h"

namespace stopline {
namespace {

struct FieldLine {
    std::string field;
    std::string unit;
    std::string type;
    std::string default_value;
    std::string allowed;
    std::string meaning;
};

// The lines for all fields of one table.
struct TableBlock {
    std::string path;  // path of the section or list; empty: the top level of the file
    std::string title;
    std::vector<FieldLine> lines;
};

std::string or_dash(const std::string& text) { return text.empty() ? "-" : text; }

std::string default_value(const Field& field, const void* settings) {
    if (field.required) return "required";
    return or_dash(field.fallback.empty() ? value_text(field.kind, settings) : field.fallback);
}

std::string meaning_text(const Field& field) {
    std::string text = field.meaning;
    if (!field.condition_field.empty()) {
        text += " (only if " + field.condition_field + " is " + joined(field.condition_values, " or ") + ")";
    }
    for (const std::string& old_name : field.old_names) text += " (old name: " + old_name + ")";
    for (const OldValue& old : field.old_values) text += " (old name of " + old.name + ": " + old.old_name + ")";
    return text;
}

// Adds a block for the table, then blocks for its sections and lists. `settings` is a struct with the default values.
void add_blocks(const Table& table, const std::string& path, const void* settings, std::vector<TableBlock>& blocks) {
    TableBlock block{path, table.title, {}};
    for (const Field& field : table.fields) {
        block.lines.push_back({field.name, or_dash(unit_text(field.kind)), type_text(field.kind),
                               default_value(field, settings), allowed_text(field.kind), meaning_text(field)});
    }
    blocks.push_back(std::move(block));
    for (const Field& field : table.fields) {
        const std::string inner_path = join_path(path, field.name);
        if (const auto* const section = std::get_if<SectionField>(&field.kind)) {
            // An optional section with a library has the same fields as a section of the top level.
            if (section->is_optional && !section->library.empty()) continue;
            const Table& inner = section->table();
            const void* const values = section->read(settings);
            add_blocks(inner, inner_path, values != nullptr ? values : inner.make_default().get(), blocks);
        } else if (const auto* const list = std::get_if<ListField>(&field.kind)) {
            const Table& inner = list->table();
            add_blocks(inner, inner_path + "[]", inner.make_default().get(), blocks);
        }
    }
}

std::vector<TableBlock> scenario_blocks() {
    std::vector<TableBlock> blocks;
    const Scenario defaults;
    add_blocks(scenario_table(), "", &defaults, blocks);
    return blocks;
}

std::vector<TableBlock> sweep_blocks() {
    std::vector<TableBlock> blocks;
    const SweepSettings defaults;
    add_blocks(sweep_table(), "", &defaults, blocks);
    return blocks;
}

// --- Fields whose path contains a text ---

// Returns the path without the texts in its brackets: policies[CTG-Ref].time_gap becomes policies[].time_gap.
std::string without_entries(const std::string& path) {
    std::string text;
    bool is_inside = false;
    for (const char c : path) {
        if (c == ']') is_inside = false;
        if (!is_inside) text += c;
        if (c == '[') is_inside = true;
    }
    return text;
}

// Throws InputError: no path contains the text. The message suggests the nearest path, section or field name.
[[noreturn]] void refuse_path(const std::string& text, const std::vector<TableBlock>& blocks) {
    std::vector<std::string> known;
    for (const TableBlock& block : blocks) {
        if (!block.path.empty()) known.push_back(block.path);
        for (const FieldLine& line : block.lines) {
            known.push_back(join_path(block.path, line.field));
            known.push_back(line.field);
        }
    }
    const std::string nearest = nearest_name(without_entries(text), known);
    throw InputError("no field has '" + shortened(text) + "' in its path" +
                     (nearest.empty() ? "" : "; did you mean '" + nearest + "'?") +
                     " (stopline-run --describe lists all fields)");
}

// Returns true if the last part of the text is a former name of the field.
bool had_name(const FieldLine& line, const std::string& text) {
    const std::size_t dot = text.rfind('.');  // npos + 1 is 0
    return line.meaning.find("(old name: " + text.substr(dot + 1) + ")") != std::string::npos;
}

// Removes the fields whose path does not contain the text, unless it is their former name.
void keep_paths_with(const std::string& text, std::vector<TableBlock>& blocks) {
    const std::vector<TableBlock> all = blocks;
    for (TableBlock& block : blocks) {
        std::erase_if(block.lines, [&](const FieldLine& line) {
            return join_path(block.path, line.field).find(without_entries(text)) == std::string::npos &&
                   !had_name(line, text);
        });
    }
    std::erase_if(blocks, [](const TableBlock& block) { return block.lines.empty(); });
    if (blocks.empty()) refuse_path(text, all);
}

// --- Text for a terminal ---

constexpr std::size_t kColumnWidthMax = 20;  // default values with more characters are listed below the tables

std::string short_default(const FieldLine& line) {
    return line.default_value.size() <= kColumnWidthMax ? line.default_value : "see below";
}

// Returns the text, filled with spaces up to `width` characters. Characters are counted instead of bytes, because a
// unit may have a superscript.
std::string padded(const std::string& text, std::size_t width) {
    const auto characters = static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
    return text + std::string(width > characters ? width - characters : 0, ' ');
}

std::string block_text(const TableBlock& block) {
    const FieldLine header{"field", "unit", "", "default", "allowed", "meaning"};
    std::size_t field = header.field.size();
    std::size_t unit = header.unit.size();
    std::size_t value = header.default_value.size();
    std::size_t allowed = header.allowed.size();
    for (const FieldLine& line : block.lines) {
        field = std::max(field, line.field.size());
        unit = std::max(unit, line.unit.size());
        value = std::max(value, short_default(line).size());
        allowed = std::max(allowed, line.allowed.size());
    }
    const auto row = [&](const FieldLine& line) {
        return "  " + padded(line.field, field) + "  " + padded(line.unit, unit) + "  " +
               padded(short_default(line), value) + "  " + padded(line.allowed, allowed) + "  " + line.meaning + "\n";
    };
    std::string text = (block.path.empty() ? "top level" : block.path) + ": " + block.title + "\n" + row(header);
    for (const FieldLine& line : block.lines) text += row(line);
    return text + "\n";
}

std::string long_defaults(const std::vector<TableBlock>& blocks) {
    std::string text;
    for (const TableBlock& block : blocks) {
        for (const FieldLine& line : block.lines) {
            if (line.default_value.size() <= kColumnWidthMax) continue;
            text += "Default of " + join_path(block.path, line.field) + ":\n  " + line.default_value + "\n";
        }
    }
    return text;
}

// --- Markdown ---

std::string cell(const std::string& text) { return escape_markdown_cell(text) + " | "; }

std::string as_sentence(std::string text) {
    if (text.front() >= 'a' && text.front() <= 'z') text.front() = static_cast<char>(text.front() - 'a' + 'A');
    return text + ".";
}

std::string block_markdown(const TableBlock& block) {
    std::string text = "### " + (block.path.empty() ? "Top level" : "`" + block.path + "`") + "\n\n" +
                       as_sentence(block.title) + "\n\n| field | unit or type | range | default | meaning |\n" +
                       "|---|---|---|---|---|\n";
    for (const FieldLine& line : block.lines) {
        std::string row = "| " + cell("`" + line.field + "`") + cell(line.type) + cell(line.allowed) +
                          cell(line.default_value) + cell(line.meaning);
        row.pop_back();
        text += row + "\n";
    }
    return text + "\n";
}

}  // namespace

std::string describe_fields(const std::string& text) {
    std::vector<TableBlock> blocks = scenario_blocks();
    if (!text.empty()) keep_paths_with(text, blocks);
    std::string list =
        "Fields of a scenario file (YAML). Every quantity has a unit: 50 km/h, 0.87 s, 2.95 m, 30 %.\n"
        "The command line sets a field by its path: --set 'signal.green=20 s', "
        "--set 'policies[CTG-Ref].time_gap=0.6 s'.\n\n";
    for (const TableBlock& block : blocks) list += block_text(block);
    return list + long_defaults(blocks);
}

std::string describe_sweep_fields() {
    std::string text =
        "Fields of a sweep file (YAML). stopline-run --describe lists the fields that a path can name.\n\n";
    for (const TableBlock& block : sweep_blocks()) text += block_text(block);
    return text;
}

std::string fields_markdown() {
    std::string text =
        "# Fields of scenario and sweep files\n\n"
        "<!-- Do not edit. Written by: stopline-run --describe-markdown > scenarios/FIELDS.md -->\n\n"
        "Every quantity has a unit, such as 50 km/h, 0.87 s, 2.95 m or 30 %.\n"
        "A path is the name of a field after the names of its sections: `signal.green`, `policies[CTG-Ref].time_gap`.\n"
        "The option `--set PATH=VALUE` sets one field for a run. In a heading, `[]` stands for each list entry.\n\n"
        "## Scenario file\n\n";
    for (const TableBlock& block : scenario_blocks()) text += block_markdown(block);
    text += "## Sweep file\n\n";
    for (const TableBlock& block : sweep_blocks()) text += block_markdown(block);
    text.pop_back();  // removes the empty line at the end
    return text;
}

}  // namespace stopline
