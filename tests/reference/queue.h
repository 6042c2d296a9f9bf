// The start of a queue in the mesoscale mode of the reference engine. V2V relays a start message through the standing
// queue: several stopped vehicles learn in one step that the vehicle ahead of the queue has started.
#pragma once

#include "reference/meso.h"
#include "reference/world.h"

namespace stopline::reference_engine {

// Updates the members of the standing queue: consecutive vehicles at rest. A new queue begins with the first vehicle of
// the lane. The queue loses the vehicles that have started at its head, and gains those that have stopped behind it. A
// member behind the first one must react to nothing but its leader. So the queue is dissolved, up to the end of the
// next step, if such a member must stop at the line or yield, or if a vehicle has entered the lane.
inline void update_standing_queue(Lane& lane, std::int64_t tick) {
    std::deque<Vehicle>& vehicles = lane.vehicles;
    const auto is_member = [](const Vehicle& v) { return v.is_in_queue; };
    const auto head = std::find_if(vehicles.begin(), vehicles.end(), is_member);
    if (head == vehicles.end() ? lane.last_stop_index() > 0 : lane.last_stop_index() > head - vehicles.begin()) {
        lane.disturbed_tick = tick;
    }
    auto first = std::find_if(head, vehicles.end(), [](const Vehicle& v) { return !v.is_in_queue || v.is_at_rest(); });
    auto past_last =
        std::find_if(first, vehicles.end(), [](const Vehicle& v) { return !v.is_in_queue || !v.is_at_rest(); });
    for (Vehicle& v : vehicles) v.is_in_queue = false;
    if (lane.disturbed_tick >= tick - 1) return;
    if (first == past_last) first = past_last = vehicles.begin();
    while (past_last != vehicles.end() && past_last->is_at_rest()) ++past_last;
    for (auto v = first; v != past_last; ++v) v->is_in_queue = true;
}

// Sends a start message to the first vehicles of the standing queue if the vehicle ahead of the queue has started. The
// receivers take over the acceleration of this vehicle. The relay ends before a vehicle whose policy has a time gap,
// before a vehicle with a long gap, and after the highest number of receivers.
inline void relay_start_message(const MesoModel& model, Lane& lane) {
    constexpr double kClosedUp_m = 0.5;
    std::deque<Vehicle>& vehicles = lane.vehicles;
    const auto head = std::find_if(vehicles.begin(), vehicles.end(), [](const Vehicle& v) { return v.is_in_queue; });
    if (head == vehicles.end() || head == vehicles.begin()) return;
    if (lane.last_stop_index() >= head - vehicles.begin()) return;
    const Vehicle& started = *(head - 1);
    if (started.speed_mps == 0.0 || started.acceleration_mps2 <= 0.0) return;
    int receivers = 0;
    for (auto v = head; v != vehicles.end() && v->is_in_queue; ++v) {
        const MesoPolicy& policy = model.policies[static_cast<std::size_t>(v->policy)];
        const double gap_m = (v - 1)->rear_m() - v->position_m;
        if (receivers == model.settings.start_relay_vehicles || !policy.constant_distance ||
            gap_m > policy.equilibrium_gap_m(0.0) + kClosedUp_m) {
            break;
        }
        v->acceleration_mps2 = started.acceleration_mps2;
        v->has_start_message = true;
        ++receivers;
    }
}

}  // namespace stopline::reference_engine
