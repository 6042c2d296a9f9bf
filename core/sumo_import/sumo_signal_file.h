// Reader for signal programmes in SUMO's files.
#pragma once

#include "sumo_import/sumo_net.h"
#include "sumo_import/sumo_xml.h"

namespace stopline {

// Reads a tlLogic element into `net`. `from_net` is true for the network file and false for an additional file. In an
// additional file the element replaces the programme of the signal, or only its offset if the element has no phases.
// Throws InputError with file and line.
void add_sumo_signal(const SumoXml& xml, pugi::xml_node node, bool from_net, SumoNet& net);

}  // namespace stopline
