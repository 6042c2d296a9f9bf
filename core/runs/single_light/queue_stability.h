// Growth of accelerations along the queue of a single light.
#pragma once

#include <vector>

#include "measure/headways.h"
#include "runs/single_light/single_light.h"

namespace stopline {

// `line` lists the vehicles that pass the stop line within the green. `points` are their trajectories.
QueueStability queue_stability(const Scenario& scenario, const PopulationSettings& population,
                               const std::vector<LinePassage>& line, const std::vector<TrajectoryPoint>& points,
                               double green_start_s);

}  // namespace stopline
