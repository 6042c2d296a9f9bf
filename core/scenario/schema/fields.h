// The tables of fields, one per settings struct. A new field needs a struct member and one row in fields/*.cpp.
#pragma once

#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "scenario/schema/field_table.h"

namespace stopline {

const Table& scenario_table();      // Scenario: the root of a scenario file
const Table& network_table();       // NetworkSettings
const Table& streets_table();       // StreetSettings: the root of data/berlin/*.yaml
const Table& signal_table();        // SignalSettings
const Table& demand_table();        // DemandSettings
const Table& vehicle_table();       // PowertrainSettings: the root of data/vehicles/*.yaml
const Table& driver_table();        // DriverSettings: the root of data/drivers/*.yaml
const Table& v2v_table();           // V2vSettings
const Table& platoon_table();       // PlatoonSettings
const Table& speed_advice_table();  // SpeedAdviceSettings
const Table& rules_table();         // TrafficRules
const Table& idm_table();           // IdmSettings
const Table& meso_table();          // MesoSettings: the root of data/meso/*.yaml
const Table& gap_policy_table();    // GapPolicySettings
const Table& population_table();    // PopulationSettings
const Table& measure_table();       // MeasureSettings
const Table& energy_table();        // EnergySettings

// Returns the names of all combinations of movements that an approach lane may allow, such as "straight+left".
const std::vector<std::string>& lane_movements();

const Table& sweep_table();  // SweepSettings (sweep_settings.h): the root of a sweep file

// AcceptedFile: the root of a file with differences between full dynamics and the mesoscale mode that a user accepts
// (load_accepted.h).
const Table& accepted_table();

// The content of a file data/policies/*.yaml.
struct PolicyFile {
    std::vector<GapPolicySettings> policies;
};
const Table& policy_file_table();

}  // namespace stopline
