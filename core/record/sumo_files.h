// Writers for result files in SUMO's formats, so that tools for SUMO can read them. The schemas fcd_file.xsd,
// tripinfo_file.xsd and det_e1_file.xsd are in SUMO's data/xsd. Lanes have our names; as in SUMO, names of connections
// begin with a colon.
#pragma once

#include <filesystem>
#include <memory>

#include "record/recording/frame_clock.h"
#include "record/run_writer.h"

namespace stopline {

// Returns a writer for floating car data: every vehicle at every frame. x, y and pos refer to the front of the vehicle.
// Angles count clockwise from north.
std::unique_ptr<RunWriter> make_fcd_writer(const std::filesystem::path& file, const RecordingWindow& window,
                                           const Model& model);

// Returns a writer for completed trips, one row for each vehicle that left the network. A teleported vehicle continues
// its trip. Departure delays need planned trips; without them they are 0.
std::unique_ptr<RunWriter> make_tripinfo_writer(const std::filesystem::path& file, const Model& model);

// Returns a writer for all detectors as induction loops. A row has the passages of fronts in one interval, their mean
// speed, and the occupancy: the share of steps in which a vehicle covers the detector. Needs Model::records_detectors.
std::unique_ptr<RunWriter> make_loop_writer(const std::filesystem::path& file, double interval_s, const Model& model);

}  // namespace stopline
