// Writes a scenario with an imported network as input of SUMO. SUMO runs the network file that the scenario names.
//
// The files are vehicles.rou.xml, lights.add.xml, detectors.add.xml and run.sumocfg. They contain all traffic and
// signal programmes of the scenario, also from its additional files. So SUMO does not load the additional files.
// Detectors in the additional files are not used.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sim/state/model.h"
#include "sumo_import/sumo_graph.h"

namespace stopline {

// The stop lines at which passages are counted: the ends of all lanes with a signal.
//
// The import merges short edges (sumo_short_edges.h). After a merge, one lane of the graph can end where several SUMO
// lanes end, and two lanes of the graph can end where the same SUMO lane ends. In both cases these ends count as one
// stop line.
struct StopLineNames {
    std::vector<std::string> stop_line_of_lane;           // [lane of the graph] name; "": no passages are counted
    std::map<std::string, std::string> stop_line_at_end;  // [SUMO lane with a detector at its end] name
};
StopLineNames stop_line_names(const SumoNetwork& network);

// Writes vehicles (imported_vehicles.h), signal programmes, detectors at all stop lines, and the configuration. Throws
// InputError if a file cannot be written.
void write_imported_inputs(const std::filesystem::path& folder, const Model& model, const SumoNetwork& network,
                           const StopLineNames& lines, double duration_s);

}  // namespace stopline
