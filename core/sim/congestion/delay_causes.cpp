#include "sim/congestion/delay_causes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/congestion/wait_reasons.h"
#include "sim/state/delay_log.h"

namespace stopline {

namespace {

constexpr int kDelayCauses = static_cast<int>(kDelayCauseNames.size());

class DelayAttribution {
public:
    DelayAttribution(const Model& model, State& state)
        : model_(model),
          state_(state),
          v_(state.vehicles),
          log_(state.congestion.delays),
          watch_(state.congestion.watch),
          now_(static_cast<int>(state.tick)),
          now_s_(model.time_s(state.tick)) {}

    void run() {
        find_causes();
        add_delays();
        close_episodes();
        close_gridlocks();
    }

private:
    bool is_stopped(int slot) const { return v_.speed_mps[at(slot)] < kStoppedSpeed_mps; }

    // Returns the queue that contains the stopped vehicle in `slot` on `lane`. The queues of a partition are in the
    // order of slots.
    StoppedQueue& queue_of(int slot, int lane) const {
        std::vector<StoppedQueue>& queues =
            state_.partitions[at(state_.location_of[at(lane)].partition)].stopped_queues;
        const auto begins_later = [](int value, const StoppedQueue& queue) { return value < queue.first; };
        return *std::prev(std::upper_bound(queues.begin(), queues.end(), slot, begins_later));
    }

    // Returns the queue that contains the blocker of `queue`; nullptr if there is no blocker or if the blocker moves.
    StoppedQueue* queue_ahead(const StoppedQueue& queue) const {
        if (queue.blocker < 0 || !is_stopped(queue.blocker)) return nullptr;
        return &queue_of(queue.blocker, queue.blocker_lane);
    }

    // Follows each chain of waiting vehicles: from a queue to the queue of its blocker, and so on. Then sets the causes
    // in the reverse order, because the cause of a queue can depend on the cause of the queue ahead.
    void find_causes() {
        int traversal = 0;
        for (Partition& part : state_.partitions) {
            for (StoppedQueue& start : part.stopped_queues) {
                if (start.traversal == 0) find_causes_from(start, ++traversal);
            }
        }
    }

    void find_causes_from(StoppedQueue& start, int traversal) {
        watch_.path.clear();
        StoppedQueue* queue = &start;
        while (queue != nullptr && queue->traversal == 0) {
            queue->traversal = traversal;
            watch_.path.push_back(queue);
            queue = queue_ahead(*queue);
        }
        if (queue != nullptr && queue->traversal == traversal) record_gridlock(*queue, watch_.path.back()->blocker);
        std::reverse(watch_.path.begin(), watch_.path.end());
        for (StoppedQueue* const waiting : watch_.path) set_cause(*waiting);
    }

    // Sets the cause to which the delay of a queue is attributed. This is the cause that stops the first vehicle itself
    // (StoppedQueue::direct_cause), unless there is none or the cause of the queue ahead is a gridlock. In these two
    // cases the queue gets the cause of the queue ahead, or queue_discharge if there is no queue ahead. The cause of
    // the queue ahead must have been set before.
    void set_cause(StoppedQueue& queue) {
        if (queue.cause == DelayCause::gridlock) return;
        const StoppedQueue* const ahead = queue_ahead(queue);
        queue.head = queue.first;
        queue.head_lane = queue.lane;
        queue.cause = queue.direct_cause;
        if (ahead != nullptr) {
            const bool only_waits = queue.direct_cause == DelayCause::none;
            if (only_waits) {
                queue.head = ahead->head_of(queue.blocker);
                queue.head_lane = ahead->head_lane;
            }
            if (only_waits || ahead->cause == DelayCause::gridlock) queue.cause = ahead->cause;
        }
        if (queue.cause == DelayCause::none) queue.cause = DelayCause::queue_discharge;
    }

