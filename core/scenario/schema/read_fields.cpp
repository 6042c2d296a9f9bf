#include "scenario/schema/read_fields.h"

#include <algorithm>
#include <set>

#include "base/nearest_name.h"
#include "scenario/schema/field_path.h"

namespace stopline {
namespace {

std::string kind_name(const SourceNode& node) {
    switch (node.kind) {
        case SourceNode::Kind::list:
            return "a list";
        case SourceNode::Kind::map:
            return "a map";
        case SourceNode::Kind::scalar:
            return "'" + shortened(node.text) + "'";
        default:
            return "nothing";
    }
}

bool is_title(const std::string& text) {
    return text.size() <= 200 && std::none_of(text.begin(), text.end(),
                                              [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
}

// Returns the parts of a name that is joined with '+' signs, in alphabetical order.
std::vector<std::string> sorted_parts(const std::string& name) {
    std::vector<std::string> parts(1);
    for (const char c : name) {
        if (c == '+') {
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    std::sort(parts.begin(), parts.end());
    return parts;
}

// Returns the name of the choice that `text` means: the name itself, or the name with the same parts in another order,
// such as straight+left for left+straight. Returns "" if there is no such name.
std::string chosen_name(const std::vector<std::string>& names, const std::string& text) {
    if (std::find(names.begin(), names.end(), text) != names.end()) return text;
    if (text.find('+') == std::string::npos) return {};
    const std::vector<std::string> parts = sorted_parts(text);
    const auto found =
        std::find_if(names.begin(), names.end(), [&](const std::string& name) { return sorted_parts(name) == parts; });
    return found == names.end() ? std::string() : *found;
}

// Reads the value of one field into `settings`. There is one operator() for each kind of field.
class ValueReader {
public:
    ValueReader(const Field& field, const SourceNode& node, std::string path, void* settings, Report& report)
        : field_(field), node_(node), path_(std::move(path)), settings_(settings), report_(report) {}

    void operator()(const NumberField& f) {
        double value = 0.0;
        if (quantity(node_, path_, *f.unit, f.range, value)) f.at.write(settings_) = value;
    }

    void operator()(const WholeField& f) {
        if (!scalar(node_, path_)) return;
        const ParsedWhole parsed = parse_whole(node_.text);
        if (!parsed.problem.empty()) return bad_value(node_, path_, parsed.problem);
        if (parsed.value < f.range.min || parsed.value > f.range.max) return bad_value(node_, path_, "is out of range");
        f.set(settings_, parsed.value);
    }

    void operator()(const TextField& f) {
        if (is_text(node_, path_, f.rule)) f.at.write(settings_) = node_.text;
    }

    void operator()(const TextsField& f) {
        if (node_.kind == SourceNode::Kind::scalar) {
            if (is_text(node_, path_, f.rule)) f.at.write(settings_) = {node_.text};
            return;
        }
        if (node_.kind != SourceNode::Kind::list) return wrong_kind("a list");
        if (!right_size(f.size)) return;
        std::vector<std::string>& values = f.at.write(settings_);
        values.clear();
        for (std::size_t i = 0; i < node_.items.size(); ++i) {
            const std::string item_path = path_ + "[" + std::to_string(i) + "]";
            report_.remember(item_path, node_.items[i].place);
            if (is_text(node_.items[i], item_path, f.rule)) values.push_back(node_.items[i].text);
        }
    }

    void operator()(const ChoiceField& f) {
        if (!scalar(node_, path_)) return;
        const std::string name = chosen_name(f.names, node_.text);
        if (name.empty()) {
            return error(node_, path_,
                         "value '" + shortened(node_.text) + "' is unknown" + known_names_hint(node_.text, f.names));
        }
        f.set(settings_, name);
    }

    void operator()(const NumbersField& f) {
        if (node_.kind != SourceNode::Kind::list) return wrong_kind("a list");
        if (!right_size(f.size)) return;
        std::vector<double>& values = f.at.write(settings_);
        values.clear();
        for (std::size_t i = 0; i < node_.items.size(); ++i) {
            const std::string item_path = path_ + "[" + std::to_string(i) + "]";
            report_.remember(item_path, node_.items[i].place);
            double value = 0.0;
            if (!quantity(node_.items[i], item_path, *f.unit, f.range, value)) continue;
            if (f.rising && !values.empty() && value <= values.back()) {
                bad_value(node_.items[i], item_path, "does not rise: each value must exceed the previous one");
            }
            values.push_back(value);
        }
    }

    void operator()(const CurveField& f) {
        if (node_.kind != SourceNode::Kind::map) return wrong_kind("a map of points, x: y");
        if (!right_size(f.size)) return;
        std::vector<double>& xs = f.x.write(settings_);
        std::vector<double>& ys = f.y.write(settings_);
        xs.clear();
        ys.clear();
        for (std::size_t i = 0; i < node_.items.size(); ++i) {
            SourceNode key;
            key.kind = SourceNode::Kind::scalar;
            key.text = node_.keys[i].text;
            key.place = node_.keys[i].place;
            double x = 0.0;
            double y = 0.0;
            const bool good_x = quantity(key, path_, *f.x_unit, f.x_range, x);
            const bool good_y = quantity(node_.items[i], path_ + "." + shortened(key.text), *f.y_unit, f.y_range, y);
            if (!good_x || !good_y) continue;
            if (!xs.empty() && x <= xs.back()) {
                bad_value(key, path_, "does not rise: each x must exceed the previous one");
            }
            xs.push_back(x);
            ys.push_back(y);
        }
    }

    void operator()(const SectionField& f) {
        read_fields(f.table(), node_, path_, f.write(settings_), report_, f.library);
    }

    void operator()(const ListField& f) {
        if (node_.kind != SourceNode::Kind::list) return wrong_kind("a list");
        if (!right_size(f.count)) return;
        for (std::size_t i = 0; i < node_.items.size(); ++i) {
            const std::string path = entry_path(path_, node_.items[i], i);
            read_fields(f.table(), node_.items[i], path, f.append(settings_), report_);
        }
    }

private:
    bool is_text(const SourceNode& node, const std::string& path, TextField::Rule rule) {
        if (!scalar(node, path)) return false;
        const bool name = rule == TextField::Rule::name;
        if (name ? is_name(node.text) : is_title(node.text)) return true;
        bad_value(node, path, std::string("cannot be used as a ") + (name ? "name" : "title"));
        return false;
    }

    void error(const SourceNode& node, const std::string& path, const std::string& message) {
        report_.error(node.place, "field '" + path + "': " + message);
    }

    void bad_value(const SourceNode& node, const std::string& path, const std::string& problem) {
        error(node, path,
              "value '" + shortened(node.text) + "' " + problem + " (allowed: " + allowed_text(field_.kind) + ")");
    }

    void wrong_kind(const std::string& wanted) {
        if (node_.kind == SourceNode::Kind::broken) return;
        error(node_, path_,
              "needs " + wanted + ", not " + kind_name(node_) + " (allowed: " + allowed_text(field_.kind) + ")");
    }

    bool right_size(const Count& size) {
        if (node_.items.size() >= size.min && node_.items.size() <= size.max) return true;
        error(node_, path_,
              "has " + std::to_string(node_.items.size()) + " entries (allowed: " + allowed_text(field_.kind) + ")");
        return false;
    }

    bool scalar(const SourceNode& node, const std::string& path) {
        if (node.kind == SourceNode::Kind::scalar) return true;
        if (node.kind != SourceNode::Kind::broken) {
            error(node, path,
                  "needs a single value, not " + kind_name(node) + " (allowed: " + allowed_text(field_.kind) + ")");
        }
        return false;
    }

    bool quantity(const SourceNode& node, const std::string& path, const Unit& unit, const Range& range,
                  double& value) {
        if (!scalar(node, path)) return false;
        const ParsedQuantity parsed = parse_quantity(node.text, unit);
        if (!parsed.problem.empty()) {
            bad_value(node, path, parsed.problem);
        } else if (parsed.si > to_si(range.max, unit) || parsed.si < to_si(range.min, unit)) {
            bad_value(node, path, "is out of range");
        } else {
            value = parsed.si;
            return true;
        }
        return false;
    }

    const Field& field_;
    const SourceNode& node_;
    std::string path_;
    void* settings_;
    Report& report_;
};

void report_unknown_keys(const Table& table, const SourceNode& map, const std::string& path, Report& report) {
    for (const SourceNode::Key& key : map.keys) {
        if (table.find(key.text) != nullptr) continue;
        report.error(key.place, "field '" + join_path(path, shortened(key.text)) + "' is unknown" +
                                    unknown_field_hint(table, table, path, key.text));
    }
}

// Returns true if the file may give this parameter although its rule is off, see Field::is_rule_parameter.
bool may_stay(const Field& field, const SourceNode& value, const SourceNode& map) {
    if (!field.is_rule_parameter) return false;
    const SourceNode* const rule = map.find(field.condition_field);
    const auto in_file = [](const SourceNode& node) { return node.place.source->has_lines; };
    return value.text == "off" || (rule != nullptr && in_file(value) && !in_file(*rule));
}

// Returns the position of a value in `map`, for a message about its field. A section that the file does not have, but
// that an override sets in part, has the position of `map`; the result is then the override.
Place place_given(const SourceNode& value, const SourceNode& map) {
    if (value.place.line != map.place.line || value.place.column != map.place.column) return value.place;
    const auto is_override = [](const SourceNode& node) { return !node.place.source->has_lines; };
    const auto found = std::find_if(value.items.begin(), value.items.end(), is_override);
    return found == value.items.end() ? value.place : found->place;
}

void report_missing(const Field& field, const SourceNode& map, const std::string& path, Report& report) {
    const std::string unit = unit_text(field.kind);
    report.error(map.place, "field '" + path + "' is missing: " + field.meaning +
                                (unit.empty() ? "" : " [" + unit + "]") + " (allowed: " + allowed_text(field.kind) +
                                ")");
}

// Reports the required fields that a map lacks. For a map that could start from a data file, several missing fields are
// one error, because the file was probably forgotten. `library`: folder of these data files; "": none.
void report_missing(const std::vector<const Field*>& fields, const SourceNode& map, const std::string& path,
                    const std::string& library, Report& report) {
    if (library.empty() || fields.size() < 2) {
        for (const Field* const field : fields) report_missing(*field, map, join_path(path, field->name), report);
        return;
    }
    std::vector<std::string> names;
    for (const Field* const field : fields) names.push_back(field->name);
    report.error(map.place, "field '" + path + "': " + std::to_string(names.size()) +
                                " fields are missing: add 'base: NAME' to take them from a file of data/" + library +
                                ", or give all of them (" + joined(names) + ")");
}

}  // namespace

void read_value(const Field& field, const SourceNode& node, const std::string& path, void* settings, Report& report) {
    std::visit(ValueReader(field, node, path, settings, report), field.kind);
}

void read_fields(const Table& table, const SourceNode& node, const std::string& path, void* settings, Report& report,
                 const std::string& library) {
    if (node.kind == SourceNode::Kind::broken) return;
    report.remember(path, node.place);
    if (node.kind != SourceNode::Kind::map) {
        const std::string where = path.empty() ? "the file" : "field '" + path + "'";
        report.error(node.place, where + " needs a map of fields, not " + kind_name(node) +
                                     " (fields: " + joined(table.names()) + ")");
        return;
    }
    const std::size_t errors_before_map = report.error_count();
    report_unknown_keys(table, node, path, report);
    std::set<std::string> unreadable_choices;  // choices with errors; fields that depend on such a choice are skipped
    std::vector<const Field*> missing;
    for (const Field& field : table.fields) {
        if (unreadable_choices.contains(field.condition_field)) continue;
        const std::string field_path = join_path(path, field.name);
        const SourceNode* const value = node.find(field.name);
        const bool exists = applies(table, field, settings);
        const std::size_t errors_before_field = report.error_count();
        if (value != nullptr) report.remember(field_path, value->place);
        if (value != nullptr && !exists && !may_stay(field, *value, node)) {
            report.error(place_given(*value, node), "field '" + field_path + "' applies only if " +
                                                        field.condition_field + " is " +
                                                        joined(field.condition_values, " or "));
        } else if (value != nullptr) {
            read_value(field, *value, field_path, settings, report);
        } else if (exists && field.required) {
            missing.push_back(&field);
        }
        if (std::holds_alternative<ChoiceField>(field.kind) && report.error_count() > errors_before_field) {
            unreadable_choices.insert(field.name);
        }
    }
    report_missing(missing, node, path, library, report);
    if (table.check && report.error_count() == errors_before_map) {
        Checker checker(report, path);
        table.check(settings, checker);
    }
}

}  // namespace stopline
