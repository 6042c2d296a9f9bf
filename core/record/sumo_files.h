// Writers for result files in SUMO's formats, so that tools for SUMO can read them. The schemas fcd_file.xsd,
// tripinfo_file.xsd and det_e1_file.xsd are in SUMO's folder data/xsd. Lanes have the names of the lane graph. As in
// SUMO, names of connections begin with a colon.
#pragma once

#include <filesystem>
#include <memory>

#include "record/recording/frame_clock.h"
#include "record/run_writer.h"

namespace stopline {

// Returns a writer for floating car data. Each frame lists every vehicle in the network. The attributes x, y and pos
// refer to the front of the vehicle. Angles are clockwise from north, in degrees.
std::unique_ptr<RunWriter> make_fcd_writer(const std::filesystem::path& file, const RecordingWindow& window,
                                           const Model& model);

// Returns a writer for completed trips, with one element for each vehicle that left the network. A teleport does not
// end a trip. The attribute depart is the first time at which the vehicle is in the network. The attribute departDelay
// is departure_delay_s() (departure_delay.h).
std::unique_ptr<RunWriter> make_tripinfo_writer(const std::filesystem::path& file, const Model& model);

// Returns a writer for the data of all detectors, in the format of SUMO's induction loops. An element holds, for one
// detector and one time interval, the number of passing vehicles, their mean speed, and the occupancy. The occupancy is
// the share of steps in which a vehicle covers the detector. Model::records_detectors must be set.
std::unique_ptr<RunWriter> make_loop_writer(const std::filesystem::path& file, double interval_s, const Model& model);

}  // namespace stopline
