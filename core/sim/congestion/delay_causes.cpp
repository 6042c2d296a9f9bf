#include "sim/congestion/delay_causes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/congestion/wait_reasons.h"
#include "sim/state/delay_log.h"

namespace stopline {

namespace {

constexpr int kDelayCauses = static_cast<int>(kDelayCauseNames.size());

class DelayAttribution {
public:
    DelayAttribution(const Model& model, const State& state, CongestionState& congestion)
        : model_(model),
          state_(state),
          v_(state.vehicles),
          log_(congestion.delays),
          w_(congestion.watch),
          now_(static_cast<int>(state.tick)),
          now_s_(model.time_s(state.tick)) {}

    void run() {
        gather_stopped_vehicles();
        find_causes();
        add_delays();
        close_episodes();
        close_gridlocks();
    }

private:
    void gather_stopped_vehicles() {
        w_.stopped_slots.clear();
        int earliest_tick = now_;
        for (const Partition& part : state_.partitions) {
            w_.stopped_slots.insert(w_.stopped_slots.end(), part.stopped_slots.begin(), part.stopped_slots.end());
            earliest_tick = std::min(earliest_tick, part.earliest_stop_tick);
        }
        log_.longest_stop_s = std::max(log_.longest_stop_s, model_.time_s(now_ - earliest_tick));
    }

    bool is_stopped(int slot) const { return v_.speed_mps[at(slot)] < kStoppedSpeed_mps; }
    bool is_stopped_for_long(int slot) const {
        return model_.rules.long_wait_ticks > 0 && now_ - v_.stopped_since[at(slot)] >= model_.rules.long_wait_ticks;
    }

    // Follows each chain of waiting vehicles: from a stopped vehicle to its blocker, then to the blocker of the
    // blocker, and so on. Then sets the causes in the reverse order, because the cause of a vehicle can depend on the
    // cause of its blocker.
    void find_causes() {
        int traversal = 0;
        for (const int start : w_.stopped_slots) {
            if (w_.traversal[at(start)] != 0) continue;
            ++traversal;
            const int blocker = w_.waits_for[at(start)];
            if (blocker < 0 || !is_stopped(blocker) || w_.traversal[at(blocker)] != 0) {
                w_.traversal[at(start)] = traversal;
                set_cause(start);
                continue;
            }
            w_.path.clear();
            int slot = start;
            while (slot >= 0 && is_stopped(slot) && w_.traversal[at(slot)] == 0) {
                w_.traversal[at(slot)] = traversal;
                w_.path.push_back(slot);
                slot = w_.waits_for[at(slot)];
            }
            if (slot >= 0 && is_stopped(slot) && w_.traversal[at(slot)] == traversal) record_gridlock(slot);
            std::reverse(w_.path.begin(), w_.path.end());
            for (const int waiting : w_.path) set_cause(waiting);
        }
    }

    // Sets the cause to which the delay of a vehicle is attributed. This is the cause that stops the vehicle itself
    // (DelayWatch::direct_cause), unless there is none or the cause of the blocker is a gridlock. In these two cases
    // the vehicle gets the cause of its blocker, or queue_discharge if no stopped vehicle blocks it. The cause of a
    // stopped blocker must have been set before.
    void set_cause(int slot) {
        if (w_.cause[at(slot)] == DelayCause::gridlock) return;
        const int blocker = w_.waits_for[at(slot)];
        const DelayCause direct = w_.direct_cause[at(slot)];
        const DelayCause blocker_cause = blocker >= 0 && is_stopped(blocker) ? w_.cause[at(blocker)] : DelayCause::none;
        w_.queue_head[at(slot)] = slot;
        if (direct == DelayCause::none && blocker >= 0) w_.queue_head[at(slot)] = w_.queue_head[at(blocker)];
        w_.cause[at(slot)] = blocker_cause == DelayCause::gridlock ? blocker_cause
                             : direct == DelayCause::none          ? blocker_cause
                                                                   : direct;
        if (w_.cause[at(slot)] == DelayCause::none) w_.cause[at(slot)] = DelayCause::queue_discharge;
    }

