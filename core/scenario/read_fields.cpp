#include "scenario/read_fields.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "scenario/nearest_name.h"

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

bool is_name(const std::string& text) {
    const auto alphanumeric = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
    return text.size() <= 64 && std::any_of(text.begin(), text.end(), alphanumeric) &&
           std::all_of(text.begin(), text.end(),
                       [&](char c) { return alphanumeric(c) || c == '-' || c == '_' || c == '.' || c == '+'; });
}

bool is_title(const std::string& text) {
    return text.size() <= 200 && std::none_of(text.begin(), text.end(),
                                              [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
}

// Reads one field of `settings`; operator() is chosen by the field's kind.
class ValueReader {
public:
    ValueReader(const Field& field, const SourceNode& node, std::string path, void* settings, Report& report)
        : field_(field), node_(node), path_(std::move(path)), settings_(settings), report_(report) {}

    void operator()(const NumberField& f) {
        double value = 0.0;
        if (quantity(node_, path_, *f.shown, f.range, value)) f.at.write(settings_) = value;
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
        if (std::find(f.names.begin(), f.names.end(), node_.text) == f.names.end()) {
            return error(node_, path_,
                         "value '" + shortened(node_.text) + "' is unknown" + known_names(node_.text, f.names));
        }
        f.set(settings_, node_.text);
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
            if (!quantity(node_.items[i], item_path, *f.shown, f.range, value)) continue;
            if (f.rising && !values.empty() && value <= values.back()) {
                bad_value(node_.items[i], item_path, "does not rise: each value must exceed the one before");
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
            const bool good_x = quantity(key, path_, *f.x_shown, f.x_range, x);
            const bool good_y = quantity(node_.items[i], path_ + "." + shortened(key.text), *f.y_shown, f.y_range, y);
            if (!good_x || !good_y) continue;
            if (!xs.empty() && x <= xs.back()) {
                bad_value(key, path_, "does not rise: each point must lie beyond the one before");
            }
            xs.push_back(x);
            ys.push_back(y);
        }
    }

    void operator()(const SectionField& f) { read_fields(f.table(), node_, path_, f.write(settings_), report_); }

    void operator()(const ListField& f) {
        if (node_.kind != SourceNode::Kind::list) return wrong_kind("a list");
        if (!right_size(f.count)) return;
        for (std::size_t i = 0; i < node_.items.size(); ++i) {
            read_fields(f.table(), node_.items[i], entry_path(i), f.append(settings_), report_);
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

    // "policies[CDG]", or with the number where the entry has no name.
    std::string entry_path(std::size_t i) const {
        const SourceNode* const name = node_.items[i].find("name");
        const bool named = name != nullptr && name->kind == SourceNode::Kind::scalar && is_name(name->text);
        return path_ + "[" + (named ? name->text : std::to_string(i)) + "]";
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

    bool quantity(const SourceNode& node, const std::string& path, const Unit& shown, const Range& range,
                  double& value) {
        if (!scalar(node, path)) return false;
        const ParsedQuantity parsed = parse_quantity(node.text, shown);
        const bool too_large = parsed.si > to_si(range.max, shown);
        // A share may be a plain number, 0.3 for 30 %; who writes 30 means 30 %.
        const bool meant_percent = too_large && shown.text == "%" && node.text.find('%') == std::string::npos;
        if (parsed.problem == "has no unit" || (parsed.problem.empty() && meant_percent)) {
            bad_value(node, path,
                      "has no unit: write e.g. '" + shortened(node.text) + " " + std::string(shown.text) + "'");
        } else if (!parsed.problem.empty()) {
            bad_value(node, path, parsed.problem);
        } else if (too_large || parsed.si < to_si(range.min, shown)) {
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
                                    known_names(key.text, table.names()));
    }
}

// What belongs to a rule that is off, and says nothing else (Field::of_a_rule).
bool rests(const Field& field, const SourceNode& value, const SourceNode& map) {
    if (!field.of_a_rule) return false;
    const SourceNode* const rule = map.find(field.only_field);
    const auto in_file = [](const SourceNode& node) { return node.place.source->has_lines; };
    return value.text == "off" || (rule != nullptr && in_file(value) && !in_file(*rule));
}

void report_missing(const Field& field, const SourceNode& map, const std::string& path, Report& report) {
    const std::string unit = unit_text(field.kind);
    report.error(map.place, "field '" + path + "' is missing: " + field.meaning +
                                (unit.empty() ? "" : " [" + unit + "]") + " (allowed: " + allowed_text(field.kind) +
                                ")");
}

}  // namespace

void read_value(const Field& field, const SourceNode& node, const std::string& path, void* settings, Report& report) {
    std::visit(ValueReader(field, node, path, settings, report), field.kind);
}

void read_fields(const Table& table, const SourceNode& node, const std::string& path, void* settings, Report& report) {
    if (node.kind == SourceNode::Kind::broken) return;
    report.remember(path, node.place);
    if (node.kind != SourceNode::Kind::map) {
        const std::string where = path.empty() ? "the file" : "field '" + path + "'";
        report.error(node.place, where + " needs a map of fields, not " + kind_name(node) +
                                     " (fields: " + joined(table.names()) + ")");
        return;
    }
    const std::size_t errors_before = report.count();
    report_unknown_keys(table, node, path, report);
    std::set<std::string> bad_choices;  // nothing can be said of fields that depend on them
    for (const Field& field : table.fields) {
        if (bad_choices.contains(field.only_field)) continue;
        const std::string field_path = join_path(path, field.name);
        const SourceNode* const value = node.find(field.name);
        const bool exists = applies(table, field, settings);
        const std::size_t errors = report.count();
        if (value != nullptr) report.remember(field_path, value->place);
        if (value != nullptr && !exists && !rests(field, *value, node)) {
            report.error(value->place, "field '" + field_path + "' is used only where " + field.only_field + " is " +
                                           joined(field.only_values, " or "));
        } else if (value != nullptr) {
            read_value(field, *value, field_path, settings, report);
        } else if (exists && field.required) {
            report_missing(field, node, field_path, report);
        }
        if (std::holds_alternative<ChoiceField>(field.kind) && report.count() > errors) bad_choices.insert(field.name);
    }
    if (table.check && report.count() == errors_before) {
        Checker checker(report, path);
        table.check(settings, checker);
    }
}

}  // namespace stopline
