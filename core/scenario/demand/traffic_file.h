// Reads files with detector counts (demand.counts) and origin-destination matrices (demand.od).
#pragma once

#include <filesystem>
#include <vector>

#include "scenario/import_sumo.h"
#include "scenario/scenario.h"

namespace stopline {

// Reads the file that demand.counts or demand.od names, checks it against the network, and stores its content in the
// scenario. Does nothing for other kinds of demand. Relative paths start at `directory`. Returns one entry for each
// problem.
//
// A file has a header line. Columns of counts: begin, end, approach, vehicles, and optionally left, straight, right.
// Columns of a matrix: begin, end, origin, destination, vehicles. Times are seconds since the start of the run.
std::vector<FieldProblem> read_traffic_file(Scenario& scenario, const std::filesystem::path& directory);

// Returns 0, or a hash of the file's text if the demand comes from a file.
std::uint64_t traffic_file_hash(const Scenario& scenario);

}  // namespace stopline
