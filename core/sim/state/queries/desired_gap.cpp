#include "sim/state/queries/desired_gap.h"

#include "base/containers/index.h"

namespace stopline {

double desired_gap_m(const Model& model, int policy_number, double speed_mps) {
    const GapPolicy& policy = model.policies[at(policy_number)];
    const double gap_m = equilibrium_gap_m(policy, speed_mps);
    if (!model.meso) return gap_m;
    const double extra_m = policy.meso.has_extra_gap ? gap_m - policy.meso.gap_m(speed_mps) : 0.0;
    return model.following[at(policy_number)].equilibrium_gap_m(speed_mps) + extra_m;
}

}  // namespace stopline
