// From YAML files to settings in SI units, checked and complete; whatever cannot be used is refused with an InputError.
//
// One table of fields (field_table.h, rows in fields_*.cpp) drives parsing, error messages, the list of fields, the JSON
// schema and the canonical text. A new parameter is one row bound to a struct member.
//
// The text of an InputError has one line an error, up to twenty:
//     file:line:column: field 'signal.green': value '15' has no unit: write e.g. '15 s' (allowed: 0.1 s to 7200 s)
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

// Loads a scenario. An override is `path=value` with the value as it stands in a file, applied from left to right:
//     signal.green=20 s    vehicle=diesel_eu4_103kw    vehicle.mass=1.4 t    measure.green=[5 s, 10 s]
//     populations[0].components[1].share=25 %    policies[CTG-Ref].time_gap=0.6 s
Scenario load_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

// The same from text; `label` stands for the file in messages, `directory` is where relative paths in it start.
Scenario parse_scenario(std::string_view text, const std::string& label, const std::vector<std::string>& overrides = {},
                        const std::filesystem::path& directory = ".");

// Data files. A plain name is looked up in the data directory (vehicles/NAME.yaml, ...); a text with a '/' or ending in
// .yaml is a path, relative to `directory`.
PowertrainSettings load_vehicle(const std::string& name_or_path, const std::filesystem::path& directory = ".");
DriverSettings load_driver(const std::string& name_or_path, const std::filesystem::path& directory = ".");
std::vector<GapPolicySettings> load_policies(const std::string& name_or_path = "paper",
                                             const std::filesystem::path& directory = ".");

// Environment variable STOPLINE_DATA if set, else the data folder of the source tree this library was built from.
std::filesystem::path data_directory();

// The names that can be used: file stems in a folder of the data directory ("vehicles", "drivers", "policies"), sorted.
std::vector<std::string> data_names(const std::string& folder);

// A driver file with `comment` (may have several lines) on top. load_driver reads the same numbers back, bit for bit.
std::string driver_yaml(const DriverSettings& driver, const std::string& comment);

// In data/meso: what stopline-calibrate found for our full dynamics; judged in Section V, used in Sections VI and VII.
inline constexpr const char* kCalibratedMeso = "passages";

// The same for a file of parameters of the mesoscale mode.
MesoSettings load_meso(const std::string& name_or_path, const std::filesystem::path& directory = ".");
std::string meso_yaml(const MesoSettings& meso, const std::string& comment);

// Every field with full precision, vehicle, driver and policies included. It is itself a scenario file: loading it gives
// the same scenario. `Scenario::hash` is its 64-bit FNV-1a hash.
std::string canonical_text(const Scenario& scenario);
std::uint64_t scenario_hash(const Scenario& scenario);

// All fields as a table for people: path, unit, range, default, meaning.
std::string describe_fields();

// JSON schema (draft 07) of a scenario file, for editors.
std::string json_schema();

}  // namespace stopline
