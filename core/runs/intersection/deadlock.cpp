#include "runs/intersection/deadlock.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/containers/index.h"

namespace stopline {

DeadlockSearch::DeadlockSearch(const Model& model, double limit_s)
    : model_(model), limit_ticks_(static_cast<std::int64_t>(std::ceil(limit_s / model.step_s - 1e-9))) {}

void DeadlockSearch::observe(const State& state) {
    if (deadlock_ || state.records.longest_in_junction < limit_ticks_) return;
    Deadlock found;
    found.to_s = model_.time_s(state.tick);
    std::int64_t earliest_tick = state.tick;
    for (std::size_t lane = 0; lane < state.junctions.occupants.size(); ++lane) {
        for (const JunctionOccupant& occupant : state.junctions.occupants[lane]) {
            if (occupant.since >= earliest_tick) continue;
            earliest_tick = occupant.since;
            found.vehicle = state.vehicles.id[at(occupant.slot)];
            found.lane = static_cast<int>(lane);
        }
    }
    found.from_s = model_.time_s(earliest_tick);
    // The rings are observed at intervals, so the latest observation is at most one interval old.
    const double latest_s = model_.time_s(state.tick - model_.rules.watch_ticks);
    for (const Gridlock& ring : state.congestion.delays.gridlocks) {
        const bool has_vehicle = std::count(ring.vehicles.begin(), ring.vehicles.end(), found.vehicle) > 0;
        if (ring.to_s < latest_s || (!found.ring.vehicles.empty() && !has_vehicle)) continue;
        found.ring = ring;
    }
    deadlock_ = found;
}

std::string deadlock_text(const Deadlock& deadlock, const std::vector<std::string>& lanes) {
    const auto name = [&](int lane) { return lane < 0 ? std::string("an unknown lane") : lanes[at(lane)]; };
    std::string text = fmt::format("vehicle {} has been inside the intersection on {} from {:.1f} s to {:.1f} s",
                                   deadlock.vehicle, name(deadlock.lane), deadlock.from_s, deadlock.to_s);
    const std::vector<int>& ring = deadlock.ring.vehicles;
    if (ring.empty()) return text + "; no ring of vehicles waits for each other\n";
    text += fmt::format("; since {:.0f} s, {} vehicles wait for each other:\n", deadlock.ring.from_s, ring.size());
    for (std::size_t k = 0; k < ring.size(); ++k) {
        text += fmt::format("  vehicle {} on {} waits for vehicle {}\n", ring[k], name(deadlock.ring.lanes[k]),
                            ring[(k + 1) % ring.size()]);
    }
    return text;
}

}  // namespace stopline