    // Records the gridlock that contains the vehicle in slot `start`. Sets the cause of all vehicles in the gridlock.
    void record_gridlock(int start) {
        std::vector<int> slots;
        int slot = start;
        do {
            slots.push_back(slot);
            w_.cause[at(slot)] = DelayCause::gridlock;
            w_.queue_head[at(slot)] = slot;
            slot = w_.waits_for[at(slot)];
        } while (slot != start);
        const auto lowest_id =
            std::min_element(slots.begin(), slots.end(), [&](int a, int b) { return v_.id[at(a)] < v_.id[at(b)]; });
        std::rotate(slots.begin(), lowest_id, slots.end());
        Gridlock found{now_s_, now_s_, {}, {}};
        for (const int member : slots) {
            found.vehicles.push_back(v_.id[at(member)]);
            found.lanes.push_back(w_.lane[at(member)]);
        }
        std::vector<Gridlock>& gridlocks = log_.gridlocks;
        if (const int index = find_open_gridlock(found); index >= 0) {
            found.from_s = gridlocks[at(index)].from_s;
            gridlocks[at(index)] = std::move(found);
            return;
        }
        w_.open_gridlocks.push_back(static_cast<int>(gridlocks.size()));
        gridlocks.push_back(std::move(found));
    }

    // Returns the index of an open gridlock that shares a vehicle with `found`; -1: none. A gridlock stays open for one
    // signal cycle after its latest observation. Ignores gridlocks that have already been observed in this step.
    int find_open_gridlock(const Gridlock& found) const {
        std::vector<int> members = found.vehicles;
        std::sort(members.begin(), members.end());
        for (const int index : w_.open_gridlocks) {
            const Gridlock& known = log_.gridlocks[at(index)];
            if (known.to_s == now_s_) continue;
            const auto is_member = [&](int id) { return std::binary_search(members.begin(), members.end(), id); };
            if (std::any_of(known.vehicles.begin(), known.vehicles.end(), is_member)) return index;
        }
        return -1;
    }

    // For each stopped vehicle, adds the interval between two observations to the total delay. The interval is also
    // added to the episode of the vehicle's queue if the cause is a blockage (is_blocking()) or if the vehicle has been
    // stopped for RulesPlan::long_wait_ticks.
    void add_delays() {
        const double interval_s = model_.time_s(model_.rules.watch_ticks);
        std::array<int, kDelayCauses> vehicles{};
        for (const int slot : w_.stopped_slots) {
            const DelayCause cause = w_.cause[at(slot)];
            ++vehicles[static_cast<std::size_t>(cause)];
            if (is_upstream_of_area(slot)) log_.delay_upstream_s += interval_s;
            if (blocks_the_way(cause) && w_.queue_head[at(slot)] == slot)
                w_.last_blocked_tick[at(w_.lane[at(slot)])] = now_;
            if (starves(slot, cause)) record_starvation(slot, cause);
            if (!is_blocking(cause) && !is_stopped_for_long(slot)) continue;
            DelayEpisode& episode = episode_of(w_.queue_head[at(slot)], cause);
            if (episode.to_s < now_s_) {
                episode.to_s = now_s_;
                episode.current_vehicles = 0;
            }
            episode.delay_s += interval_s;
            episode.max_vehicles = std::max(episode.max_vehicles, ++episode.current_vehicles);
        }
        for (std::size_t cause = 0; cause < vehicles.size(); ++cause) {
            log_.delay_s[cause] += interval_s * vehicles[cause];
        }
    }

    // Returns true if the cause means that vehicles ahead block the way. The way of a vehicle that waits for a lane
    // change does not count as blocked.
    static bool blocks_the_way(DelayCause cause) { return is_blocking(cause) && cause != DelayCause::wrong_lane; }

    // Returns the tick since which the vehicle has been stopped without an observed blockage ahead. During red, the
    // cause is the signal, even if the way is blocked. starves() therefore requires two signal cycles without an
    // observed blockage, so that a vehicle that is blocked at each green does not starve.
    std::int64_t unblocked_since(int slot) const {
        return std::max<std::int64_t>(v_.stopped_since[at(slot)], w_.last_blocked_tick[at(w_.lane[at(slot)])]);
    }

    // Returns true if the vehicle in `slot` is the first of its queue and has been stopped for
    // RulesPlan::starvation_ticks and for two signal cycles, while no vehicle ahead blocked its way. A vehicle that
    // waits for a lane change can starve, too.
    bool starves(int slot, DelayCause cause) const {
        const std::int64_t stopped_ticks = now_ - unblocked_since(slot);
        if (model_.rules.starvation_ticks == 0 || stopped_ticks < model_.rules.starvation_ticks) return false;
        return w_.queue_head[at(slot)] == slot && has_stood_two_cycles(slot) && !blocks_the_way(cause);
    }

