// Every vehicle at every frame as CSV, for runs of which too many rows come for a table in memory.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "record/frame_clock.h"
#include "record/run_writer.h"

namespace stopline {

// Columns: population, time_s, vehicle, policy, lane, place_m (of the front, from the lane's start), x_m, y_m, speed_mps,
// acceleration_mps2. Names may hold no comma, quote or line break.
std::unique_ptr<RunWriter> make_trajectory_writer(const std::filesystem::path& file, const RecordingWindow& window,
                                                  const std::string& population, const Model& model);

}  // namespace stopline
