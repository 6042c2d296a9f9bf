// Writer for trajectories as CSV. It writes the rows during the run, because the table of a long run would not fit into
// memory.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "record/recording/frame_clock.h"
#include "record/run_writer.h"

namespace stopline {

inline constexpr const char* kTrajectoryHeader =
    "population,time_s,vehicle,policy,lane,position_m,x_m,y_m,speed_mps,acceleration_mps2\n";

// Returns a writer that writes one row per vehicle and frame. `header` is the first line of the file: either
// kTrajectoryHeader, or a line with other names for the same columns. The names of the population and of its policies
// must not contain commas, quotes or line breaks, because they are not quoted. A file whose name ends with ".gz" is
// compressed.
std::unique_ptr<RunWriter> make_trajectory_writer(const std::filesystem::path& file, const RecordingWindow& window,
                                                  const std::string& population, const Model& model,
                                                  const std::string& header = kTrajectoryHeader);

}  // namespace stopline
