// The metrics of cooperative gap opening.
#pragma once

#include "runs/network/network_metrics.h"

namespace stopline {

// Returns the metrics. A table has them only if some drivers ask for gaps by V2V.
MetricList<MeasuredNetwork> gap_metrics();

}  // namespace stopline
