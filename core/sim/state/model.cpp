#include "sim/state/model.h"

#include <cmath>

#include "base/input_error.h"

namespace stopline {

DelayLine make_delay(double delay_s, double step_s) {
    constexpr double kRounding = 1e-9;  // a delay of 0.15 s is 15 steps of 0.01 s in spite of rounding
    DelayLine line;
    const double exact = delay_s / step_s;
    line.steps = static_cast<int>(std::floor(exact + kRounding));
    line.share = exact - line.steps > kRounding ? exact - line.steps : 0.0;
    line.rows = line.steps + 2;
    return line;
}

void check(const Model& model) {
    check(model.graph);
    if (model.step_s <= 0.0) throw InputError("the step must be positive");
    if (model.signals.groups() != model.graph.signal_groups || !model.signals.is_complete()) {
        throw InputError("every signal group needs one programme");
    }
    if (model.vehicles.empty() || model.drivers.empty() || model.policies.empty()) {
        throw InputError("a vehicle type, a driver and a policy are needed");
    }
    if (model.classes.size() != model.policies.size()) throw InputError("every policy needs a vehicle and a driver");
    if (model.meso && model.following.size() != model.policies.size()) {
        throw InputError("every policy needs a mesoscale model");
    }
    if (model.demand.trips.size() != model.demand.trip_policies.size()) throw InputError("every trip needs a policy");
    if (model.v2v.steps < 1) throw InputError("driver: v2v_delay must be at least one simulation step");
}

}  // namespace stopline
