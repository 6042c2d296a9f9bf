// Signal programmes of an imported network.
#pragma once

#include <vector>

#include "signals/programme.h"
#include "sumo_import/sumo_graph.h"

namespace stopline {

// Returns the programme of every signal group. At time t a programme has run for (t - offset) modulo its cycle. The
// letters G g s o O mean green, y Y yellow, all others red.
std::vector<GroupProgramme> make_sumo_signals(const SumoNetwork& network, double step_s);

}  // namespace stopline
