// The list of all fields for people.
#include <algorithm>
#include <string>
#include <vector>

#include "scenario/fields.h"
#include "scenario/load_scenario.h"
#include "scenario/load_sweep.h"
#include "scenario/nearest_name.h"
#include "scenario/report.h"
#include "scenario/write_fields.h"

namespace stopline {
namespace {

struct Line {
    std::string field;
    std::string unit;
    std::string fallback;
    std::string allowed;
    std::string meaning;
};

// One block of the list: the fields of one table.
struct Block {
    std::string heading;
    std::vector<Line> lines;
};

bool is_short(const std::string& fallback) { return fallback.size() <= 20; }

std::string default_text(const Field& field, const void* settings) {
    if (field.required) return "required";
    if (!field.fallback.empty()) return is_short(field.fallback) ? field.fallback : "see below";
    const std::string text = value_text(field.kind, settings);
    return text.empty() ? "-" : text;
}

std::string meaning_text(const Field& field) {
    if (field.only_field.empty()) return field.meaning;
    return field.meaning + " (only where " + field.only_field + " is " + joined(field.only_values, " or ") + ")";
}

void add_blocks(const Table& table, const std::string& path, const void* settings, std::vector<Block>& blocks) {
    Block block;
    block.heading = (path.empty() ? "top level" : path) + ": " + table.title;
    for (const Field& field : table.fields) {
        std::string unit = unit_text(field.kind);
        if (unit.empty()) unit = "-";
        block.lines.push_back(
            {field.name, unit, default_text(field, settings), allowed_text(field.kind), meaning_text(field)});
    }
    blocks.push_back(std::move(block));
    for (const Field& field : table.fields) {
        const std::string inner_path = path.empty() ? field.name : path + "." + field.name;
        if (const auto* const section = std::get_if<SectionField>(&field.kind)) {
            add_blocks(section->table(), inner_path, section->read(settings), blocks);
        } else if (const auto* const list = std::get_if<ListField>(&field.kind)) {
            const Table& inner = list->table();
            add_blocks(inner, inner_path + "[]", inner.make_default().get(), blocks);
        }
    }
}

// What did not fit into the column of defaults.
std::string long_defaults(const Table& table, const std::string& path) {
    std::string text;
    for (const Field& field : table.fields) {
        const std::string inner_path = join_path(path, field.name);
        if (!is_short(field.fallback)) text += "Default of " + inner_path + ":\n  " + field.fallback + "\n";
        if (const auto* const section = std::get_if<SectionField>(&field.kind)) {
            text += long_defaults(section->table(), inner_path);
        }
    }
    return text;
}

std::string padded(const std::string& text, std::size_t width) {
    // Counts characters, not bytes: units may have a superscript.
    const auto characters = static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
    return text + std::string(width > characters ? width - characters : 0, ' ');
}

std::string block_text(const Block& block) {
    std::size_t field = 5;
    std::size_t unit = 4;
    std::size_t fallback = 7;
    std::size_t allowed = 7;
    for (const Line& line : block.lines) {
        field = std::max(field, line.field.size());
        unit = std::max(unit, line.unit.size());
        fallback = std::max(fallback, line.fallback.size());
        allowed = std::max(allowed, line.allowed.size());
    }
    const auto row = [&](const Line& line) {
        return "  " + padded(line.field, field) + "  " + padded(line.unit, unit) + "  " +
               padded(line.fallback, fallback) + "  " + padded(line.allowed, allowed) + "  " + line.meaning + "\n";
    };
    std::string text = block.heading + "\n" + row({"field", "unit", "default", "allowed", "meaning"});
    for (const Line& line : block.lines) text += row(line);
    return text + "\n";
}

}  // namespace

std::string describe_fields() {
    std::vector<Block> blocks;
    const Scenario defaults;
    add_blocks(scenario_table(), "", &defaults, blocks);
    std::string text =
        "Fields of a scenario file (YAML). Every quantity carries its unit: 50 km/h, 0.87 s, 2.95 m, 30 %.\n"
        "A field is set on the command line by its path: --set 'signal.green=20 s', --set 'policies[CTG-Ref].time_gap=0.6 s'.\n\n";
    for (const Block& block : blocks) text += block_text(block);
    return text + long_defaults(scenario_table(), "");
}

std::string describe_sweep_fields() {
    std::vector<Block> blocks;
    const SweepSettings defaults;
    add_blocks(sweep_table(), "", &defaults, blocks);
    std::string text = "Fields of a sweep file (YAML). What a path can name: stopline-run --describe.\n\n";
    for (const Block& block : blocks) text += block_text(block);
    return text;
}

}  // namespace stopline
