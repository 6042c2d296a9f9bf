// Writes the planned trips of an imported scenario as a SUMO route file.
#pragma once

#include <filesystem>

#include "sim/state/model.h"
#include "sumo_import/sumo_graph.h"

namespace stopline {

// Writes all vehicles with ids, lengths, planned departures and all edges of their routes, merged edges included, and
// the vehicle types of all policies. Throws InputError if the file cannot be written.
void write_imported_vehicles(const std::filesystem::path& file, const Model& model, const SumoNetwork& network);

}  // namespace stopline
