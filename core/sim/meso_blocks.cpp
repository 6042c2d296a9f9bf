// Which vehicles of the mesoscale mode have to be moved in a step, and what is imposed on whom.
//
// Vehicles that stand, one behind the other, are left out: nothing that they react to changes. A lane whose first vehicle rests before a
// red light sleeps: there is nothing to decide on it.
#include <algorithm>
#include <bit>

#include "sim/meso_dynamics.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Brings up to date who rests on a lane: those at its head that set out, and those that came to stand behind.
void find_resting(const VehicleArrays& v, const LaneBlock& block, std::int64_t tick, Resting& resting) {
    const auto rests = [&](int place) {
        const std::size_t i = at(block.first + place);
        return v.speed_mps[i] == 0.0 && v.acceleration_mps2[i] == 0.0F;
    };
    while (resting.from < resting.to && !rests(resting.from)) ++resting.from;
    // Of those that were told, one may have closed up although who is ahead of it did not set out.
    for (int place = resting.from + 1; place < std::min(resting.told, resting.to); ++place) {
        if (!rests(place)) resting.to = place;
    }
    resting.told = 0;
    if (resting.from == resting.to) resting.from = resting.to = 0;
    if (resting.imposed >= tick - 1) {
        resting.to = resting.from;
        return;
    }
    while (resting.to < block.count && rests(resting.to)) ++resting.to;
}

// A queue of vehicles that keep a constant distance hears of a start as fast as V2V carries it from each to the next, further than
// one vehicle in a step: those that will set out tell so before they move. A time gap holds back who keeps it, and ends the chain.
// They hear of it when the vehicles move: until then vehicles of other lanes look at their state. Returns how many were told.
int relay_start(const Model& model, const VehicleArrays& v, const LaneBlock& block, Resting& resting,
                std::vector<ToldToStart>& to) {
    constexpr double kClosedUp_m = 0.5;  // no further behind than that: who has room to close sets out later
    if (resting.from == 0) return 0;
    const std::size_t before = at(block.first + resting.from - 1);
    const float told_mps2 = v.acceleration_mps2[before];
    if (told_mps2 <= 0.0F || v.speed_mps[before] == 0.0) return 0;
    int told = 0;
    while (told < model.relayed && resting.from + told < resting.to) {
        const std::size_t i = at(block.first + resting.from + told);
        const Krauss& krauss = model.krauss[at(v.policy[i])];
        const double gap_m = v.position_m[i - 1] - static_cast<double>(v.length_m[i - 1]) - v.position_m[i];
        if (!krauss.constant_distance || gap_m > krauss.equilibrium_gap_m(0.0) + kClosedUp_m) break;
        to.push_back({static_cast<int>(i), told_mps2});
        ++told;
    }
    if (told > 0) resting.told = resting.from + told + 1;
    return told;
}

const Holds kNobodyHeld;
constexpr double kRounding_m = 1e-3;

class Collector {
public:
    Collector(const Model& model, int shift, State& state, NetworkPart& part, int lane)
        : model_(model),
          shift_(shift),
          state_(state),
          v_(state.vehicles),
          part_(part),
          lane_(lane),
          block_(state.blocks[at(lane)]),
          plan_(state.plan.lane(lane)),
          stop_slot_(state.stop_slot[at(lane)]),
          holds_(state.has_holds[at(lane)] != 0 ? state.holds[at(lane)] : kNobodyHeld) {}

    void collect() {
        const int first = block_.first;
        Resting& resting = state_.resting[at(lane_)];
        int& sleeps = state_.sleeps_until_green_of[at(lane_)];
        if (sleeps >= 0) {
            adapt();
            wait_behind_first();
            if (resting.to == block_.count) return;
            find_resting(v_, block_, state_.tick, resting);
            return add(first + resting.to, block_.stop());
        }
        if (is_near_end()) part_.near_end.add(lane_);
        v_.imposed_mps[at(first)] = kAnySpeed_mps;  // if the lane has slept
        adapt();
        if (last_imposed() > first + resting.from) resting.imposed = state_.tick;
        find_resting(v_, block_, state_.tick, resting);
        const bool kept = last_imposed() >= first + resting.from;
        const int told = kept ? 0 : relay_start(model_, v_, block_, resting, part_.told);
        if (model_.scalar_kernels) {
            impose_all();
            return add(first, block_.stop());
        }
        if (resting.from == 0 && resting.to > 0 && rests_before_line()) {
            sleeps = state_.plan.light_before(lane_, v_.next_lane[at(first)]);
            v_.imposed_mps[at(first)] = 0.0;  // others in its block are moved
            return add(first + resting.to, block_.stop());
        }
        impose_all();
        if (resting.to - resting.from <= 1) return add(first, block_.stop());
        add(first, std::min(first + resting.from + told + 1, block_.stop()));
        add(first + resting.to, block_.stop());
    }

private:
    // The last slot that has to stop for something.
    int last_imposed() const {
        return std::max(stop_slot_, holds_.count == 0 ? -1 : holds_.each[at(holds_.count - 1)].slot);
    }

