// The tables of fields, one per settings struct. A new field is one row in fields_*.cpp, bound to a struct member.
#pragma once

#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "scenario/schema/field_table.h"

namespace stopline {

const Table& scenario_table();    // Scenario: the root of a scenario file
const Table& network_table();     // NetworkSettings
const Table& streets_table();     // StreetSettings: the root of data/berlin/*.yaml
const Table& signal_table();      // SignalSettings
const Table& demand_table();      // DemandSettings
const Table& vehicle_table();     // PowertrainSettings: the root of data/vehicles/*.yaml
const Table& driver_table();      // DriverSettings: the root of data/drivers/*.yaml
const Table& rules_table();       // TrafficRules
const Table& meso_table();        // MesoSettings: the root of data/meso/*.yaml
const Table& gap_policy_table();  // GapPolicySettings
const Table& population_table();  // PopulationSettings
const Table& measure_table();     // MeasureSettings

// Returns the names of all combinations of movements that an approach lane may allow.
const std::vector<std::string>& lane_movements();

const Table& sweep_table();  // SweepSettings (sweep_settings.h): the root of a sweep file

const Table& accepted_table();  // AcceptedFile (load_accepted.h): the root of a file of accepted differences

// The root of data/policies/*.yaml.
struct PolicyFile {
    std::vector<GapPolicySettings> policies;
};
const Table& policy_file_table();

}  // namespace stopline
