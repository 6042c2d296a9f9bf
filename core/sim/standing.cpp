// Who stands, and what each of them waits for: what hindrance is made out from (hindrance.cpp). For each part by itself.
#include <algorithm>
#include <cstddef>

#include "sim/phases.h"

namespace stopline {

namespace {

constexpr double kCloseBehind_m = 15.0;  // who stands further behind has not come up yet, or is about to set out
constexpr double kSeen_m = 30.0;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

class Waits {
public:
    Waits(const Model& model, State& state) : model_(model), state_(state), v_(state.vehicles), w_(state.watch) {}

    void find(int slot) {
        const int lane = w_.lane[at(slot)];
        look_at(slot, lane);
        if (slot != state_.stop_slot[at(lane)] && slot != state_.blocks[at(lane)].first) return;
        KeptOutLast& last = w_.kept_out[at(lane)];
        int& waits_for = w_.waits_for[at(slot)];
        if (w_.edge[at(slot)] == Cause::signal) {
            follow(slot, lane);  // it may stand behind one that is over the line already
            w_.edge[at(slot)] = Cause::signal;
            if (waits_for < 0) waits_for = still_stands(last, v_.id[at(slot)]);
        } else if (waits_for >= 0) {
            last = {v_.id[at(slot)], v_.id[at(waits_for)], w_.lane[at(waits_for)], static_cast<int>(state_.tick)};
        }
    }

private:
    bool stands(int slot) const { return v_.speed_mps[at(slot)] < kStands_mps; }

    // Be it that who it waits for only crawls.
    void look_at(int slot, int lane) {
        const Hold* const hold = state_.has_holds[at(lane)] != 0 ? state_.holds[at(lane)].of(slot) : nullptr;
        if (hold != nullptr) {
            if (hold->blocker < 0) return set(slot, -1, Cause::wrong_lane);
            const bool standing = stands(hold->blocker);
            const bool blocked = !hold->priority && standing;
            return set(slot, standing ? hold->blocker : -1, blocked ? Cause::junction_blocking : Cause::priority);
        }
        if (slot == state_.stop_slot[at(lane)]) {
            const KeptOut& kept_out = state_.kept_out[at(lane)];
            if (kept_out.blocker < 0) return set(slot, -1, Cause::signal);
            return set(slot, kept_out.blocker, kept_out.in_exit ? full_exit(slot) : Cause::junction_blocking);
        }
        follow(slot, lane);
    }

    void set(int slot, int waits_for, Cause edge) {
        w_.waits_for[at(slot)] = waits_for;
        w_.edge[at(slot)] = edge;
    }

    void follow(int slot, int lane) {
        const LaneBlock& block = state_.blocks[at(lane)];
        int ahead = slot - 1;
        double gap_m = v_.position_m[at(ahead)] - static_cast<double>(v_.length_m[at(ahead)]) - v_.position_m[at(slot)];
        if (slot == block.first) {
            const Ahead seen = vehicle_ahead(state_, lane, slot, kSeen_m);
            ahead = seen.slot;
            if (ahead >= 0) {
                gap_m = seen.start_m + v_.position_m[at(ahead)] - static_cast<double>(v_.length_m[at(ahead)]) -
                        v_.position_m[at(slot)];
            }
        }
        if (ahead < 0 || !stands(ahead) || gap_m > kCloseBehind_m) return set(slot, -1, Cause::none);
        set(slot, ahead, leaves_intersection(lane, w_.lane[at(ahead)]) ? full_exit(slot) : Cause::none);
    }

    // The slot of who kept a vehicle out, if it has stood since; else -1.
    int still_stands(const KeptOutLast& last, int vehicle) const {
        if (last.vehicle != vehicle) return -1;
        const LaneBlock& block = state_.blocks[at(last.blocker_lane)];
        for (int slot = block.first; slot < block.stop(); ++slot) {
            if (v_.id[at(slot)] == last.blocker) return v_.stands_since[at(slot)] <= last.seen ? slot : -1;
        }
        return -1;
    }

    // The one ahead is behind the intersection, on its way to the next; this one is before or in it.
    bool leaves_intersection(int lane, int ahead) const {
        if (lane == ahead) return false;
        const std::vector<int>& ways = model_.leads_to[at(ahead)];
        return std::any_of(ways.begin(), ways.end(),
                           [&](int inside) { return inside == lane || model_.graph.lanes[at(inside)].origin == lane; });
    }

    Cause full_exit(int slot) const {
        const int lane = w_.lane[at(slot)];
        const bool within = model_.graph.lanes[at(lane)].origin >= 0;
        const int way = within ? lane : v_.next_lane[at(slot)];
        const bool turns =
            way >= 0 && model_.graph.lanes[at(way)].turn != Turn::straight;  // -1: its lane does not serve its way
        return turns ? Cause::turn_blocking : Cause::spillback;
    }

    const Model& model_;
    const State& state_;
    const VehicleArrays& v_;
    HindranceWatch& w_;
};

}  // namespace

void note_standing(State& state, NetworkPart& part) {
    HindranceWatch& w = state.watch;
    const auto now = static_cast<int>(state.tick);
    const double* const speed_mps = state.vehicles.speed_mps.data();
    const int* const id = state.vehicles.id.data();
    int* const since = state.vehicles.stands_since.data();
    part.stands_since = now;
    part.standing.start(static_cast<std::size_t>(part.present));
    for (const int lane : part.occupied) {
        const LaneBlock& block = state.blocks[at(lane)];
        std::fill_n(w.lane.begin() + block.first, block.count, lane);
        std::copy_n(id + block.first, block.count, w.vehicle.begin() + block.first);
        for (int slot = block.first; slot < block.stop(); ++slot) {
            if (speed_mps[slot] >= kStands_mps) {
                since[slot] = now;
                continue;
            }
            w.mark[at(slot)] = 0;
            w.cause[at(slot)] = Cause::none;
            part.stands_since = std::min(part.stands_since, since[slot]);
            part.standing.add(slot);
        }
    }
}

void find_waits(const Model& model, State& state, const NetworkPart& part) {
    Waits waits(model, state);
    for (const int slot : part.standing) waits.find(slot);
}

}  // namespace stopline
