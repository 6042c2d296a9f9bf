// The vehicles that an import planned, as SUMO's routes.
#pragma once

#include <filesystem>

#include "network/sumo_graph.h"
#include "sim/model.h"

namespace stopline {

// With their ids, lengths, planned times and places to depart, all edges of their ways (those that were joined to others included), and the
// parameters of their policies' mesoscale models. Throws InputError where the file cannot be written.
void write_imported_vehicles(const std::filesystem::path& file, const Model& model, const SumoNetwork& network);

}  // namespace stopline
