#include "runs/intersection/deadlock.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
    : model_(model),
      limit_ticks_(static_cast<std::int64_t>(std::ceil(limit_s / model.step_s - 1e-9))),
      watched_ticks_(std::min(limit_ticks_, static_cast<std::int64_t>(std::ceil(kMinDeadlock_s / model.step_s)))) {}

void DeadlockSearch::observe(const State& state) {
    if (deadlock_) {
        // The vehicle may have been moving slowly when the deadlock was found. The members are listed as soon as the
        // delay watch finds it stopped.
        if (deadlock_->members.empty()) deadlock_->members = members_from(state, deadlock_->vehicle);
        return;
    }
    // Only the delay watch updates the list of stopped vehicles.
    if (state.tick % model_.rules.watch_ticks != 0) return;
    if (state.records.longest_in_junction_ticks >= watched_ticks_) watch_occupants(state);
}

// Records the latest lawful wait of each vehicle inside. Records a deadlock if a vehicle exceeds the limit; if several
// do, the one with the longest time.
void DeadlockSearch::watch_occupants(const State& state) {
    std::map<int, std::int64_t> last_lawful_tick;
    std::int64_t earliest_tick = state.tick - limit_ticks_ + 1;
    for (std::size_t lane = 0; lane < state.plan.lane_order().size(); ++lane) {
        for (const JunctionOccupant& occupant : occupants_of(state, static_cast<int>(lane))) {
            if (state.tick - occupant.since_tick < watched_ticks_) continue;
            const int vehicle = vehicle_since(state, static_cast<int>(lane), occupant.since_tick);
            std::vector<DeadlockMember> members = members_from(state, vehicle);
            std::int64_t since_tick = occupant.since_tick;
            if (is_lawful(members)) {
                since_tick = last_lawful_tick[vehicle] = state.tick;
            } else if (const auto known = last_lawful_tick_.find(vehicle); known != last_lawful_tick_.end()) {
                since_tick = last_lawful_tick[vehicle] = known->second;
            }
            if (since_tick >= earliest_tick) continue;
            earliest_tick = since_tick;
            deadlock_ = Deadlock{vehicle, static_cast<int>(lane), model_.time_s(since_tick), model_.time_s(state.tick),
                                 std::move(members)};
        }
    }
    last_lawful_tick_ = std::move(last_lawful_tick);
}

// Returns true if the last vehicle of a chain yields to traffic that moves.
bool DeadlockSearch::is_lawful(const std::vector<DeadlockMember>& members) {
    return !members.empty() && members.back().cause == DelayCause::yielding && members.back().waits_for < 0;
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
    std::string text = fmt::format(
        "vehicle {} on {} has neither left the intersection nor yielded to moving traffic from {:.1f} s to {:.1f} s.\n",
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
