#include "record/recording/vehicle_links.h"

#include <algorithm>
#include <array>

#include "base/containers/index.h"

namespace stopline {

namespace {

bool has_refusals(const Model& model) { return model.rules.clearing; }

// Returns the slot of the vehicle with this id upstream of the stop line of a lane; -1: none.
int slot_before_line(const State& state, int lane, int id) {
    const LaneBlock& block = state.blocks[at(lane)];
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        if (state.vehicles.id[at(slot)] != id) continue;
        return state.vehicles.position_m[at(slot)] <= state.plan.lane(lane).stop_line_m ? slot : -1;
    }
    return -1;
}

// Cooperative clearing has refused the vehicle, which waits at green for room on its exit lane: behind the last vehicle
// there, if there is one. If a crossing vehicle blocks the way, the link ends at the connection.
void add_refusals(const State& state, int kind, std::vector<VehicleLink>& links) {
    for (int lane = 0; lane < state.plan.lanes(); ++lane) {
        const KeepClearHold& hold = state.stop_lines.held_at_green[at(lane)];
        const int vehicle = state.stop_lines.lines[at(lane)].keep_clear_vehicle;
        if (!hold.is_refusal || vehicle < 0) continue;
        const int slot = slot_before_line(state, lane, vehicle);
        if (slot < 0) continue;
        const int connection = state.vehicles.next_lane[at(slot)];
        if (connection < 0 || state.plan.lane(connection).origin != lane) continue;
        if (state.signals.lights[at(state.plan.signal_group_for(lane, connection))] != Light::green) continue;
        const int exit = state.plan.lane(connection).exit;
        if (!hold.in_exit || exit < 0) {
            links.push_back({kind, vehicle, -1, connection});
            continue;
        }
        const LaneBlock& block = state.blocks[at(exit)];
        links.push_back({kind, vehicle, block.count > 0 ? state.vehicles.id[at(block.last())] : -1, exit});
    }
}

bool has_gap_agreements(const Model& model) {
    return std::any_of(model.drivers.begin(), model.drivers.end(), [](const DriverPlan& driver) {
        return !driver.is_human && driver.gap_opening == GapOpening::cooperative;
    });
}

// A vehicle has asked for a gap, and another vehicle opens it.
void add_gap_agreements(const State& state, int kind, std::vector<VehicleLink>& links) {
    for (const std::vector<GapRequest>& requests : state.gap_cooperation.requests) {
        for (const GapRequest& request : requests) {
            if (request.agreed()) links.push_back({kind, request.requester, request.opener, -1});
        }
    }
}

// The order is that of the list in the header of a recording.
constexpr std::array kLinkKinds{
    LinkKind{"refusal", has_refusals, add_refusals},
    LinkKind{"gap", has_gap_agreements, add_gap_agreements},
};

}  // namespace

std::vector<const LinkKind*> link_kinds_of(const Model& model) {
    std::vector<const LinkKind*> kinds;
    for (const LinkKind& kind : kLinkKinds) {
        if (kind.occurs(model)) kinds.push_back(&kind);
    }
    return kinds;
}

}  // namespace stopline
