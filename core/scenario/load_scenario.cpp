#include "scenario/load_scenario.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "base/input_error.h"
#include "base/io/data_directory.h"
#include "base/nearest_name.h"
#include "base/text_hash.h"
#include "scenario/compose.h"
#include "scenario/demand/plan_arrivals.h"
#include "scenario/demand/traffic_file.h"
#include "scenario/driving_checks.h"
#include "scenario/files/file_kind.h"
#include "scenario/files/file_name.h"
#include "scenario/import_sumo.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/network_checks.h"
#include "scenario/schema/field_path.h"
#include "scenario/schema/fields.h"
#include "scenario/schema/old_names.h"
#include "scenario/schema/read_fields.h"
#include "scenario/schema/report.h"
#include "scenario/schema/write_fields.h"
#include "scenario/yaml/yaml_source.h"

namespace stopline {
namespace {

void require_map(const SourceNode& root) {
    if (root.kind == SourceNode::Kind::map) return;
    const std::string problem = root.kind == SourceNode::Kind::empty ? "is empty; it" : "has no fields; it";
    throw InputError(to_string(root.place) + ": the file " + problem +
                     " needs 'field: value' lines (fields: " + joined(scenario_table().names()) + ")");
}

// Returns true if setting the field at `path` replaces the whole field at `earlier`: it is the same field, or a part of
// it.
bool replaces(const std::string& path, const std::string& earlier) {
    if (path.empty() || !earlier.starts_with(path)) return false;
    return earlier.size() == path.size() || earlier[path.size()] == '.' || earlier[path.size()] == '[';
}

Place place_of_override(const std::string& text, const std::filesystem::path& directory) {
    return {std::make_shared<Source>(Source{"--set '" + shortened(text) + "'", directory, false})};
}

// Applies the overrides in their order. Warns if a later override replaces an earlier one, which then has no effect.
// Reports an error if one override uses the old and another one the new name of the same field.
void apply_overrides(SourceNode& root, const std::vector<std::string>& overrides,
                     const std::filesystem::path& directory, Report& report) {
    const SourceNode file = root;
    std::map<std::string, std::string> written_paths;  // current path -> path in the first override of the field
    std::vector<std::pair<std::string, std::string>> applied;  // path and text of each override so far
    for (const std::string& text : overrides) {
        const std::string path = apply_override(scenario_table(), root, file, text, directory, report);
        const std::string written = text.substr(0, text.find('='));
        const std::string current = current_path(scenario_table(), written);
        const std::string& first = written_paths.try_emplace(current, written).first->second;
        if (first != written) {
            report.error(place_of_override(text, directory),
                         both_names_error(first == current ? written : first, current));
        }
        std::erase_if(applied, [&](const auto& one) {
            const auto& [earlier_path, earlier] = one;
            if (first != written || earlier == text || !replaces(path, earlier_path)) return false;
            report.warn(place_of_override(earlier, directory),
                        "has no effect, because the later --set '" + shortened(text) + "' replaces it");
            return true;
        });
        applied.emplace_back(path, text);
    }
}

// Returns true if a run can end after its measured signal cycles (NetworkKind::ends_after_cycles).
bool ends_after_cycles(const SourceNode& root) {
    const SourceNode* const network = root.find("network");
    const SourceNode* const kind = network == nullptr ? nullptr : network->find("kind");
    if (kind == nullptr) return false;
    const std::vector<std::string> kinds = kinds_with([](const NetworkKind& one) { return one.ends_after_cycles; });
    return std::find(kinds.begin(), kinds.end(), kind->text) != kinds.end();
}

// Adds a field with a value as if the file had it.
void add_scalar(SourceNode& map, const std::string& name, const std::string& text) {
    SourceNode value;
    value.kind = SourceNode::Kind::scalar;
    value.text = text;
    value.place = map.place;
    map.add({name, map.place}, std::move(value));
}

// Returns an error if demand.platoon_headway is too long for the arrival rate or the counts.
std::vector<FieldProblem> platoon_problems(const Scenario& scenario) {
    if (scenario.demand.arrivals != "platooned" || !plans_arrivals(scenario)) return {};
    const NetworkKind& kind = network_kind(scenario.network);
    Model model;
    model.graph = kind.graph(scenario.network);
    try {
        kind.add_demand(scenario, model);
    } catch (const PlatoonsDoNotFit& error) {
        return {{"demand.platoon_headway", error.what()}};
    } catch (const InputError& error) {
        return {{"demand", error.what()}};
    }
    return {};
}

Scenario scenario_from(SourceNode root, const std::vector<std::string>& overrides) {
    require_data_directory();
    require_map(root);
    require_file_kind(root, "scenario");
    const Source source = *root.place.source;
    Report report;
    replace_old_names(scenario_table(), root, "", report);
    apply_overrides(root, overrides, source.directory, report);
    complete(scenario_table(), root, "", report);
    if (root.find("name") == nullptr) add_scalar(root, "name", name_from_file(source.label, "scenario"));
    // The run of a single intersection ends after its measured cycles, unless the file gives its duration.
    if (ends_after_cycles(root) && root.find("duration") == nullptr) add_scalar(root, "duration", "0 s");
    Scenario scenario;
    read_fields(scenario_table(), root, "", &scenario, report);
    report.throw_if_any();
    if (scenario.measure.baseline == kNoBaseline) scenario.measure.baseline.clear();
    const NetworkKind& kind = network_kind(scenario.network);
    if (kind.ends_after_cycles && scenario.duration_s != 0.0) {
        scenario.measure.cycles = cycles_within_duration(scenario);
    }
    scenario.vehicle_name = scenario.vehicle.name;
    scenario.driver_name = scenario.driver.name;
    const auto report_all = [&](const std::vector<FieldProblem>& problems) {
        for (const auto& [field, problem] : problems) {
            report.error(report.place_of(field), "field '" + field + "': " + problem);
        }
        report.throw_if_any();
    };
    if (kind.import_files != nullptr) report_all(kind.import_files(scenario, source.directory));
    report_all(read_traffic_file(scenario, source.directory));
    report_all(platoon_problems(scenario));
    scenario.hash = scenario_hash(scenario);
    scenario.warnings = report.warnings();
    for (std::string& line : range_warnings(scenario)) scenario.warnings.push_back(std::move(line));
    return scenario;
}

// Loads the data file with this name or path into settings of type S.
template <class S>
S load_data(const Table& table, const std::string& folder, const std::string& name_or_path,
            const std::filesystem::path& directory, std::vector<std::string>* warnings) {
    require_data_directory();
    SourceNode node;
    node.kind = SourceNode::Kind::scalar;
    node.text = name_or_path;
    node.place.source = std::make_shared<Source>(Source{shortened(name_or_path), directory, false});
    Report report;
    resolve_base(table, folder, node, folder, report);
    complete(table, node, "", report);
    S settings;
    read_fields(table, node, "", &settings, report);
    report.throw_if_any();
    if (warnings != nullptr) {
        for (std::string& line : report.warnings()) warnings->push_back(std::move(line));
    }
    return settings;
}

// Returns the text with "# " before each line.
std::string as_comment(const std::string& text) {
    std::string lines;
    std::size_t begin = 0;
    while (begin < text.size()) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines += "# " + text.substr(begin, end - begin) + "\n";
        begin = end + 1;
    }
    return lines;
}

}  // namespace

