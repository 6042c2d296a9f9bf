#include "sim/state/queries/desired_gap.h"

#include <algorithm>

#include "base/containers/index.h"
#include "sim/state/queries/response_time.h"

namespace stopline {

double desired_gap_m(const Model& model, int policy_number, double speed_mps) {
    const GapPolicy& policy = model.policies[at(policy_number)];
    if (!model.meso) {
        const double gap_m = equilibrium_gap_m(policy, speed_mps);
        return keeps_response_gap(model, policy_number)
                   ? std::max(gap_m, response_gap_m(model, policy_number, speed_mps))
                   : gap_m;
    }
    const double following_m = model.following[at(policy_number)].equilibrium_gap_m(speed_mps);
    if (!policy.meso.has_extra_gap) return following_m;
    return following_m + (equilibrium_gap_m(policy, speed_mps) - policy.meso.gap_m(speed_mps));
}

}  // namespace stopline