    // Returns true if the vehicle has stood for two cycles of its signal without a blockage ahead, or has no signal.
    // The time before the start of the signal programme does not count. The present cause does not matter, because a
    // vehicle that yields at green may have waited at red before.
    bool has_stood_two_cycles(int slot) const {
        const int group = state_.plan.signal_group_for(w_.lane[at(slot)], v_.next_lane[at(slot)]);
        if (group < 0) return true;
        const std::int64_t first_tick = model_.signals.programme(group).first_tick();
        const std::int64_t cycle_ticks = model_.signals.plan_of(group).nominal_cycle_ticks;
        return now_ >= std::max(unblocked_since(slot), first_tick) + 2 * cycle_ticks;
    }

    // Records that the vehicle starves. If an entry for the same stop of the vehicle exists, updates this entry.
    void record_starvation(int slot, DelayCause cause) {
        const double from_s = model_.time_s(v_.stopped_since[at(slot)]);
        const int vehicle = v_.id[at(slot)];
        std::vector<Starvation>& found = log_.starvations;
        const auto known = std::find_if(found.rbegin(), found.rend(), [&](const Starvation& s) {
            return s.vehicle == vehicle && s.from_s == from_s;
        });
        if (known == found.rend()) return found.push_back({cause, w_.lane[at(slot)], vehicle, from_s, now_s_});
        known->cause = cause;
        known->to_s = now_s_;
    }

    bool is_upstream_of_area(int slot) const {
        const std::vector<double>& begins_m = model_.area_begins_m;
        return !begins_m.empty() && v_.position_m[at(slot)] < begins_m[at(w_.lane[at(slot)])];
    }

    // Returns the open episode for a cause and for the lane of the vehicle in slot `queue_head`. Opens an episode if
    // there is none.
    DelayEpisode& episode_of(int queue_head, DelayCause cause) {
        std::vector<DelayEpisode>& episodes = log_.episodes;
        const int lane = w_.lane[at(queue_head)];
        const int key = lane * kDelayCauses + static_cast<int>(cause);
        int& index = w_.open_episode[at(key)];
        if (index < 0) {
            index = static_cast<int>(episodes.size());
            w_.open_episodes.push_back(key);
            const int blocker = w_.waits_for[at(queue_head)];
            episodes.push_back({cause, lane, v_.id[at(queue_head)], blocker < 0 ? -1 : v_.id[at(blocker)],
                                blocker < 0 ? -1 : w_.lane[at(blocker)], now_s_, now_s_ - 1.0, 0, 0, 0.0});
        }
        return episodes[at(index)];
    }

    // Closes the episodes that were not observed in this step.
    void close_episodes() {
        std::erase_if(w_.open_episodes, [&](int key) {
            int& index = w_.open_episode[at(key)];
            const bool is_over = log_.episodes[at(index)].to_s < now_s_;
            if (is_over) index = -1;
            return is_over;
        });
    }

    // Closes the gridlocks that have not been observed for one signal cycle.
    void close_gridlocks() {
        const double latest_s = now_s_ - model_.time_s(model_.rules.gridlock_ticks);
        std::erase_if(w_.open_gridlocks, [&](int index) { return log_.gridlocks[at(index)].to_s < latest_s; });
    }

    const Model& model_;
    const State& state_;
    const VehicleArrays& v_;
    DelayLog& log_;
    DelayWatch& w_;
    int now_;  // present tick
    double now_s_;
};

}  // namespace

bool delay_watch_is_due(const Model& model, const State& state) {
    return model.rules.watches() && state.tick % model.rules.watch_ticks == 0;
}

void prepare_delay_watch(const Model& model, const State& state, DelayWatch& w) {
    const auto slots = at(state.vehicles.slots);
    if (w.traversal.size() != slots) {
        w.waits_for.resize(slots), w.direct_cause.resize(slots), w.cause.resize(slots), w.queue_head.resize(slots);
        w.lane.resize(slots), w.vehicle.resize(slots), w.traversal.resize(slots);
    }
    // The arrays above are indexed by slot and are filled anew in each observation. The arrays below are indexed by
    // lane, or by lane and cause, and keep their contents.
    w.last_blockers.resize(model.graph.lanes.size());
    w.open_episode.resize(model.graph.lanes.size() * kDelayCauseNames.size(), -1);
    w.last_blocked_tick.resize(model.graph.lanes.size(), 0);
}

void attribute_delays(const Model& model, const State& state, CongestionState& congestion) {
    DelayAttribution(model, state, congestion).run();
}

void watch_delays(const Model& model, State& state) {
    DelayWatch& watch = state.congestion.watch;
    prepare_delay_watch(model, state, watch);
    for (Partition& part : state.partitions) find_stopped_vehicles(model, state, part);
    for (const Partition& part : state.partitions) find_wait_reasons(model, state, watch, part);
    attribute_delays(model, state, state.congestion);
}

}  // namespace stopline