    // Nobody drives faster than its lane allows.
    bool is_near_end() const {
        const double end_m = plan_.signal_group < 0 ? plan_.length_m : std::min(plan_.length_m, plan_.stop_line_m);
        const double further_m = state_.plan.driven_mps(lane_) * model_.step_s;
        return v_.position_m[at(block_.first)] + further_m + kRounding_m >= end_m;
    }

    void adapt() {
        if (part_.adapting.empty()) return;
        const double gently_mps = Adapting::kBraking_mps2 * model_.step_s;
        for (const Adapting& adapting : state_.adapting[at(lane_)]) {
            const double speed_mps = v_.speed_mps[at(adapting.slot)];
            // What keeps the first vehicle of a lane that sleeps at rest stays.
            if (speed_mps > 0.0) impose(adapting.slot, std::max(adapting.most_mps, speed_mps - gently_mps));
        }
    }

    double room_to_line_m(int slot) const {
        return plan_.stop_line_m - model_.driver.stop.margin_m - v_.position_m[at(slot)];
    }

    // The first vehicle is kept where it is by its light alone.
    bool rests_before_line() const {
        const int first = block_.first;
        if (stop_slot_ != first || state_.stop_lines[at(lane_)].stopper != v_.id[at(first)]) return false;
        if (holds_.count > 0 || v_.position_m[at(first)] > plan_.stop_line_m) return false;
        return at_rest(stopping_speed_mps(model_, v_, first, room_to_line_m(first))) == 0.0;
    }

    // Those that wait to change lanes, behind a first vehicle that keeps what it has.
    void wait_behind_first() {
        for (int k = 0; k < holds_.count; ++k) {
            const Hold& hold = holds_.each[at(k)];
            if (hold.slot == block_.first) continue;
            impose(hold.slot, stopping_speed_mps(model_, v_, hold.slot, hold.place_m - v_.position_m[at(hold.slot)]));
            state_.resting[at(lane_)].imposed = state_.tick;
        }
    }

    void impose_all() {
        if (stop_slot_ >= 0) impose(stop_slot_, stopping_speed_mps(model_, v_, stop_slot_, room_to_line_m(stop_slot_)));
        for (int k = 0; k < holds_.count; ++k) {
            const Hold& hold = holds_.each[at(k)];
            const double room_m = hold.place_m - v_.position_m[at(hold.slot)];
            impose(hold.slot, stopping_speed_mps(model_, v_, hold.slot, room_m));
        }
        const int first = block_.first;
        if (v_.record[at(first)].predecessor < 0) {
            impose(first, leading_speed_mps(model_, v_.speed_mps[at(first)], v_.limit_mps[at(first)]));
        }
    }

    void impose(int slot, double asks_mps) {
        v_.imposed_mps[at(slot)] = std::min(v_.imposed_mps[at(slot)], asks_mps);
        part_.imposed.push_back(slot);
    }

    // Lanes are in the order of their slots.
    void add(int from, int to) {
        if (from == to) return;
        part_.blocks.add_all(std::max(from >> shift_, part_.blocks.last_or(-1) + 1), ((to - 1) >> shift_) + 1);
    }

    const Model& model_;
    int shift_;  // slots of a block are a power of two: this one
    State& state_;
    VehicleArrays& v_;
    NetworkPart& part_;
    int lane_;
    const LaneBlock& block_;
    const LanePlan& plan_;
    int stop_slot_;
    const Holds& holds_;
};

}  // namespace

// What is needed for it is still in the cache when the part has been decided.
void collect_moves(const Model& model, State& state, NetworkPart& part) {
    // Blocks of a lane are as many as its vehicles, and a little more: those of other lanes are in them too.
    constexpr std::size_t kMostAdded = 4;
    const int shift = std::countr_zero(static_cast<unsigned>(meso_kernels(model.scalar_kernels).size));
    part.near_end.start(part.occupied.size());
    part.blocks.start(static_cast<std::size_t>(part.present) + kMostAdded * part.occupied.size());
    part.told.clear();
    for (const int lane : part.occupied) {
        fetch_on(state, part.fetching);
        Collector(model, shift, state, part, lane).collect();
    }
}

}  // namespace stopline
