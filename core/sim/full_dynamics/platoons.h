// Platoons of vehicles with V2V: which vehicle leads them, and how its followers use its messages.
#pragma once

#include "sim/state/model.h"
#include "sim/state/vehicles/full_group.h"
#include "v2v/receiver.h"

namespace stopline {

// The data of a vehicle that decide to which platoon it belongs.
struct PlatoonLink {
    const V2vReceiver* leader = nullptr;  // data of the leader; null: there is no leader
    bool leader_has_v2v = false;
    bool is_following = false;  // the vehicle follows its leader: it is not free and not out of reach
    bool is_stopped = false;
};

// Sets the platoon of the vehicle in `slot` with the number `id`. The vehicle joins the platoon of its leader at the
// tail. It leads a platoon of its own if it does not follow, if its leader has no V2V, or if the platoon ahead is full.
// In the last case it stays the leader of its mini-platoon until it stops or gets another leader. Call from front to
// rear of a lane.
void update_platoon(const PlatoonLink& link, int max_vehicles, int id, int slot, V2vReceiver& own);

// Returns the acceleration of the law of Rajamani for a vehicle that follows its leader and its platoon leader.
// `place`: place of the vehicle in the group, whose heard_request, gap and closing are those of the leader.
// `lead_request_mps2` and `lead_speed_mps` are those of the platoon leader.
double platoon_acceleration(const PlatoonLawSettings& law, const CaccSettings& limits, const FullGroup& group,
                            int place, double lead_request_mps2, double lead_speed_mps);

}  // namespace stopline
