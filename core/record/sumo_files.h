// Tables of a run in the formats of SUMO, so that tools made for it read them. Their schemas: fcd_file.xsd, tripinfo_file.xsd and
// det_e1_file.xsd of SUMO's data/xsd. Lanes have our names; inside an intersection they begin with a colon, as SUMO's do.
#pragma once

#include <filesystem>
#include <memory>

#include "record/frame_clock.h"
#include "record/run_writer.h"

namespace stopline {

// Floating car data: every vehicle at every frame. x, y and pos are of the front, angles from north clockwise.
std::unique_ptr<RunWriter> make_fcd_writer(const std::filesystem::path& file, const RecordingWindow& window,
                                           const Model& model);

// A row for each vehicle that has left the network, to the step. A vehicle that was moved on past an intersection is still on
// its trip. Departures have a delay where vehicles have trips; elsewhere nobody is known to wait outside.
std::unique_ptr<RunWriter> make_tripinfo_writer(const std::filesystem::path& file, const Model& model);

// Every detector as an induction loop, by interval: vehicles whose front passed, their mean speed, and the share of steps in which
// one stood or drove above it. Needs Model::records_detectors.
std::unique_ptr<RunWriter> make_loop_writer(const std::filesystem::path& file, double interval_s, const Model& model);

}  // namespace stopline
