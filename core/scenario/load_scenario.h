// Loads YAML files into settings structs, with all defaults filled in, checked, and in SI units. Throws InputError for
// any bad input.
//
// One table of fields (schema/field_table.h, rows in schema/fields/*.cpp) drives parsing, error messages, the list of
// fields, the JSON schema and canonical_text(). A new parameter needs a struct member and one row that names it.
//
// The text of an InputError has one line per error, at most 20 lines:
//     file:line:column: field 'signal.green': value '15' has no unit: write e.g. '15 s' (allowed: 0.1 s to 7200 s)
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

// Loads a scenario and applies the overrides in their order. An override has the form `path=value`, with the value
// written as in a scenario file. Examples:
//     signal.green=20 s    vehicle=diesel_eu4_103kw    vehicle.mass=1.4 t    measure.green=[5 s, 10 s]
//     populations[0].components[1].share=25 %    policies[CTG-Ref].time_gap=0.6 s
// Scenario::warnings lists the outdated field names (those of the previous release) that the files or the overrides
// use, and the overrides that later ones replace.
Scenario load_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

// Loads a scenario from text. `label` stands for the file in messages. Relative paths in the text start at `directory`.
Scenario parse_scenario(std::string_view text, const std::string& label, const std::vector<std::string>& overrides = {},
                        const std::filesystem::path& directory = ".");

// These functions load one data file. A text with a '/' or with the ending .yaml is a path, relative to `directory`.
// Any other text is the name of a file in the data directory, such as vehicles/NAME.yaml. For each outdated field name
// (of the previous release) in the file, `warnings` gets one line.
PowertrainSettings load_vehicle(const std::string& name_or_path, const std::filesystem::path& directory = ".",
                                std::vector<std::string>* warnings = nullptr);
DriverSettings load_driver(const std::string& name_or_path, const std::filesystem::path& directory = ".",
                           std::vector<std::string>* warnings = nullptr);
std::vector<GapPolicySettings> load_policies(const std::string& name_or_path = "paper",
                                             const std::filesystem::path& directory = ".",
                                             std::vector<std::string>* warnings = nullptr);
MesoSettings load_meso(const std::string& name_or_path, const std::filesystem::path& directory = ".",
                       std::vector<std::string>* warnings = nullptr);

// Returns the sorted names of the files in a folder of the data directory, such as "vehicles", without extension.
std::vector<std::string> data_names(const std::string& folder);

// Name of the file in data/meso with the parameters that stopline-calibrate fitted to full dynamics. The fit is
// assessed as in Section V of the paper. The networks of Sections VI and VII use these parameters.
inline constexpr const char* kCalibratedMeso = "passages";

// These functions return the text of a data file with the settings. `comment`, which may have several lines, becomes a
// YAML comment at the top. Loading the text gives the same numbers, bit for bit.
std::string driver_yaml(const DriverSettings& driver, const std::string& comment);
std::string meso_yaml(const MesoSettings& meso, const std::string& comment);

// Returns the scenario as YAML text with every field in full precision, including those of the vehicle, the driver and
// the policies. Loading the text gives the same scenario.
std::string canonical_text(const Scenario& scenario);
// Returns the 64-bit FNV-1a hash of canonical_text(), combined with the hashes of imported SUMO files and of the
// traffic file.
std::uint64_t scenario_hash(const Scenario& scenario);

// Returns a list of the fields of a scenario file for a terminal: name, unit, default, range and meaning. Lists the
// fields whose path contains `text`, such as green, signal.green or phases[].green; all of them for an empty text. Text
// inside brackets is ignored: policies[CTG-Ref] finds the same fields as policies[]. Throws InputError if there is no
// such field.
std::string describe_fields(const std::string& text = {});

// Returns the text of scenarios/FIELDS.md, which lists all fields of scenario and sweep files.
std::string fields_markdown();

// Returns the JSON schema (draft 07) of a scenario file, for editors.
std::string json_schema();

}  // namespace stopline
