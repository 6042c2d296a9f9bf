// An imported network as input of SUMO again: the scenario's own network file, and beside it what the import made of the others.
//
// Files in a folder: vehicles.rou.xml, lights.add.xml, detectors.add.xml, run.sumocfg. Additional files of the scenario are not named:
// their programmes are in lights.add.xml, their traffic in vehicles.rou.xml, and their detectors would write files of their own.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "network/sumo_graph.h"
#include "sim/model.h"

namespace stopline {

// Where passages are counted: at the ends of lanes with lights. Lanes that end where edges were joined to theirs may share an end, and
// have several: these are counted together.
struct StopLineNames {
    std::vector<std::string> of_lane;            // [lane of the graph]; empty: not counted
    std::map<std::string, std::string> of_ends;  // by SUMO's lane at whose end a loop is
};
StopLineNames stop_line_names(const SumoNetwork& network);

// Vehicles (sumo/imported_vehicles.h), programmes of lights as they run here, loops at all stop lines, configuration. Throws InputError
// where a file cannot be written.
void write_imported_inputs(const std::filesystem::path& folder, const Model& model, const SumoNetwork& network,
                           const StopLineNames& lines, double duration_s);

}  // namespace stopline
