#include "runs/observation.h"

#include <algorithm>

namespace stopline {

void Observation::prepare(Model& model) const {
    if (!look) return;
    model.records_detectors = model.records_detectors || all_detectors;
    // If the model does not record delay causes yet, let the simulation determine once a second why each stopped
    // vehicle is delayed. A network without conflict areas has no delay causes.
    if (!model.rules.watches() && !model.graph.conflicts.empty()) {
        model.rules.watch_ticks = std::max<std::int64_t>(to_ticks(1.0, model.step_s), 1);
    }
}

}  // namespace stopline
