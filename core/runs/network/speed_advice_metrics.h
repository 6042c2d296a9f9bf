// The metric of the speed advice of signals.
#pragma once

#include "runs/network/network_metrics.h"

namespace stopline {

// Returns the metric. A table has it only if some drivers get speed advice.
MetricList<MeasuredNetwork> speed_advice_metrics();

}  // namespace stopline
