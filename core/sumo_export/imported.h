// Writes an imported scenario as input of SUMO. SUMO runs the scenario's own network file.
//
// The files are vehicles.rou.xml, lights.add.xml, detectors.add.xml and run.sumocfg. They contain the traffic and the
// signal programmes of the scenario's additional files, so SUMO does not load those. Their detectors are dropped.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sim/state/model.h"
#include "sumo_import/sumo_graph.h"

namespace stopline {

// The stop lines at which passages are counted: the ends of all lanes with a signal. After short edges were merged,
// one lane can end at several lanes of SUMO, and two lanes can share an end. Such ends count as one stop line.
struct StopLineNames {
    std::vector<std::string> stop_line_of_lane;           // [lane of the graph] name; "": not counted
    std::map<std::string, std::string> stop_line_at_end;  // [lane of SUMO with a detector at its end] name
};
StopLineNames stop_line_names(const SumoNetwork& network);

// Writes vehicles (imported_vehicles.h), signal programmes, detectors at all stop lines, and the configuration. Throws
// InputError if a file cannot be written.
void write_imported_inputs(const std::filesystem::path& folder, const Model& model, const SumoNetwork& network,
                           const StopLineNames& lines, double duration_s);

}  // namespace stopline
