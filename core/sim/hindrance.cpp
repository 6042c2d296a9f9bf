#include "sim/hindrance.h"

#include <algorithm>
#include <cstddef>

#include "sim/phases.h"

namespace stopline {

namespace {

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

    void gather() {
        w_.standing.clear();
        int since = now_;
        for (const NetworkPart& part : state_.parts) {
            w_.standing.insert(w_.standing.end(), part.standing.begin(), part.standing.end());
            since = std::min(since, part.stands_since);
        }
        double& longest_s = state_.hindrance.longest_stand_s;
        longest_s = std::max(longest_s, model_.time_s(now_ - since));
    }
    void attribute() {
        resolve();
        count();
        close_episodes();
        close_gridlocks();
    }

private:
    bool stands(int slot) const { return v_.speed_mps[at(slot)] < kStands_mps; }
    bool stands_long(int slot) const {
        return model_.rules.long_wait_ticks > 0 && now_ - v_.stands_since[at(slot)] >= model_.rules.long_wait_ticks;
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
            if (slot >= 0 && stands(slot) && w_.mark[at(slot)] == walk) note_circle(slot);
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
        if (w_.cause[at(slot)] == Cause::none) w_.cause[at(slot)] = Cause::start;
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
        if (const int number = goes_on_from(found); number >= 0) {
            found.from_s = all[at(number)].from_s;
            all[at(number)] = std::move(found);
            return;
        }
        w_.open_gridlocks.push_back(static_cast<int>(all.size()));
        all.push_back(std::move(found));
    }

    // A circle that was there before, and not yet in this look, of which somebody is still in this one; -1: none.
    int goes_on_from(const Gridlock& found) const {
        std::vector<int> members = found.vehicles;
        std::sort(members.begin(), members.end());
        for (const int number : w_.open_gridlocks) {
            const Gridlock& known = state_.hindrance.gridlocks[at(number)];
            if (known.to_s == now_s_) continue;
            const auto is_member = [&](int id) { return std::binary_search(members.begin(), members.end(), id); };
            if (std::any_of(known.vehicles.begin(), known.vehicles.end(), is_member)) return number;
        }
        return -1;
    }

    // Time lost to each cause, in all and in the episode of the lane that it began on.
    void count() {
        const double each_s = model_.time_s(model_.rules.watch_ticks);
        std::array<int, kCauses> vehicles{};
        for (const int slot : w_.standing) {
            const Cause cause = w_.cause[at(slot)];
            ++vehicles[static_cast<std::size_t>(cause)];
            if (is_outside(slot)) state_.hindrance.lost_outside_s += each_s;
            if (!hinders(cause) && !stands_long(slot)) continue;
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

    bool is_outside(int slot) const {
        const std::vector<double>& begins_m = model_.area_begins_m;
        return !begins_m.empty() && v_.position_m[at(slot)] < begins_m[at(w_.lane[at(slot)])];
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

    // When it has not been seen for a cycle.
    void close_gridlocks() {
        const double latest_s = now_s_ - model_.time_s(model_.rules.gridlock_ticks);
        std::erase_if(w_.open_gridlocks,
                      [&](int number) { return state_.hindrance.gridlocks[at(number)].to_s < latest_s; });
    }

    const Model& model_;
    State& state_;
    VehicleArrays& v_;
    HindranceWatch& w_;
    int now_;  // tick
    double now_s_;
};

}  // namespace

bool looks_for_hindrance(const Model& model, const State& state) {
    return model.rules.watches() && state.tick % model.rules.watch_ticks == 0;
}

void prepare_watch(const Model& model, State& state) {
    HindranceWatch& w = state.watch;
    const auto slots = at(state.vehicles.slots);
    if (w.mark.size() != slots) {
        w.waits_for.resize(slots), w.edge.resize(slots), w.cause.resize(slots), w.owner.resize(slots);
        w.lane.resize(slots), w.vehicle.resize(slots), w.mark.resize(slots);
    }
    // Episodes go on when vehicles get other slots.
    w.kept_out.resize(model.graph.lanes.size());
    w.open.resize(model.graph.lanes.size() * kCauseNames.size(), -1);
}

void attribute_hindrance(const Model& model, State& state) {
    Watch watch(model, state);
    watch.gather();
    watch.attribute();
}

void watch_hindrance(const Model& model, State& state) {
    prepare_watch(model, state);
    for (NetworkPart& part : state.parts) note_standing(state, part);
    for (NetworkPart& part : state.parts) find_waits(model, state, part);
    attribute_hindrance(model, state);
}

}  // namespace stopline
