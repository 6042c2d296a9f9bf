// Writes a model as input of SUMO (version 1.28): plain XML files for netconvert, and the other files of a SUMO run.
//
// netconvert builds the network file net.net.xml from nodes.nod.xml, edges.edg.xml, connections.con.xml and
// lights.tll.xml. The other files are detectors.add.xml, vehicles.rou.xml and run.sumocfg.
#pragma once

#include <filesystem>
#include <memory>

#include "record/run_writer.h"
#include "record/xml_file.h"
#include "sumo_export/edges.h"

namespace stopline {

// Writes all files except vehicles.rou.xml, for a run of `duration_s`. Throws InputError if a file cannot be written.
void write_sumo_inputs(const std::filesystem::path& folder, const Model& model, const PlainNetwork& network,
                       double duration_s);

// Writes the options that make SUMO treat blocked vehicles as the model does: after which time SUMO teleports a
// vehicle, and after which time a vehicle ignores another one that blocks the junction.
void write_sumo_rules(XmlFile& xml, const Model& model);

// Returns a writer that records the vehicles of a run of Stopline as a SUMO route file. Each vehicle has its type, its
// time, position and speed at insertion, and the edges of its route. The writer keeps references to `model` and
// `network`.
std::unique_ptr<RunWriter> make_sumo_route_writer(const std::filesystem::path& file, const Model& model,
                                                  const PlainNetwork& network);

}  // namespace stopline
