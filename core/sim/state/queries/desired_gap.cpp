#include "sim/state/queries/desired_gap.h"

#include "base/containers/index.h"

namespace stopline {

double desired_gap_m(const Model& model, int policy_number, double speed_mps) {
    const GapPolicy& policy = model.policies[at(policy_number)];
    if (!model.meso) return equilibrium_gap_m(policy, speed_mps);
    const double following_m = model.following[at(policy_number)].equilibrium_gap_m(speed_mps);
    if (!policy.meso.has_extra_gap) return following_m;
    return following_m + (equilibrium_gap_m(policy, speed_mps) - policy.meso.gap_m(speed_mps));
}

}  // namespace stopline
