#include "scenario/sweep_file/load_sweep.h"

#include <map>
#include <memory>
#include <system_error>
#include <utility>

#include "base/input_error.h"
#include "base/nearest_name.h"
#include "scenario/files/file_kind.h"
#include "scenario/files/file_name.h"
#include "scenario/schema/field_path.h"
#include "scenario/schema/fields.h"
#include "scenario/schema/old_names.h"
#include "scenario/schema/read_fields.h"
#include "scenario/schema/report.h"
#include "scenario/sweep_file/axis_column.h"
#include "scenario/yaml/yaml_source.h"

namespace stopline {
namespace {

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(' ');
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
        end = text.find(at, begin);
        parts.push_back(trimmed(text.substr(begin, end - begin)));
    }
    return parts;
}

// Replaces old names in axis.values[value] if the value belongs to a choice field (a field with a list of allowed
// words). Warns of each old name.
void use_current_choices(SweepAxis& axis, std::size_t value, Report& report) {
    const std::vector<std::string> overrides = axis_overrides(axis, value);
    std::vector<std::string> parts;
    bool changed = false;
    for (std::size_t k = 0; k < axis.paths.size(); ++k) {
        SourceNode node;
        node.kind = SourceNode::Kind::scalar;
        node.place = report.place_of("axes[" + axis.name + "].values[" + std::to_string(value) + "]");
        node.text = overrides[k].substr(axis.paths[k].size() + 1);
        const std::string written = node.text;
        const Field* const field = find_field(scenario_table(), axis.paths[k]).field;
        if (field != nullptr && std::holds_alternative<ChoiceField>(field->kind)) {
            replace_old_names(*field, node, axis.paths[k], report);
        }
        changed = changed || node.text != written;
        parts.push_back(node.text);
    }
    if (changed) axis.values[value] = joined(parts, " | ");
}

// Replaces old field names in the paths of the axes, and old names of choice values. Axis values that are maps keep
// their text. The class Sweep (sweeps/sweep.h) warns of old names in such maps when it loads the combinations.
void use_current_names(SweepSettings& sweep, Report& report) {
    for (SweepAxis& axis : sweep.axes) {
        for (std::size_t k = 0; k < axis.paths.size(); ++k) {
            const std::string current = current_path(scenario_table(), axis.paths[k]);
            if (current == axis.paths[k]) continue;
            const Place place = report.place_of("axes[" + axis.name + "].path[" + std::to_string(k) + "]");
            report.warn(place, old_name_warning(axis.paths[k], current));
            axis.paths[k] = current;
        }
        for (std::size_t i = 0; i < axis.values.size(); ++i) use_current_choices(axis, i, report);
    }
}

// Checks one axis value by reading it into settings that are discarded. Skips sections, lists and list entries, because
// they need the whole scenario. The class Sweep (sweeps/sweep.h) checks them when it loads the combinations.
void check_value(const SweepAxis& axis, const std::string& path, const std::string& value, const Place& place,
                 Report& report) {
    const FieldAtPath at = find_field(scenario_table(), path);
    if (at.field == nullptr) return;
    if (std::holds_alternative<SectionField>(at.field->kind) || std::holds_alternative<ListField>(at.field->kind)) {
        return;
    }
    try {
        SourceNode node = parse_yaml(value, place.source);
        node.place = place;
        for (SourceNode& item : node.items) item.place = place;
        const std::shared_ptr<void> settings = at.table->make_default();
        read_value(*at.field, node, "axes[" + axis.name + "]: " + path, settings.get(), report);
    } catch (const YamlError& error) {
        report.error(place, "field 'axes[" + axis.name + "]': value '" + shortened(value) + "' is " + error.message());
    }
}

void check_values(const SweepSettings& sweep, Report& report) {
    for (const SweepAxis& axis : sweep.axes) {
        for (std::size_t i = 0; i < axis.values.size(); ++i) {
            const Place place = report.place_of("axes[" + axis.name + "].values[" + std::to_string(i) + "]");
            const std::vector<std::string> overrides = axis_overrides(axis, i);
            for (std::size_t k = 0; k < axis.paths.size(); ++k) {
                check_value(axis, axis.paths[k], overrides[k].substr(axis.paths[k].size() + 1), place, report);
            }
        }
    }
}

