// Writes the planned trips of a scenario with an imported network as a SUMO route file.
#pragma once

#include <filesystem>

#include "sim/state/model.h"
#include "sumo_import/sumo_graph.h"

namespace stopline {

// Writes a vehicle type for each pair of spacing policy and vehicle length. Then writes all vehicles with id, type,
// planned departure and all edges of the route, including short edges that the import has merged. Throws InputError if
// the file cannot be written.
void write_imported_vehicles(const std::filesystem::path& file, const Model& model, const SumoNetwork& network);

}  // namespace stopline
