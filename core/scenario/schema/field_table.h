// The table of fields: one row per field of a settings struct. The rows drive reading (read_fields.h), writing
// (write_fields.h), the list of fields (describe.cpp) and the JSON schema (json_schema.cpp), so these always agree.
//
// A row binds a name in the file to a struct member:
//     number<&SignalSettings::green_s>("green", "s", {0.1, 7200}, "green time")
// The struct gives the defaults. `.required()` marks a field without default. `.fallback(text)` gives a default as YAML
// text. One table has rows of different types, so a row reaches its member through untyped pointers. field_rows.h makes
// the rows, and the compiler checks that a table for S has rows of S only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenario/schema/quantity.h"
#include "scenario/schema/report.h"
#include "scenario/yaml/source_node.h"

namespace stopline {

struct Table;

// Both ends are allowed. The values are in the unit of the field.
struct Range {
    double min = 0.0;
    double max = std::numeric_limits<double>::max();
};
struct Count {
    std::uint64_t min = 0;
    std::uint64_t max = std::numeric_limits<std::uint64_t>::max();
};

// Reaches a member of type T in a struct that is known by its address only.
template <class T>
struct Access {
    T& (*write)(void* settings);
    const T& (*read)(const void* settings);
};

struct NumberField {
    Access<double> at;
    const Unit* unit;
    Range range;
};
struct WholeField {
    std::uint64_t (*get)(const void* settings);
    void (*set)(void* settings, std::uint64_t value);
    Count range;
};
struct TextField {
    enum class Rule {
        name,  // fit for a file name and a CSV cell
        title  // one line of text
    };
    Access<std::string> at;
    Rule rule;
};
// A list of texts. A single text may stand for a list of one.
struct TextsField {
    Access<std::vector<std::string>> at;
    TextField::Rule rule;
    Count size;
};
struct ChoiceField {
    std::vector<std::string> names;
    std::function<std::string(const void* settings)> get;
    std::function<void(void* settings, const std::string& name)> set;
};
struct NumbersField {
    Access<std::vector<double>> at;
    const Unit* unit;
    Range range;
    Count size;
    bool rising;
};
// A sampled function, written as a map "x: y" with strictly rising x.
struct CurveField {
    Access<std::vector<double>> x;
    Access<std::vector<double>> y;
    const Unit* x_unit;
    Range x_range;
    const Unit* y_unit;
    Range y_range;
    Count size;
};
// A nested map. `library` is a folder of the data directory, or empty. With a library, the name of a file in it may
// stand for the map. The map may also name such a file as `base` and give only the fields that differ from it.
struct SectionField {
    void* (*write)(void* settings);
    const void* (*read)(const void* settings);
    const Table& (*table)();
    std::string library;
};
// A list of maps. `library` is "folder/file" in the data directory, or empty. With a library, the list of that file
// comes first. An entry with the same name replaces the entry of the file.
struct ListField {
    std::size_t (*size)(const void* settings);
    const void* (*item)(const void* settings, std::size_t index);
    void* (*append)(void* settings);
    const Table& (*table)();
    Count count;
    std::string library;
};

using FieldKind = std::variant<NumberField, WholeField, TextField, TextsField, ChoiceField, NumbersField, CurveField,
                               SectionField, ListField>;

// A value of a choice that has another name now.
struct OldValue {
    std::string old_name;
    std::string name;
};

struct Field {
    std::string name;
    std::string meaning;
    FieldKind kind;
    bool required = false;
    std::string fallback = {};  // YAML text of the default; empty: the default of the struct
    // The field exists only if the choice at `condition_field` has one of these values. The choice is a field of the
    // same table, or of a section before this field, such as network.kind. Empty: the field always exists.
    std::string condition_field = {};
    std::vector<std::string> condition_values = {};
    // The field belongs to the rule in `condition_field`. While the rule is off, the value 'off' is accepted. If only
    // an override switched the rule off, any value of the file is accepted, so that the file need not change.
    bool is_rule_parameter = false;
    std::vector<std::string> old_names = {};  // of the last release, accepted with a warning, see old_names.h
    std::vector<OldValue> old_values = {};    // of a choice, likewise
};

struct Table {
    std::string title;
    std::vector<Field> fields;
    std::shared_ptr<void> (*make_default)() = nullptr;
    std::function<void(const void* settings, Checker&)> check;  // compares several fields; may be empty
    SourceNode (*expand)(const SourceNode& scalar) = nullptr;   // makes a map from a single word; may be null

    // Both return null if there is no such field.
    const Field* find(std::string_view name) const;
    const Field* find_old_name(std::string_view name) const;
    std::vector<std::string> names() const;
};

// Returns true if the field exists in these settings, see Field::condition_field.
bool applies(const Table& table, const Field& field, const void* settings);

// Returns true if the text follows TextField::Rule::name: 1 to 64 letters, digits and - _ . + signs, not only signs.
bool is_name(const std::string& text);

// Returns the allowed values in words: "0.1 s to 7200 s", "one of: full, meso".
std::string allowed_text(const FieldKind& kind);
// Returns "s", "km/h" and so on, or "" for a field without unit.
std::string unit_text(const FieldKind& kind);
// Returns the unit, or else the type: "number", "whole number", "text", "choice", "list", "section".
std::string type_text(const FieldKind& kind);

}  // namespace stopline