Scenario load_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    return scenario_from(read_yaml_file(file), overrides);
}

Scenario parse_scenario(std::string_view text, const std::string& label, const std::vector<std::string>& overrides,
                        const std::filesystem::path& directory) {
    return scenario_from(parse_yaml(text, std::make_shared<Source>(Source{label, directory})), overrides);
}

PowertrainSettings load_vehicle(const std::string& name_or_path, const std::filesystem::path& directory,
                                std::vector<std::string>* warnings) {
    return load_data<PowertrainSettings>(vehicle_table(), "vehicles", name_or_path, directory, warnings);
}

DriverSettings load_driver(const std::string& name_or_path, const std::filesystem::path& directory,
                           std::vector<std::string>* warnings) {
    return load_data<DriverSettings>(driver_table(), "drivers", name_or_path, directory, warnings);
}

std::vector<GapPolicySettings> load_policies(const std::string& name_or_path, const std::filesystem::path& directory,
                                             std::vector<std::string>* warnings) {
    return load_data<PolicyFile>(policy_file_table(), "policies", name_or_path, directory, warnings).policies;
}

MesoSettings load_meso(const std::string& name_or_path, const std::filesystem::path& directory,
                       std::vector<std::string>* warnings) {
    return load_data<MesoSettings>(meso_table(), "meso", name_or_path, directory, warnings);
}

std::string driver_yaml(const DriverSettings& driver, const std::string& comment) {
    return as_comment(comment) + write_fields(driver_table(), &driver);
}

std::string meso_yaml(const MesoSettings& meso, const std::string& comment) {
    return as_comment(comment) + write_fields(meso_table(), &meso);
}

std::string canonical_text(const Scenario& scenario) { return write_fields(scenario_table(), &scenario); }

std::uint64_t scenario_hash(const Scenario& scenario) {
    std::uint64_t hash = hash_of(canonical_text(scenario));
    if (const std::uint64_t file = traffic_file_hash(scenario); file != 0) hash = extended_hash(hash, file);
    if (const std::uint64_t files = sumo_files_hash(scenario); files != 0) hash = extended_hash(hash, files);
    return hash;
}

}  // namespace stopline
