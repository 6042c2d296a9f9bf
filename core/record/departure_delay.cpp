#include "record/departure_delay.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"

namespace stopline {

double departure_delay_s(const Model& model, int trip, std::int64_t entry_tick) {
    if (trip < 0) return 0.0;
    const double depart_s = model.demand.trips[at(trip)].depart_s;
    // The first tick after the departure. insert_trips() compares the times in the same way, so rounding errors do not
    // count as a delay of one step.
    auto first_tick = static_cast<std::int64_t>(std::floor(depart_s / model.step_s));
    while (model.time_s(first_tick) <= depart_s) ++first_tick;
    return model.time_s(std::max<std::int64_t>(entry_tick - first_tick, 0));
}

}  // namespace stopline
