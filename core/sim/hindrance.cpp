#include "sim/hindrance.h"

#include <algorithm>
#include <cstddef>

#include "sim/phases.h"

namespace stopline {

namespace {

constexpr double kCloseBehind_m = 15.0;  // who stands further behind has not come up yet, or is about to set out
constexpr double kSeen_m = 30.0;
constexpr int kCauses = static_cast<int>(kCauseNames.size());

std::size_t at(int index) { return static_cast<std::size_t>(index); }

class Watch {
public:
    Watch(const Model& model, State& state)
        : model_(model),
          state_(state),
          v_(state.vehicles),
          w_(state.watch),
          now_(static_cast<int>(state.tick)),
          now_s_(model.time_s(state.tick)) {}

    void look() {
        prepare();
        for (const NetworkPart& part : state_.parts) {
            for (const int lane : part.occupied) note_standing(lane);
        }
        for (const int slot : w_.standing) wait(slot);
        resolve();
        count();
        close_episodes();
        close_gridlocks();
    }

private:
    void prepare() {
        const auto slots = at(v_.slots);
        if (w_.mark.size() != slots) {
            w_.waits_for.resize(slots), w_.edge.resize(slots), w_.cause.resize(slots), w_.owner.resize(slots);
            w_.lane.resize(slots), w_.vehicle.resize(slots), w_.mark.resize(slots);
        }
        // Episodes go on when vehicles get other slots.
        w_.open.resize(model_.graph.lanes.size() * kCauseNames.size(), -1);
        w_.standing.clear();
    }

    void note_standing(int lane) {
        const LaneBlock& block = state_.blocks[at(lane)];
        std::fill_n(w_.lane.begin() + block.first, block.count, lane);
        int since = now_;
        for (int slot = block.first; slot < block.stop(); ++slot) {
            if (!stands(slot)) {
                v_.stands_since[at(slot)] = now_;
                continue;
            }
            w_.mark[at(slot)] = 0;
            w_.cause[at(slot)] = Cause::none;
            w_.vehicle[at(slot)] = v_.id[at(slot)];
            since = std::min(since, v_.stands_since[at(slot)]);
            w_.standing.push_back(slot);
        }
        state_.hindrance.longest_stand_s =
            std::max(state_.hindrance.longest_stand_s, model_.time_s(state_.tick - since));
    }

    bool stands(int slot) const { return v_.speed_mps[at(slot)] < kStands_mps; }

    void set(int slot, int waits_for, Cause edge) {
        if (waits_for >= 0) w_.vehicle[at(waits_for)] = v_.id[at(waits_for)];
        w_.waits_for[at(slot)] = waits_for;
        w_.edge[at(slot)] = edge;
    }

    // What one that stands waits for, be it that this one only crawls.
    void wait(int slot) {
        const int lane = w_.lane[at(slot)];
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
        const Turn turn = model_.graph.lanes[at(within ? lane : v_.next_lane[at(slot)])].turn;
        return turn == Turn::straight ? Cause::spillback : Cause::turn_blocking;
    }

    void resolve() {
        int walk = 0;
        for (const int start : w_.standing) {
            if (w_.mark[at(start)] != 0) continue;
            ++walk;
            if (const int ahead = w_.waits_for[at(start)]; ahead < 0 || !stands(ahead) || w_.mark[at(ahead)] != 0) {
                w_.mark[at(start)] = walk;  // settled, who it waits for
                settle(start);
                continue;
            }
            w_.walk.clear();
            int slot = start;
            while (slot >= 0 && stands(slot) && w_.mark[at(slot)] == 0) {
                w_.mark[at(slot)] = walk;
                w_.walk.push_back(slot);
                slot = w_.waits_for[at(slot)];
            }
            if (slot >= 0 && w_.mark[at(slot)] == walk) note_circle(slot);
            std::reverse(w_.walk.begin(), w_.walk.end());
            for (const int back : w_.walk) settle(back);
        }
    }

