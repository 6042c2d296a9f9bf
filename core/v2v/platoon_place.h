// The rules by which vehicles with V2V form platoons of limited length. Both fidelities use them.
#pragma once

namespace stopline {

// The place of a vehicle in its platoon. A vehicle alone is a platoon, too.
struct PlatoonPlace {
    int vehicles_ahead = 0;           // number of vehicles ahead in the platoon; 0: platoon leader
    bool leads_mini_platoon = false;  // true: the platoon ahead is full (PlatoonSettings::max_vehicles)
};

// Returns true if a vehicle follows its leader closely enough for a platoon. `excess_gap_m`: its net gap minus its
// desired gap. `was_following`: it was close enough before.
inline bool is_close_enough(double excess_gap_m, bool was_following) {
    constexpr double kJoins_m = 15.0;
    constexpr double kLeaves_m = 25.0;
    return excess_gap_m < (was_following ? kLeaves_m : kJoins_m);
}

// Returns the next place of a vehicle. `joins`: it can join the platoon of its leader, whose place is `leader`. If that
// platoon is full, the vehicle leads a mini-platoon until it stops or gets another leader. The caller resets
// PlatoonPlace::leads_mini_platoon of `own` if the leader has changed. `max_vehicles` 0: platoons have any length.
inline PlatoonPlace next_platoon_place(const PlatoonPlace& own, bool joins, const PlatoonPlace& leader, bool is_stopped,
                                       int max_vehicles) {
    const bool has_room = max_vehicles == 0 || leader.vehicles_ahead + 1 < max_vehicles;
    if (joins && has_room && (!own.leads_mini_platoon || is_stopped)) return {leader.vehicles_ahead + 1, false};
    return {0, joins};
}

}  // namespace stopline
