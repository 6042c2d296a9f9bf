// Signal programmes in SUMO's files.
#pragma once

#include "network/sumo_net.h"
#include "network/sumo_xml.h"

namespace stopline {

// Reads a tlLogic. `from_net`: of the network itself, where its id must be new; else of an additional file, where it replaces the
// programme of that id, or its offset if there are no phases, or is the first one of a light that connections name. Throws InputError.
void add_sumo_signal(const SumoXml& xml, pugi::xml_node node, bool from_net, SumoNet& net);

}  // namespace stopline
