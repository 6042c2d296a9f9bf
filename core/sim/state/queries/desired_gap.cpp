#include "sim/state/queries/desired_gap.h"

#include "base/containers/index.h"

namespace stopline {

double desired_gap_m(const Model& model, int policy_number, double speed_mps) {
    const CompiledPolicy& policy = model.policies[at(policy_number)];
    double gap_m = 0.0;
    double slope_s = 0.0;
    policy.law->evaluate(policy.settings, {&speed_mps, 1}, {&gap_m, 1}, {&slope_s, 1});
    if (!model.meso) return gap_m;
    const Krauss& krauss = model.krauss[at(policy_number)];
    const double extra_m = krauss.constant_distance ? gap_m - policy.settings.standstill_gap_m : 0.0;
    return krauss.equilibrium_gap_m(speed_mps) + extra_m;
}

}  // namespace stopline
