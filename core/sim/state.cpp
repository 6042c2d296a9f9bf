#include "sim/state.h"

#include <algorithm>

#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace

Rows rows_at(const DelayLine& line, std::int64_t tick, int slots) {
    const std::int64_t present = tick % line.rows;
    const auto row = [&](int age) {  // at most `rows`
        const std::int64_t wrapped = present >= age ? present - age : present - age + line.rows;
        return static_cast<std::size_t>(wrapped) * static_cast<std::size_t>(slots);
    };
    return {row(0), row(line.steps), row(line.steps + 1), 1.0 - line.share, line.share};
}

void Holds::add(const Hold& hold) {
    int place = count;
    while (place > 0 && each[static_cast<std::size_t>(place - 1)].slot > hold.slot) --place;
    if (place == kMost) return;
    count = std::min(count + 1, kMost);
    for (int k = count - 1; k > place; --k) each[static_cast<std::size_t>(k)] = each[static_cast<std::size_t>(k - 1)];
    each[static_cast<std::size_t>(place)] = hold;
}

void hold(State& state, NetworkPart& part, int lane, const Hold& hold) {
    if (state.has_holds[at(lane)] == 0) part.holding.push_back(lane);
    state.has_holds[at(lane)] = 1;
    state.holds[at(lane)].add(hold);
}

namespace {

std::vector<NetworkPart> make_parts(const Model& model, const State& state, int threads) {
    const std::vector<int>& order = state.plan.order();
    const auto metres_of = [&](int lane) { return state.plan.lane(lane).length_m; };
    double metres = 0.0;
    double longest_m = 0.0;
    for (const int lane : order) metres += metres_of(lane), longest_m = std::max(longest_m, metres_of(lane));
    // What is decided for an intersection reads what was decided before: some 20 kB of lanes and vehicles each, and those of the next parts
    // come into the cache meanwhile.
    const int intersections_together = model.meso ? 8 : 16;
    const int count = std::max(threads, state.plan.intersections() / intersections_together);
    std::vector<std::vector<int>> detectors(order.size());
    for (std::size_t k = 0; k < model.detectors.size(); ++k) {
        if (model.detectors[k].lane >= 0) detectors[at(model.detectors[k].lane)].push_back(static_cast<int>(k));
    }
    std::vector<bool> is_exit(order.size(), false);
    std::vector<NetworkPart> parts(1);
    double done = 0.0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        const int lane = order[k];
        const bool new_intersection =
            k > 0 && state.plan.intersection_of(lane) != state.plan.intersection_of(order[k - 1]);
        const double share = metres / count * static_cast<double>(parts.size());
        if (new_intersection && done >= share && static_cast<int>(parts.size()) < count) parts.emplace_back();
        done += metres_of(lane);
        NetworkPart& part = parts.back();
        part.lanes.push_back(lane);
        part.detectors.insert(part.detectors.end(), detectors[at(lane)].begin(), detectors[at(lane)].end());
        if (state.plan.lane(lane).origin < 0 || model.graph.conflicts_of(lane).empty()) continue;
        const std::size_t word = at(state.plan.lane(lane).mark) / Marks::kBits;
        if (part.inside.empty()) part.first_word = word;
        part.end_word = word + 1;
        part.inside.push_back(lane);
        const int exit = state.plan.lane(lane).exit;
        if (!is_exit[at(exit)]) part.exits.push_back(exit);
        is_exit[at(exit)] = true;
    }
    // Lanes longer than that by vehicle: a group is complete with its first lane that makes it so.
    const int together =
        NetworkPart::kVehiclesTogether + static_cast<int>(longest_m / shortest_vehicle_m(model)) + 2 * kSimdWidth;
    for (NetworkPart& part : parts) {
        part.full_group.resize(model.meso ? 0 : together);
    }
    return parts;
}

// Where lanes are listed in the parts.
void list_lanes(State& state) {
    state.listed.resize(state.plan.order().size());
    for (std::size_t number = 0; number < state.parts.size(); ++number) {
        NetworkPart& part = state.parts[number];
        part.may_be_occupied.resize(part.lanes.size());
        part.may_reach_back.resize(part.exits.size());
        for (std::size_t place = 0; place < part.lanes.size(); ++place) {
            state.listed[at(part.lanes[place])].part = number;
            state.listed[at(part.lanes[place])].place = place;
        }
        for (std::size_t exit = 0; exit < part.exits.size(); ++exit) {
            state.listed[at(part.exits[exit])].exits_of = static_cast<int>(number);
            state.listed[at(part.exits[exit])].exit = exit;
        }
    }
}

}  // namespace

State make_state(const Model& model, int threads) {
    State state(model);
    state.parts = make_parts(model, state, threads);
    list_lanes(state);
    lay_out_blocks(model, state);
    const std::size_t lanes = model.graph.lanes.size();
    state.lights.assign(model.signals.size(), Light::red);
    state.stop_lines.resize(lanes);
    state.stop_slot.assign(lanes, -1);
    state.holds.resize(lanes);
    state.has_holds.assign(lanes, 0);
    state.adapting.resize(lanes);
    state.turned.resize(model.graph.approaches.size());
    state.drawn.resize(model.graph.approaches.size());
    if (!model.demand.trips.empty()) state.waiting_trips.resize(model.graph.approaches.size());
    state.kept_out.resize(lanes);
    state.resting.resize(lanes);
    state.sleeps_until_green_of.assign(lanes, -1);
    state.exit_rooms.resize(lanes);
    state.insiders.resize(lanes);
    state.coming.resize(lanes);
    for (Marks* marks : {&state.with_insiders, &state.with_standing, &state.deciding}) {
        marks->resize(state.plan.marks());
    }
    const double shortest_m = shortest_vehicle_m(model);
    for (const NetworkPart& part : state.parts) {
        for (const int lane : part.inside) {
            constexpr std::size_t kBeforeAndBehind = 3;
            const double inside = state.plan.lane(lane).length_m / shortest_m;
            state.insiders[at(lane)].reserve(static_cast<std::size_t>(inside) + kBeforeAndBehind);
            state.coming[at(lane)].reserve(16);
        }
    }
    state.detectors_of.resize(lanes);
    state.upstream.assign(model.detectors.size(), 0);
    for (std::size_t k = 0; k < model.detectors.size(); ++k) {
        if (model.detectors[k].lane < 0) continue;
        state.detectors_of[at(model.detectors[k].lane)].push_back(static_cast<int>(k));
    }
    state.inlets.resize(model.demand.inlets.size());
    state.inlet_of.assign(lanes, -1);
    for (std::size_t k = 0; k < model.demand.inlets.size(); ++k) {
        state.inlet_of[at(model.demand.inlets[k].lane)] = static_cast<int>(k);
        state.open_inlets.push_back(static_cast<int>(k));
    }
    std::size_t expected = 0;
    for (const DemandPlan::Inlet& inlet : model.demand.inlets) {
        expected += static_cast<std::size_t>(std::min<std::int64_t>(inlet.vehicles, 2000));
    }
    if (model.meso) {
        for (NetworkPart& part : state.parts) list_lines(model, state, part);
    }
    if (model.records_all) state.passages.reserve(4 * expected);
    return state;
}

}  // namespace stopline
