// Reader for signal programmes in SUMO's files.
#pragma once

#include "sumo_import/sumo_net.h"
#include "sumo_import/sumo_xml.h"

namespace stopline {

// Reads a tlLogic element (a signal programme) into `net`. `from_net` is true for the network file and false for an
// additional file. The programme replaces an earlier programme of the same signal. In an additional file, an element
// without phases replaces only the offset. Throws InputError with file and line if the element is invalid.
void add_sumo_signal(const SumoXml& xml, pugi::xml_node node, bool from_net, SumoNet& net);

}  // namespace stopline