    // Records the gridlock that contains the first vehicles of the queue `start`, up to the slot `last`. Sets the cause
    // of all queues in the gridlock.
    void record_gridlock(StoppedQueue& start, int last) {
        std::vector<std::pair<int, int>> members;  // id and lane of each vehicle
        StoppedQueue* queue = &start;
        do {
            queue->cause = DelayCause::gridlock;
            queue->head = queue->first;
            queue->head_lane = queue->lane;
            queue->cycle_last = last;
            for (int slot = last; slot >= queue->first; --slot) members.emplace_back(v_.id[at(slot)], queue->lane);
            last = queue->blocker;
            queue = queue_ahead(*queue);
        } while (queue != &start);
        std::rotate(members.begin(), std::min_element(members.begin(), members.end()), members.end());
        Gridlock found{now_s_, now_s_, {}, {}};
        for (const auto& [id, lane] : members) {
            found.vehicles.push_back(id);
            found.lanes.push_back(lane);
        }
        std::vector<Gridlock>& gridlocks = log_.gridlocks;
        if (const int index = find_open_gridlock(found); index >= 0) {
            found.from_s = gridlocks[at(index)].from_s;
            gridlocks[at(index)] = std::move(found);
            return;
        }
        watch_.open_gridlocks.push_back(static_cast<int>(gridlocks.size()));
        gridlocks.push_back(std::move(found));
    }