// Checks that no two values of an axis are equal quantities, such as 60 s and 1 min. Their rows in the result table
// would look the same.
void check_values_differ(const SweepSettings& sweep, Report& report) {
    for (const SweepAxis& axis : sweep.axes) {
        std::map<std::vector<std::string>, std::size_t> first_index;
        for (std::size_t i = 0; i < axis.values.size(); ++i) {
            const auto [first, is_new] = first_index.try_emplace(axis_parts(axis, i), i);
            if (is_new) continue;
            const std::string field = "axes[" + axis.name + "].values[" + std::to_string(i) + "]";
            report.error(report.place_of(field), "field '" + field + "': '" + shortened(axis.values[i]) +
                                                     "' is the same value as '" +
                                                     shortened(axis.values[first->second]) + "'");
        }
    }
}

// Checks that the scenario file exists. This check is separate from loading the scenario, because the message about a
// missing file must name a line of the sweep file.
void check_scenario_file(const SweepSettings& sweep, const std::filesystem::path& file, Report& report) {
    std::error_code error;
    const std::filesystem::file_type type = std::filesystem::status(file, error).type();
    const bool missing = type == std::filesystem::file_type::not_found;
    if (!missing && type != std::filesystem::file_type::directory) return;
    report.error(report.place_of("scenario"),
                 "field 'scenario': value '" + shortened(sweep.scenario) + "' leads to " + file.generic_string() +
                     (missing ? ": no such file" + nearest_file_hint(file) : ": is a directory, not a YAML file") +
                     " (relative paths start at the sweep file's folder)");
}

SweepSettings sweep_from(SourceNode root) {
    require_file_kind(root, "sweep");
    const Source source = *root.place.source;
    Report report;
    replace_old_names(sweep_table(), root, "", report);
    SweepSettings sweep;
    read_fields(sweep_table(), root, "", &sweep, report);
    report.throw_if_any();
    use_current_names(sweep, report);
    const std::filesystem::path file = (source.directory / sweep.scenario).lexically_normal();
    check_scenario_file(sweep, file, report);
    check_values(sweep, report);
    report.throw_if_any();
    check_values_differ(sweep, report);
    report.throw_if_any();
    for (SweepAxis& axis : sweep.axes) {
        const std::string field = "axes[" + axis.name + "]";
        axis.place = to_string(report.place_of(field + ".name"));
        for (std::size_t i = 0; i < axis.values.size(); ++i) {
            axis.value_places.push_back(to_string(report.place_of(field + ".values[" + std::to_string(i) + "]")));
        }
        for (std::size_t i = 0; i < axis.populations.size(); ++i) {
            axis.population_places.push_back(
                to_string(report.place_of(field + ".populations[" + std::to_string(i) + "]")));
        }
    }
    sweep.file = source.label;
    if (sweep.name.empty()) sweep.name = name_from_file(source.label, "sweep");
    sweep.scenario = file.string();
    sweep.warnings = report.warnings();
    return sweep;
}

}  // namespace

SweepSettings load_sweep(const std::filesystem::path& file) { return sweep_from(read_yaml_file(file)); }

SweepSettings parse_sweep(std::string_view text, const std::string& label, const std::filesystem::path& directory) {
    return sweep_from(parse_yaml(text, std::make_shared<Source>(Source{label, directory})));
}

std::vector<std::string> axis_overrides(const SweepAxis& axis, std::size_t value) {
    if (axis.paths.empty()) return {};
    const std::string& text = axis.values.at(value);
    std::vector<std::string> parts{text};
    if (axis.paths.size() > 1) parts = split(text, '|');
    if (parts.size() == 1) parts.assign(axis.paths.size(), parts.front());
    std::vector<std::string> overrides;
    for (std::size_t i = 0; i < parts.size() && i < axis.paths.size(); ++i) {
        overrides.push_back(axis.paths[i] + "=" + parts[i]);
    }
    // A value with more parts than paths gets an additional empty override. check_values() in fields/sweep.cpp then
    // counts more overrides than paths and reports the value.
    if (parts.size() > axis.paths.size()) overrides.emplace_back();
    return overrides;
}

}  // namespace stopline
