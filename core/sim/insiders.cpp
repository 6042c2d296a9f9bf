// Where vehicles are: on which lanes, and who is inside intersections, past the stop line and not yet wholly on the exit lane.
#include <algorithm>

#include "sim/arrivals.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

class Search {
public:
    Search(State& state, NetworkPart& part) : state_(state), v_(state.vehicles), part_(part) {}

    void forget() {
        for (const int lane : part_.with_insiders) {
            state_.insiders[at(lane)].clear();
            const int mark = state_.plan.lane(lane).mark;
            if (mark < 0) continue;
            state_.with_insiders.clear_word_of(at(mark));
            state_.with_standing.clear_word_of(at(mark));
        }
        part_.with_insiders.clear();
    }

    // Rears that reach back from an exit; false: none.
    bool look_at_exit(int exit) {
        const LaneBlock& block = state_.blocks[at(exit)];
        const auto reaches_back = [&](int slot) { return v_.position_m[at(slot)] < v_.length_m[at(slot)]; };
        if (block.count == 0 || !reaches_back(block.last())) return false;
        for (int slot = std::max(block.first, block.stop() - 2); slot < block.stop(); ++slot) {
            if (!reaches_back(slot)) continue;
            const int from = v_.record[at(slot)].came_from;
            if (from >= 0 && state_.plan.lane(from).exit == exit) {
                add(from, slot, state_.plan.lane(from).length_m);
            }
        }
        return true;
    }

    void look_inside(int lane) {
        const LaneBlock& block = state_.blocks[at(lane)];
        for (int slot = block.first; slot < block.stop(); ++slot) add(lane, slot, 0.0);
        if (const int mark = state_.plan.lane(lane).mark; mark >= 0) state_.deciding.set(at(mark));
        state_.plan.fetch_conflicts(lane);
    }

    // Fronts past the stop line.
    void look_before(int lane) {
        const LaneBlock& block = state_.blocks[at(lane)];
        const LanePlan& plan = state_.plan.lane(lane);
        for (int slot = block.first; slot < block.stop(); ++slot) {
            if (v_.position_m[at(slot)] <= plan.stop_line_m) break;
            const int next = v_.next_lane[at(slot)];
            if (next >= 0 && state_.plan.lane(next).origin == lane) add(next, slot, -plan.length_m);
        }
    }

    void mark() {
        for (const int lane : part_.with_insiders) {
            const std::vector<Insider>& insiders = state_.insiders[at(lane)];
            part_.longest_inside = std::max(part_.longest_inside, state_.tick - insiders.front().since);
            const int mark = state_.plan.lane(lane).mark;
            if (mark < 0) continue;
            state_.with_insiders.set(at(mark));
            const auto stands = [&](const Insider& w) { return v_.speed_mps[at(w.slot)] < kAlmostStands_mps; };
            if (std::any_of(insiders.begin(), insiders.end(), stands)) state_.with_standing.set(at(mark));
        }
    }

private:
    void add(int lane, int slot, double offset_m) {
        std::vector<Insider>& insiders = state_.insiders[at(lane)];
        if (insiders.empty()) part_.with_insiders.push_back(lane);
        const double front_m = v_.position_m[at(slot)] + offset_m;
        insiders.push_back({slot, front_m, front_m - v_.length_m[at(slot)], v_.record[at(slot)].inside_since});
    }

    State& state_;
    const VehicleArrays& v_;
    NetworkPart& part_;
};

}  // namespace

void find_occupied_lanes(State& state, NetworkPart& part) {
    for (NumberList* list : {&part.occupied, &part.awake, &part.awake_before, &part.awake_inside}) {
        list->start(part.lanes.size());
    }
    part.present = 0;
    part.may_be_occupied.keep_if([&](std::size_t place) {
        const int lane = part.lanes[place];
        const int count = state.blocks[at(lane)].count;
        if (count == 0) return false;
        part.present += count;
        part.occupied.add(lane);
        int& sleeps = state.sleeps_until_green_of[at(lane)];
        if (sleeps >= 0 && state.lights[at(sleeps)] == Light::green) sleeps = -1;
        const bool awake = sleeps < 0;
        const LanePlan& plan = state.plan.lane(lane);
        part.awake.add_if(awake, lane);
        part.awake_before.add_if(awake && plan.signal_group >= 0, lane);
        part.awake_inside.add_if(awake && plan.origin >= 0, lane);
        return true;
    });
}

void find_insiders(State& state, NetworkPart& part) {
    Search search(state, part);
    search.forget();
    // The order makes that each lane's insiders are listed from the front.
    part.may_reach_back.keep_if([&](std::size_t place) {
        fetch_on(state, part.fetching);
        return search.look_at_exit(part.exits[place]);
    });
    for (const int lane : part.awake_inside) search.look_inside(lane);
    for (const int lane : part.awake_before) search.look_before(lane);
    search.mark();
}

}  // namespace stopline
