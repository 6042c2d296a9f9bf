#include "sim/full_dynamics/platoons.h"

#include <algorithm>
#include <cmath>

#include "v2v/platoon_place.h"

namespace stopline {

void update_platoon(const PlatoonLink& link, int max_vehicles, int id, int slot, V2vReceiver& own) {
    const bool joins = link.leader != nullptr && link.leader->platoon >= 0 && link.leader_has_v2v && link.is_following;
    const PlatoonPlace leader{joins ? link.leader->place_in_platoon : 0, false};
    const PlatoonPlace place = next_platoon_place({own.place_in_platoon, own.leads_mini_platoon}, joins, leader,
                                                  link.is_stopped, max_vehicles);
    own.platoon = place.vehicles_ahead > 0 ? link.leader->platoon : id;
    own.platoon_leader_slot = place.vehicles_ahead > 0 ? link.leader->platoon_leader_slot : slot;
    own.place_in_platoon = place.vehicles_ahead;
    own.leads_mini_platoon = place.leads_mini_platoon;
}

// With C = leader_weight, xi = damping, w = bandwidth, and k = xi + sqrt(xi^2 - 1), the law is
//     u = (1 - C) u_1 + C u_0 - (2 xi - C k) w (v - v_1) - C k w (v - v_0) - w^2 (desired gap - gap)
// The index 1 is the leader, 0 the platoon leader, and u_1 and u_0 are their requests, as in Plexe. The own speed
// relative to both dampens the motion of the platoon as a whole. So errors do not grow along it although the distance
// is constant (Rajamani 2000).
double platoon_acceleration(const PlatoonLawSettings& law, const CaccSettings& limits, const FullGroup& g, int place,
                            double lead_request_mps2, double lead_speed_mps) {
    const double c = law.leader_weight;
    const double w = law.bandwidth_1ps;
    const double k = law.damping + std::sqrt(std::max(law.damping * law.damping - 1.0, 0.0));
    const double feedforward = (1.0 - c) * static_cast<double>(g.heard_request[place]) + c * lead_request_mps2;
    const double damping = (2.0 * law.damping - c * k) * w * static_cast<double>(g.closing[place]) +
                           c * k * w * (static_cast<double>(g.speed[place]) - lead_speed_mps);
    const double feedback = w * w * (g.desired_gap[place] - static_cast<double>(g.gap[place]));
    return std::clamp(feedforward - damping - feedback, -limits.deceleration_comfort_mps2,
                      limits.acceleration_max_mps2);
}

}  // namespace stopline