    // Returns the index of an open gridlock that shares a vehicle with `found`; -1: none. A gridlock stays open for one
    // signal cycle after its latest observation. Ignores gridlocks that have already been observed in this step.
    int find_open_gridlock(const Gridlock& found) const {
        std::vector<int> members = found.vehicles;
        std::sort(members.begin(), members.end());
        for (const int index : watch_.open_gridlocks) {
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
        std::array<int, kDelayCauses> vehicles{};
        int vehicles_upstream = 0;
        int earliest_tick = now_;
        for (const Partition& part : state_.partitions) {
            int lane_ahead = -1;  // lane of the queue before this one
            for (const StoppedQueue& queue : part.stopped_queues) {
                vehicles[static_cast<std::size_t>(queue.cause)] += queue.count;
                vehicles_upstream += count_upstream_of_area(queue);
                earliest_tick = std::min(earliest_tick, queue.earliest_stop_tick);
                // Further queues of a lane are behind other vehicles, so they cannot starve.
                if (queue.lane != lane_ahead) watch_first(queue);
                lane_ahead = queue.lane;
                if (const int delayed = count_in_episode(queue); delayed > 0) add_to_episode(queue, delayed);
            }
        }
        for (std::size_t cause = 0; cause < vehicles.size(); ++cause) {
            log_.delay_s[cause] += interval_s_ * vehicles[cause];
        }
        log_.delay_upstream_s += interval_s_ * vehicles_upstream;
        log_.longest_stop_s = std::max(log_.longest_stop_s, model_.time_s(now_ - earliest_tick));
    }

    // Returns the number of vehicles of a queue whose delay belongs to an episode.
    int count_in_episode(const StoppedQueue& queue) const {
        if (is_blocking(queue.cause)) return queue.count;
        const std::int64_t long_ticks = model_.rules.long_wait_ticks;
        if (long_ticks == 0 || now_ - queue.earliest_stop_tick < long_ticks) return 0;
        const auto begin = v_.stopped_since_tick.begin() + queue.first;
        return static_cast<int>(
            std::count_if(begin, begin + queue.count, [&](int since) { return now_ - since >= long_ticks; }));
    }

    // Returns the number of vehicles of a queue that are upstream of the measured area.
    int count_upstream_of_area(const StoppedQueue& queue) const {
        if (model_.area_begins_m.empty()) return 0;
        const double begin_m = model_.area_begins_m[at(queue.lane)];
        if (begin_m <= 0.0) return 0;
        const auto begin = v_.position_m.begin() + queue.first;
        return static_cast<int>(
            std::count_if(begin, begin + queue.count, [&](double front_m) { return front_m < begin_m; }));
    }

    void add_to_episode(const StoppedQueue& queue, int vehicles) {
        DelayEpisode& episode = episode_of(queue);
        if (episode.to_s < now_s_) {
            episode.to_s = now_s_;
            episode.current_vehicles = 0;
        }
        episode.delay_s += interval_s_ * vehicles;
        episode.current_vehicles += vehicles;
        episode.max_vehicles = std::max(episode.max_vehicles, episode.current_vehicles);
    }

    // Watches the first vehicle of the foremost queue of a lane: notes since when it has been the first one, notes that
    // its way is blocked, and records that it starves.
    void watch_first(const StoppedQueue& queue) {
        LaneWatch& lane = watch_.lanes[at(queue.lane)];
        if (const int id = v_.id[at(queue.first)]; lane.front_id != id) {
            lane.front_id = id;
            lane.front_tick = now_;
        }
        if (queue.head != queue.first || blocks_the_way(queue.cause)) {
            lane.last_blocked_tick = now_;
        } else if (starves(queue)) {
            record_starvation(queue);
        }
    }

    // Returns true if the cause means that vehicles ahead block the way. The way of a vehicle that waits for a lane
    // change does not count as blocked.
    static bool blocks_the_way(DelayCause cause) { return is_blocking(cause) && cause != DelayCause::wrong_lane; }

    // Returns the tick since which the first vehicle has been stopped without an observed blockage ahead. The time
    // before LaneWatch::front_tick does not count, because another stopped vehicle of the lane was ahead. During red,
    // the cause is the signal, even if the way is blocked. starves() therefore requires two signal cycles without an
    // observed blockage, so that a vehicle that is blocked at each green does not starve.
    std::int64_t unblocked_since(const StoppedQueue& queue) const {
        const LaneWatch& lane = watch_.lanes[at(queue.lane)];
        return std::max({v_.stopped_since_tick[at(queue.first)], lane.last_blocked_tick, lane.front_tick});
    }

    // Returns true if the first vehicle, which must be the queue head, has been stopped for
    // RulesPlan::starvation_ticks and for two signal cycles, while no vehicle ahead blocked its way. A vehicle that
    // waits for a lane change can starve, too.
    bool starves(const StoppedQueue& queue) const {
        const std::int64_t least_ticks = model_.rules.starvation_ticks;
        return least_ticks > 0 && now_ - unblocked_since(queue) >= least_ticks && has_been_stopped_two_cycles(queue);
    }

    // Returns true if the first vehicle has been stopped for two cycles of its signal without a blockage ahead, or has
    // no signal. The time before the start of the signal programme does not count. The present cause does not matter,
    // because a vehicle that yields at green may have waited at red before.
    bool has_been_stopped_two_cycles(const StoppedQueue& queue) const {
        const int group = state_.plan.signal_group_for(queue.lane, v_.next_lane[at(queue.first)]);
        if (group < 0 || model_.signals.never_changes(group)) return true;
        const std::int64_t first_tick = model_.signals.programme(group).first_tick();
        const std::int64_t cycle_ticks = model_.signals.plan_of(group).nominal_cycle_ticks;
        return now_ >= std::max(unblocked_since(queue), first_tick) + 2 * cycle_ticks;
    }

    // Records that the first vehicle starves. If an entry for the same stop of the vehicle exists, updates this entry.
    void record_starvation(const StoppedQueue& queue) {
        const double from_s = model_.time_s(v_.stopped_since_tick[at(queue.first)]);
        const int vehicle = v_.id[at(queue.first)];
        std::vector<Starvation>& found = log_.starvations;
        const auto known = std::find_if(found.rbegin(), found.rend(), [&](const Starvation& s) {
            return s.vehicle == vehicle && s.from_s == from_s;
        });
        if (known == found.rend()) return found.push_back({queue.cause, queue.lane, vehicle, from_s, now_s_});
        known->cause = queue.cause;
        known->to_s = now_s_;
    }

    // Returns the open episode for the cause of the queue and for the lane of its queue head. Opens an episode if there
    // is none.
    DelayEpisode& episode_of(const StoppedQueue& queue) {
        std::vector<DelayEpisode>& episodes = log_.episodes;
        for (int k = watch_.lanes[at(queue.head_lane)].open_episode; k >= 0; k = watch_.open_episodes[at(k)].next) {
            DelayEpisode& episode = episodes[at(watch_.open_episodes[at(k)].episode)];
            if (episode.cause == queue.cause) return episode;
        }
        const int head = queue.head_of(queue.first);
        const auto [blocker_id, blocker_lane] = blocker_of(head, queue.head_lane);
        add_open_episode(static_cast<int>(episodes.size()), queue.head_lane);
        return episodes.emplace_back(DelayEpisode{queue.cause, queue.head_lane, v_.id[at(head)], blocker_id,
                                                  blocker_lane, now_s_, now_s_ - 1.0, 0, 0, 0.0});
    }

    // Returns the id and the lane of the vehicle that blocks the stopped vehicle in `slot`; -1: none.
    std::pair<int, int> blocker_of(int slot, int lane) const {
        const StoppedQueue& queue = queue_of(slot, lane);
        if (slot == queue.first) return {queue.blocker_id, queue.blocker_lane};
        return {v_.id[at(slot - 1)], lane};
    }

    // Adds an open episode to the list of a lane.
    void add_open_episode(int episode, int lane) {
        int& latest = watch_.lanes[at(lane)].open_episode;
        watch_.open_episodes.push_back({episode, latest});
        latest = static_cast<int>(watch_.open_episodes.size()) - 1;
    }

    // Closes the episodes that were not observed in this step: forms the lists of all lanes anew without them.
    void close_episodes() {
        const auto episode_at = [&](const OpenEpisode& open) -> const DelayEpisode& {
            return log_.episodes[at(open.episode)];
        };
        std::vector<OpenEpisode>& open_episodes = watch_.open_episodes;
        for (const OpenEpisode& open : open_episodes) watch_.lanes[at(episode_at(open).lane)].open_episode = -1;
        std::erase_if(open_episodes, [&](const OpenEpisode& open) { return episode_at(open).to_s < now_s_; });
        for (std::size_t k = 0; k < open_episodes.size(); ++k) {
            int& latest = watch_.lanes[at(episode_at(open_episodes[k]).lane)].open_episode;
            open_episodes[k].next = latest;
            latest = static_cast<int>(k);
        }
    }

    // Closes the gridlocks that have not been observed for one signal cycle.
    void close_gridlocks() {
        const double latest_s = now_s_ - model_.time_s(model_.rules.gridlock_ticks);
        std::erase_if(watch_.open_gridlocks, [&](int index) { return log_.gridlocks[at(index)].to_s < latest_s; });
    }

    const Model& model_;
    State& state_;
    const VehicleArrays& v_;
    DelayLog& log_;
    DelayWatch& watch_;
    int now_;  // present tick
    double now_s_;
    double interval_s_ = model_.time_s(model_.rules.watch_ticks);  // time between two observations
};

}  // namespace

bool delay_watch_is_due(const Model& model, const State& state) {
    return model.rules.watches() && state.tick % model.rules.watch_ticks == 0;
}

void prepare_delay_watch(const Model& model, DelayWatch& watch) { watch.lanes.resize(model.graph.lanes.size()); }

void attribute_delays(const Model& model, State& state) { DelayAttribution(model, state).run(); }

void watch_delays(const Model& model, State& state) {
    DelayWatch& watch = state.congestion.watch;
    prepare_delay_watch(model, watch);
    for (Partition& part : state.partitions) find_stopped_vehicles(model, state, part);
    for (Partition& part : state.partitions) find_wait_reasons(model, state, watch, part);
    attribute_delays(model, state);
}

}  // namespace stopline