    // From the vehicle that waits to the causes of those it waits for, which are settled.
    void settle(int slot) {
        if (w_.cause[at(slot)] == Cause::gridlock) return;
        const int ahead = w_.waits_for[at(slot)];
        const Cause edge = w_.edge[at(slot)];
        const Cause beyond = ahead >= 0 && stands(ahead) ? w_.cause[at(ahead)] : Cause::none;
        w_.owner[at(slot)] = slot;
        if (edge == Cause::none && ahead >= 0) w_.owner[at(slot)] = w_.owner[at(ahead)];
        w_.cause[at(slot)] = beyond == Cause::gridlock ? beyond : edge == Cause::none ? beyond : edge;
    }

    void note_circle(int start) {
        std::vector<int> slots;
        int slot = start;
        do {
            slots.push_back(slot);
            w_.cause[at(slot)] = Cause::gridlock;
            w_.owner[at(slot)] = slot;
            slot = w_.waits_for[at(slot)];
        } while (slot != start);
        const auto lowest =
            std::min_element(slots.begin(), slots.end(), [&](int a, int b) { return v_.id[at(a)] < v_.id[at(b)]; });
        std::rotate(slots.begin(), lowest, slots.end());
        Gridlock found{now_s_, now_s_, {}, {}};
        for (const int member : slots) {
            found.vehicles.push_back(v_.id[at(member)]);
            found.lanes.push_back(w_.lane[at(member)]);
        }
        std::vector<Gridlock>& all = state_.hindrance.gridlocks;
        for (const int number : w_.open_gridlocks) {
            Gridlock& known = all[at(number)];
            if (known.vehicles[0] != found.vehicles[0]) continue;
            found.from_s = known.from_s;
            known = std::move(found);
            return;
        }
        w_.open_gridlocks.push_back(static_cast<int>(all.size()));
        all.push_back(std::move(found));
    }

    // Time lost to each cause, in all and in the episode of the lane that it began on.
    void count() {
        const double each_s = model_.time_s(model_.rules.watch_ticks);
        std::array<int, kCauses> vehicles{};
        for (const int slot : w_.standing) {
            const Cause cause = w_.cause[at(slot)];
            ++vehicles[static_cast<std::size_t>(cause)];
            if (cause < Cause::junction_blocking) continue;
            HindranceEpisode& episode = episode_of(w_.owner[at(slot)], cause);
            if (episode.to_s < now_s_) {
                episode.to_s = now_s_;
                episode.last = 0;
            }
            episode.lost_s += each_s;
            episode.most = std::max(episode.most, ++episode.last);
        }
        for (std::size_t cause = 0; cause < vehicles.size(); ++cause) {
            state_.hindrance.lost_s[cause] += each_s * vehicles[cause];
        }
    }

    HindranceEpisode& episode_of(int owner, Cause cause) {
        std::vector<HindranceEpisode>& all = state_.hindrance.episodes;
        const int lane = w_.lane[at(owner)];
        const int key = lane * kCauses + static_cast<int>(cause);
        int& number = w_.open[at(key)];
        if (number < 0) {
            number = static_cast<int>(all.size());
            w_.open_episodes.push_back(key);
            const int blocker = w_.waits_for[at(owner)];
            all.push_back({cause, lane, v_.id[at(owner)], blocker < 0 ? -1 : v_.id[at(blocker)],
                           blocker < 0 ? -1 : w_.lane[at(blocker)], now_s_, now_s_ - 1.0, 0, 0, 0.0});
        }
        return all[at(number)];
    }

    // Those that were not seen this time are over.
    void close_episodes() {
        std::erase_if(w_.open_episodes, [&](int key) {
            int& number = w_.open[at(key)];
            const bool over = state_.hindrance.episodes[at(number)].to_s < now_s_;
            if (over) number = -1;
            return over;
        });
    }

    void close_gridlocks() {
        std::erase_if(w_.open_gridlocks,
                      [&](int number) { return state_.hindrance.gridlocks[at(number)].to_s < now_s_; });
    }

    const Model& model_;
    State& state_;
    VehicleArrays& v_;
    HindranceWatch& w_;
    int now_;  // tick
    double now_s_;
};

}  // namespace

void watch_hindrance(const Model& model, State& state) {
    if (!model.rules.watches() || state.tick % model.rules.watch_ticks != 0) return;
    Watch(model, state).look();
}

}  // namespace stopline
