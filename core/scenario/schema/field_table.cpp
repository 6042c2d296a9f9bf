#include "scenario/schema/field_table.h"

#include <algorithm>
#include <cctype>

#include "base/nearest_name.h"

namespace stopline {
namespace {

std::string range_text(const Range& range, const Unit& unit) {
    const auto end = [&](double value) { return short_text(to_si(value, unit), unit); };
    if (range.max == std::numeric_limits<double>::max()) return "at least " + end(range.min);
    return end(range.min) + " to " + end(range.max);
}

std::string count_text(const Count& count, const std::string& noun) {
    const std::string plural = noun + (noun.empty() || count.max == 1 ? "" : "s");
    if (count.min == count.max) return std::to_string(count.min) + plural;
    if (count.max == std::numeric_limits<std::uint64_t>::max()) return "at least " + std::to_string(count.min) + plural;
    return std::to_string(count.min) + " to " + std::to_string(count.max) + plural;
}

std::string rule_text(TextField::Rule rule) {
    return rule == TextField::Rule::name ? "up to 64 letters, digits and - _ . + signs"
                                         : "one line of up to 200 characters";
}

struct AllowedText {
    std::string operator()(const NumberField& f) const { return range_text(f.range, *f.unit); }
    std::string operator()(const WholeField& f) const { return count_text(f.range, ""); }
    std::string operator()(const TextField& f) const { return rule_text(f.rule); }
    std::string operator()(const TextsField& f) const {
        return count_text(f.size, " text") + ", each " + rule_text(f.rule);
    }
    std::string operator()(const ChoiceField& f) const { return "one of: " + joined(f.names); }
    std::string operator()(const NumbersField& f) const {
        return count_text(f.size, " value") + (f.rising ? ", rising, " : ", ") + range_text(f.range, *f.unit);
    }
    std::string operator()(const CurveField& f) const {
        return count_text(f.size, " point") + ", " + range_text(f.x_range, *f.x_unit) +
               " (rising): " + range_text(f.y_range, *f.y_unit);
    }
    std::string operator()(const SectionField& f) const {
        return f.library.empty() ? "a map of fields" : "a name of data/" + f.library + " or a map with its base";
    }
    std::string operator()(const ListField& f) const { return "a list with " + count_text(f.count, "") + " entries"; }
};

struct UnitText {
    std::string operator()(const NumberField& f) const { return std::string(f.unit->text); }
    std::string operator()(const NumbersField& f) const { return std::string(f.unit->text); }
    std::string operator()(const CurveField& f) const {
        return std::string(f.x_unit->text) + ": " + std::string(f.y_unit->text);
    }
    template <class Other>
    std::string operator()(const Other& /*other*/) const {
        return {};
    }
};

struct TypeName {
    std::string operator()(const NumberField& /*f*/) const { return "number"; }
    std::string operator()(const WholeField& /*f*/) const { return "whole number"; }
    std::string operator()(const TextField& /*f*/) const { return "text"; }
    std::string operator()(const ChoiceField& /*f*/) const { return "choice"; }
    std::string operator()(const SectionField& /*f*/) const { return "section"; }
    template <class List>
    std::string operator()(const List& /*list*/) const {
        return "list";
    }
};

// Returns the value of the choice at `path`, which is section names and a field name joined by dots.
std::string choice_at(const Table& table, const std::string& path, const void* settings) {
    const auto dot = path.find('.');
    const FieldKind& kind = table.find(path.substr(0, dot))->kind;
    if (dot == std::string::npos) return std::get<ChoiceField>(kind).get(settings);
    const auto& section = std::get<SectionField>(kind);
    return choice_at(section.table(), path.substr(dot + 1), section.read(settings));
}

}  // namespace

const Field* Table::find(std::string_view name) const {
    const auto found = std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name; });
    return found == fields.end() ? nullptr : &*found;
}

const Field* Table::find_old_name(std::string_view name) const {
    const auto had_name = [&](const Field& f) {
        return std::find(f.old_names.begin(), f.old_names.end(), name) != f.old_names.end();
    };
    const auto found = std::find_if(fields.begin(), fields.end(), had_name);
    return found == fields.end() ? nullptr : &*found;
}

std::vector<std::string> Table::names() const {
    std::vector<std::string> names;
    for (const Field& field : fields) names.push_back(field.name);
    return names;
}

bool applies(const Table& table, const Field& field, const void* settings) {
    if (field.condition_field.empty()) return true;
    const std::string value = choice_at(table, field.condition_field, settings);
    return std::find(field.condition_values.begin(), field.condition_values.end(), value) !=
           field.condition_values.end();
}

bool is_name(const std::string& text) {
    const auto alphanumeric = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
    return text.size() <= 64 && std::any_of(text.begin(), text.end(), alphanumeric) &&
           std::all_of(text.begin(), text.end(),
                       [&](char c) { return alphanumeric(c) || c == '-' || c == '_' || c == '.' || c == '+'; });
}

std::string allowed_text(const FieldKind& kind) { return std::visit(AllowedText{}, kind); }
std::string unit_text(const FieldKind& kind) { return std::visit(UnitText{}, kind); }

std::string type_text(const FieldKind& kind) {
    const std::string unit = unit_text(kind);
    return unit.empty() ? std::visit(TypeName{}, kind) : unit;
}

}  // namespace stopline
