// The table of fields: for every settings struct, one row a field. Rows drive reading (read_fields.h), writing
// (write_fields.h), the list of fields (describe.cpp) and the JSON schema (json_schema.cpp), so these cannot disagree.
//
// A row binds a name in the file to a struct member:
//     number<&SignalSettings::green_s>("green", "s", {0.1, 7200}, "green time")
// Defaults are those of the struct itself; `.required()` says there is none, `.fallback(text)` gives one as it would stand
// in a file. Rows of different types lie in one table, so a member is reached through untyped pointers; field_rows.h makes
// the rows and lets the compiler check that a table for S has only rows of S.
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

#include "scenario/quantity.h"
#include "scenario/report.h"
#include "scenario/source_node.h"

namespace stopline {

struct Table;

// Ends included, in the unit that is shown.
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
    const Unit* shown;
    Range range;
};
struct WholeField {
    std::uint64_t (*get)(const void* settings);
    void (*set)(void* settings, std::uint64_t value);
    Count range;
};
struct TextField {
    enum class Rule { name, title };  // a name can be part of a file name or of a CSV cell; a title is one line of text
    Access<std::string> at;
    Rule rule;
};
// Texts of one rule; a single one may stand in place of the list.
struct TextsField {
    Access<std::vector<std::string>> at;
    TextField::Rule rule;
    Count size;
};
// One of these names.
struct ChoiceField {
    std::vector<std::string> names;
    std::function<std::string(const void* settings)> get;
    std::function<void(void* settings, const std::string& name)> set;
};
struct NumbersField {
    Access<std::vector<double>> at;
    const Unit* shown;
    Range range;
    Count size;
    bool rising;
};
// A function by its samples, written as a map "x: y" with x strictly rising.
struct CurveField {
    Access<std::vector<double>> x;
    Access<std::vector<double>> y;
    const Unit* x_shown;
    Range x_range;
    const Unit* y_shown;
    Range y_range;
    Count size;
};
// A nested map. With a library (a folder of the data directory) the name of a file there may stand in its place, or as
// `base` in it, and then only what differs from that file is given.
struct SectionField {
    void* (*write)(void* settings);
    const void* (*read)(const void* settings);
    const Table& (*table)();
    std::string library;
};
// A list of maps. With a library file, the list of that file comes first and an entry of the same name replaces its.
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

struct Field {
    std::string name;
    std::string meaning;
    FieldKind kind;
    bool required = false;
    std::string fallback = {};  // YAML text that stands for an absent field
    // The field exists only where the sibling `only_field`, a choice, or one in a section before it (network.kind), has one of these
    // values.
    std::string only_field = {};
    std::vector<std::string> only_values = {};
    // It belongs to a rule that only_field switches. Where the rule is off it may be given as `off` too, and in a file as anything if it was
    // an override that switched the rule off: the file need not be changed for that.
    bool of_a_rule = false;
};

struct Table {
    std::string title;
    std::vector<Field> fields;
    std::shared_ptr<void> (*make_default)() = nullptr;
    std::function<void(const void* settings, Checker&)> check;  // what depends on several fields; may be empty
    SourceNode (*expand)(const SourceNode& scalar) = nullptr;   // a single word that stands for a map; may be null

    const Field* find(std::string_view name) const;
    std::vector<std::string> names() const;
};

// Whether a field exists in these settings (see Field::only_field).
bool applies(const Table& table, const Field& field, const void* settings);

// "0.1 s to 7200 s"; "one of: full, meso"; ...
std::string allowed_text(const FieldKind& kind);
// "s", "km/h", ... or "" where there is none.
std::string unit_text(const FieldKind& kind);

}  // namespace stopline
