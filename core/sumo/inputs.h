// A model as input of SUMO (1.28): plain XML for netconvert, and what a run of SUMO needs besides the network.
//
// Files in a folder: nodes.nod.xml, edges.edg.xml, connections.con.xml, lights.tll.xml (netconvert makes net.net.xml of them);
// detectors.add.xml; vehicles.rou.xml; run.sumocfg.
#pragma once

#include <filesystem>
#include <memory>

#include "record/run_writer.h"
#include "record/xml_file.h"
#include "sumo/edges.h"

namespace stopline {

// Network, lights over `duration_s`, detectors, configuration. Throws InputError where a file cannot be written.
void write_sumo_inputs(const std::filesystem::path& folder, const Model& model, const PlainNetwork& network,
                       double duration_s);

// Whoever blocks or stands for long is treated in SUMO as our rules say: its teleport and its passing of junction blockers.
void write_sumo_rules(XmlFile& xml, const Model& model);

// Every vehicle of a run: its number, when, where and how fast it entered, the edges of its way, and the parameters of its
// policy's mesoscale model. Keeps references until it has finished.
std::unique_ptr<RunWriter> make_sumo_route_writer(const std::filesystem::path& file, const Model& model,
                                                  const PlainNetwork& network);

}  // namespace stopline
