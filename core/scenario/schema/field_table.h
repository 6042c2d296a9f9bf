// The table of fields: one row per field of a settings struct. Reading (read_fields.h), writing (write_fields.h), the
// list of fields (describe.cpp) and the JSON schema (json_schema.cpp) use the same rows, so they always agree.
//
// A row binds the name of a field in the file to a struct member:
//     number<&SignalSettings::green_s>("green", "s", {0.1, 7200}, "green time")
// The initialiser of the member is the default of the field. `.required()` marks a field without default.
// `.fallback(text)` gives a default as YAML text. The members of a struct have different types, so a row accesses its
// member through a void pointer to the struct. field_rows.h makes the rows. The compiler checks that all rows of a
// table belong to the same struct.
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

// The allowed values of a number: from min to max, both included, in the unit of the field.
struct Range {
    double min = 0.0;
    double max = std::numeric_limits<double>::max();
};
// The allowed values of a whole number, or the allowed sizes of a list: from min to max, both included.
struct Count {
    std::uint64_t min = 0;
    std::uint64_t max = std::numeric_limits<std::uint64_t>::max();
};

// Functions that return a reference to a struct member of type T. `settings` is the address of the struct.
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
        name,  // usable in file names and CSV cells, see is_name()
        title  // one line of text
    };
    Access<std::string> at;
    Rule rule;
};
// A list of texts. The file may give a single text instead of a list with one entry.
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
// A function given by points. The file gives them as a map "x: y" with strictly rising x.
struct CurveField {
    Access<std::vector<double>> x;
    Access<std::vector<double>> y;
    const Unit* x_unit;
    Range x_range;
    const Unit* y_unit;
    Range y_range;
    Count size;
};
// A nested map. If `library` is not empty, it is a folder of the data directory. The scenario may then give the name of
// a file in this folder instead of the map. It may also give a map in which the field `base` names such a
// file, and in which all other fields overwrite fields of the file.
struct SectionField {
    void* (*write)(void* settings);
    const void* (*read)(const void* settings);
    const Table& (*table)();
    std::string library;
    bool is_optional = false;  // true: the section can be absent; `read` then returns null
};
// A list of maps. If `library` is not empty, it is a file "folder/name" of the data directory, and the list begins with
// the entries of this file. An entry of the scenario replaces the library entry of the same name.
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

// The old and the current name of one value of a choice.
struct OldValue {
    std::string old_name;
    std::string name;
};

struct Field {
    std::string name;
    std::string meaning;
    FieldKind kind;
    bool required = false;
    std::string fallback = {};  // default as YAML text; empty: the initialiser of the struct member
    // The field exists only if the choice `condition_field` has one of `condition_values`. The choice is a field of the
    // same table, or a field of a section that the table lists earlier, such as network.kind. If `condition_field` is
    // empty, the field always exists.
    std::string condition_field = {};
    std::vector<std::string> condition_values = {};
    // True for a parameter of a traffic rule that `condition_field` switches on and off. While the rule is off, it is
    // an error to give a value of the parameter. There are two exceptions: the value 'off', and any value in the file
    // if an override switches the rule off.
    bool is_rule_parameter = false;
    // Names of the previous release, accepted with a warning (old_names.h).
    std::vector<std::string> old_names = {};
    std::vector<OldValue> old_values = {};  // old names of choice values, accepted with a warning
};

struct Table {
    std::string title;
    std::vector<Field> fields;
    std::shared_ptr<void> (*make_default)() = nullptr;
    std::function<void(const void* settings, Checker&)> check;  // checks that compare several fields; may be empty
    SourceNode (*expand)(const SourceNode& scalar) = nullptr;   // makes a map from a list entry that is a single word

    // find() returns the field with this current name. find_old_name() returns the field that had this name in the
    // previous release. The result is null if there is no such field.
    const Field* find(std::string_view name) const;
    const Field* find_old_name(std::string_view name) const;
    std::vector<std::string> names() const;
};

// Returns true if the settings fulfil the condition of the field, see Field::condition_field.
bool applies(const Table& table, const Field& field, const void* settings);

// Returns true if the text follows TextField::Rule::name: 1 to 64 letters, digits and - _ . + signs, not only signs.
bool is_name(const std::string& text);

// Returns the allowed values as text, such as "0.1 s to 7200 s" or "one of: full, meso".
std::string allowed_text(const FieldKind& kind);
// Returns the unit of a field, such as "s" or "km/h"; "" for a field without unit.
std::string unit_text(const FieldKind& kind);
// Returns the unit of a field. For a field without unit, returns its type: "number", "whole number", "text", "choice",
// "list", "section".
std::string type_text(const FieldKind& kind);

}  // namespace stopline
