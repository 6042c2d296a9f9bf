// Writes a model as input of SUMO (1.28): plain XML for netconvert, and the other files of a SUMO run.
//
// netconvert builds net.net.xml from nodes.nod.xml, edges.edg.xml, connections.con.xml and lights.tll.xml. The other
// files are detectors.add.xml, vehicles.rou.xml and run.sumocfg.
#pragma once

#include <filesystem>
#include <memory>

#include "record/run_writer.h"
#include "record/xml_file.h"
#include "sumo_export/edges.h"

namespace stopline {

// Writes network, signal programmes for `duration_s`, detectors and configuration. Throws InputError if a file cannot
// be written.
void write_sumo_inputs(const std::filesystem::path& folder, const Model& model, const PlainNetwork& network,
                       double duration_s);

// Writes SUMO's options for teleporting and for junction blockers according to the rules of the model.
void write_sumo_rules(XmlFile& xml, const Model& model);

// Returns a writer for the vehicles of one of our runs as a SUMO route file: insertion time, position and speed, the
// edges of the route, and the vehicle types. The writer keeps references to `model` and `network`.
std::unique_ptr<RunWriter> make_sumo_route_writer(const std::filesystem::path& file, const Model& model,
                                                  const PlainNetwork& network);

}  // namespace stopline
