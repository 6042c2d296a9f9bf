#include "runs/intersection/deadlock.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "sim/state/queries/stopped_vehicles.h"

namespace stopline {

namespace {

// Returns the id of the vehicle that has been on a connection since a tick; -1: none. The list of occupants holds the
// slots at the start of the step. During the step, vehicles may have got other slots, so their lanes are searched.
int vehicle_since(const State& state, int connection, std::int64_t tick) {
    const LanePlan& plan = state.plan.lane(connection);
    for (const int lane : {connection, plan.exit, plan.origin}) {
        if (lane < 0) continue;
        const LaneBlock& block = state.blocks[at(lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            if (state.vehicles.record[at(slot)].junction_entry_tick == tick) return state.vehicles.id[at(slot)];
        }
    }
    return -1;
}

}  // namespace

DeadlockSearch::DeadlockSearch(const Model& model, double limit_s)
    : model_(model), limit_ticks_(static_cast<std::int64_t>(std::ceil(limit_s / model.step_s - 1e-9))) {}

void DeadlockSearch::observe(const State& state) {
    if (deadlock_) {
        // The vehicle may have been moving slowly when the deadlock was found. The members are listed as soon as the
        // delay watch finds it stopped.
        if (deadlock_->members.empty()) deadlock_->members = members_from(state, deadlock_->vehicle);
        return;
    }
    if (state.records.longest_in_junction_ticks < limit_ticks_) return;
    Deadlock found;
    found.to_s = model_.time_s(state.tick);
    std::int64_t earliest_tick = state.tick;
    for (std::size_t lane = 0; lane < state.plan.lane_order().size(); ++lane) {
        for (const JunctionOccupant& occupant : occupants_of(state, static_cast<int>(lane))) {
            if (occupant.since_tick >= earliest_tick) continue;
            earliest_tick = occupant.since_tick;
            found.lane = static_cast<int>(lane);
        }
    }
    if (found.lane >= 0) found.vehicle = vehicle_since(state, found.lane, earliest_tick);
    found.from_s = model_.time_s(earliest_tick);
    found.members = members_from(state, found.vehicle);
    deadlock_ = found;
}

std::vector<DeadlockMember> DeadlockSearch::members_from(const State& state, int vehicle) {
    std::vector<DeadlockMember> members;
    const auto is_listed = [&](int id) {
        return std::any_of(members.begin(), members.end(),
                           [&](const DeadlockMember& one) { return one.vehicle == id; });
    };
    while (!is_listed(vehicle)) {
        const std::optional<StoppedVehicle> stopped = find_stopped_vehicle(state, vehicle);
        if (!stopped) break;
        members.push_back({vehicle, stopped->lane, stopped->direct_cause, stopped->waits_for});
        vehicle = stopped->waits_for;
    }
    return members;
}

std::string deadlock_text(const Deadlock& deadlock, const std::vector<std::string>& lanes) {
    const auto name = [&](int lane) { return lane < 0 ? std::string("an unknown lane") : lanes[at(lane)]; };
    std::string text = fmt::format("vehicle {} has been inside the intersection on {} from {:.1f} s to {:.1f} s.\n",
                                   deadlock.vehicle, name(deadlock.lane), deadlock.from_s, deadlock.to_s);
    for (const DeadlockMember& member : deadlock.members) {
        const char* const cause = kDelayCauseNames[static_cast<std::size_t>(member.cause)];
        const std::string why = member.cause == DelayCause::none ? "" : fmt::format(" ({})", cause);
        const std::string whom = member.waits_for < 0 ? "" : fmt::format(" for vehicle {}", member.waits_for);
        text += fmt::format("  vehicle {} on {} waits{}{}\n", member.vehicle, name(member.lane), whom, why);
    }
    return text;
}

}  // namespace stopline
