// Selects the vehicles that the mesoscale kernels move in a step. The kernels move whole blocks: batches of consecutive
// slots. Caps the speed of vehicles that must stop or align with a gap.
//
// The kernels skip vehicles inside a standing queue: the leader of such a vehicle is stopped, so the vehicle remains
// stopped too. A lane sleeps while its first vehicle is stopped before a red signal. The search for leaders and the
// decisions at stop lines skip a sleeping lane.
#include "sim/mesoscale/meso_blocks.h"

#include <algorithm>
#include <bit>

#include "base/containers/index.h"
#include "base/random.h"
#include "driver/human.h"
#include "sim/mesoscale/meso_dynamics.h"
#include "sim/performance/prefetch.h"
#include "sim/state/queries/gap.h"

namespace stopline {

namespace {

// Updates the standing queue of a lane: removes vehicles that started at the head of the queue, and adds vehicles that
// stopped at its end.
void update_queue(const VehicleArrays& v, const LaneBlock& block, std::int64_t tick, StandingQueue& queue) {
    const auto is_at_rest = [&](int place) {
        const std::size_t i = at(block.first + place);
        return v.speed_mps[i] == 0.0 && v.acceleration_mps2[i] == 0.0F;
    };
    while (queue.first < queue.end && !is_at_rest(queue.first)) ++queue.first;
    // After a start message (relay_start()), a vehicle may have moved although the vehicle ahead of it is still at
    // rest. The queue then ends ahead of the vehicle that moved.
    for (int place = queue.first + 1; place < std::min(queue.released, queue.end); ++place) {
        if (!is_at_rest(place)) queue.end = place;
    }
    queue.released = 0;
    if (queue.first == queue.end) queue.first = queue.end = 0;
    if (queue.last_external_tick >= tick - 1) {
        queue.end = queue.first;
        return;
    }
    while (queue.end < block.count && is_at_rest(queue.end)) ++queue.end;
}

// Returns true if the vehicle in `slot` receives the start message that the vehicle ahead of it sends in this step.
// Without a V2V channel (V2vPlan::channel), it always does. `gap_m`: net gap to the sender.
bool receives_start(const Model& model, const VehicleArrays& v, std::int64_t tick, double gap_m, float density_vpkm,
                    std::size_t slot) {
    const V2vPlan& plan = model.v2v_plan;
    if (plan.channel == nullptr) return true;
    if (gap_m > plan.settings.range_m) return false;
    if (plan.channel->is_delivered == nullptr) return true;
    return plan.channel->is_delivered(plan.settings,
                                      {link_key(plan.key, v.id[slot - 1], v.id[slot]), tick, gap_m, density_vpkm});
}

// Tells stopped vehicles of a queue by V2V that the vehicle ahead of the queue has started. Returns the number of
// vehicles that receive this start message. A vehicle forwards the message before it moves, so the message reaches
// several vehicles in one step. The relay ends at the first vehicle whose car-following model does not pass on messages
// (FollowingModel::relays_starts()). This function only stores the messages, because the decisions for other lanes
// still read the present accelerations of the receivers. step_meso() applies the messages.
// A message that the channel loses ends the relay for this step.
int relay_start(const Model& model, const State& state, int lane, StandingQueue& queue,
                std::vector<StartMessage>& messages) {
    const VehicleArrays& v = state.vehicles;
    const LaneBlock& block = state.blocks[at(lane)];
    const float density_vpkm =
        state.vehicles_per_km.empty() ? 0.0F : state.vehicles_per_km[at(state.plan.intersection_of(lane))];
    // The relay ends at a vehicle whose gap exceeds its desired gap by more than this value.
    constexpr double kClosedUp_m = 0.5;
    if (queue.first == 0) return 0;
    const std::size_t last_started = at(block.first + queue.first - 1);
    const float relayed_mps2 = v.acceleration_mps2[last_started];
    if (relayed_mps2 <= 0.0F || v.speed_mps[last_started] == 0.0) return 0;
    int receivers = 0;
    while (receivers < model.start_relay_vehicles && queue.first + receivers < queue.end) {
        const std::size_t i = at(block.first + queue.first + receivers);
        const FollowingModel& following = model.following[at(v.policy[i])];
        const double gap_m = net_gap_m(v, i - 1, i);
        if (!following.relays_starts() || gap_m > following.equilibrium_gap_m(0.0) + kClosedUp_m) break;
        if (!receives_start(model, v, state.tick, gap_m, density_vpkm, i)) break;
        messages.push_back({static_cast<int>(i), relayed_mps2});
        ++receivers;
    }
    if (receivers > 0) queue.released = queue.first + receivers + 1;
    return receivers;
}

constexpr double kRounding_m = 1e-3;

class LaneCollector {
public:
    LaneCollector(const Model& model, int shift, State& state, Partition& part, int lane)
        : model_(model),
          shift_(shift),
          state_(state),
          v_(state.vehicles),
          part_(part),
          lane_(lane),
          block_(state.blocks[at(lane)]),
          plan_(state.plan.lane(lane)),
          stop_slot_(state.stop_lines.stop_slot[at(lane)]),
          yield_stops_(yield_stops_of(state, lane)) {}

    void collect() {
        const int first = block_.first;
        StandingQueue& queue = state_.queues.standing[at(lane_)];
        int& sleep_group = state_.queues.sleeps_until_green[at(lane_)];
        if (sleep_group >= 0) {
            cap_at_speed_targets(true);
            cap_waiting_drivers(true);
            cap_behind_first();
            if (queue.end == block_.count) return;
            update_queue(v_, block_, state_.tick, queue);
            return add_blocks(first + queue.end, block_.past_last());
        }
        if (is_near_end()) part_.lanes_near_end.push(lane_);
        // Removes the cap that held the first vehicle while the lane slept.
        v_.speed_cap_mps[at(first)] = kUnlimitedSpeed_mps;
        cap_at_speed_targets(false);
        cap_waiting_drivers(false);
        if (last_stopping_slot() > first + queue.first) queue.last_external_tick = static_cast<int>(state_.tick);
        update_queue(v_, block_, state_.tick, queue);
        const bool is_restrained = last_stopping_slot() >= first + queue.first;
        const int receivers = is_restrained ? 0 : relay_start(model_, state_, lane_, queue, part_.start_messages);
        if (model_.scalar_kernels) {
            cap_all();
            return add_blocks(first, block_.past_last());
        }
        if (queue.first == 0 && queue.end > 0 && !first_has_target_ && waits_only_for_signal()) {
            sleep_group = state_.plan.signal_group_for(lane_, v_.next_lane[at(first)]);
            // The kernels compute whole blocks of slots. So they also compute the first vehicle if it shares a block
            // with a vehicle that moves. A cap of 0 keeps the first vehicle at rest.
            v_.speed_cap_mps[at(first)] = 0.0;
            return add_blocks(first + queue.end, block_.past_last());
        }
        cap_all();
        if (queue.end - queue.first <= 1) return add_blocks(first, block_.past_last());
        add_blocks(first, std::min(first + queue.first + receivers + 1, block_.past_last()));
        add_blocks(first + queue.end, block_.past_last());
    }

private:
    // Returns the slot of the vehicle furthest upstream that must stop, either at the stop line or at a yield stop (a
    // position where a vehicle yields or waits for a gap in the adjacent lane); -1: none.
    int last_stopping_slot() const {
        return std::max(stop_slot_, yield_stops_.count == 0 ? -1 : yield_stops_.stops[at(yield_stops_.count - 1)].slot);
    }

    // Returns true if the first vehicle, driving at the free speed of the lane, could reach the stop line or the end of
    // the lane in this step.
    bool is_near_end() const {
        const double end_m = plan_.signal_group < 0 ? plan_.length_m : std::min(plan_.length_m, plan_.stop_line_m);
        const double step_m = state_.plan.free_speed_mps(lane_) * model_.step_s;
        return v_.position_m[at(block_.first)] + step_m + kRounding_m >= end_m;
    }

    // Caps the speed of vehicles with a speed target. If the lane sleeps, skips its first
    // vehicle if this vehicle is at rest. A cap set by cap_speed() is removed after the step, so the vehicle would lose
    // the cap that holds it while the lane sleeps.
    void cap_at_speed_targets(bool sleeps) {
        if (part_.speed_targets.empty()) return;
        const int place = state_.speed_targets_place[at(lane_)];
        for (const SpeedTarget& target : part_.speed_targets.at_place(place)) {
            const double speed_mps = v_.speed_mps[at(target.slot)];
            if (sleeps && target.slot == block_.first && speed_mps == 0.0) continue;
            const double braking_step_mps = target.deceleration_mps2 * model_.step_s;
            first_has_target_ = first_has_target_ || target.slot == block_.first;
            cap_speed(target.slot, std::max(target.target_speed_mps, speed_mps - braking_step_mps));
        }
    }

    // Holds a stopped human driver until the sum of its start reaction time and the powertrain delay has passed since
    // its leader started (driver/human.h). If the lane sleeps, its first vehicle already has a cap. While a driver of
    // the lane waits, the lane has no standing queue, because this driver may start even if its leader has stopped
    // again.
    void cap_waiting_drivers(bool sleeps) {
        if (!v_.has_human_drivers) return;
        const std::uint64_t key = driver_key(model_.seed);
        for (int slot = block_.first; slot < block_.past_last(); ++slot) {
            const std::size_t i = at(slot);
            const DriverPlan& driver = model_.driver_of(v_.policy[i]);
            if (!driver.is_human) continue;
            const double gap_m = net_gap_m(v_, i - 1, i);
            v_.start_ticks[i] = next_start_ticks(v_.start_ticks[i], v_.speed_mps[i], v_.speed_mps[i - 1],
                                                 gap_m - static_cast<double>(v_.standstill_gap_m[i]));
            if (sleeps && slot == block_.first) continue;
            const double reaction_s = reaction_time_s(driver.human, keyed_uniform(key, v_.id[i], 0));
            const double wait_s = start_reaction_s(driver.human, reaction_s) + model_.powertrain_delay_s;
            if (!waits_to_start(v_.start_ticks[i], v_.speed_mps[i], wait_s, model_.step_s)) continue;
            cap_speed(slot, 0.0);
            state_.queues.standing[at(lane_)].last_external_tick = static_cast<int>(state_.tick);
        }
    }

    double room_to_line_m(int slot) const {
        return plan_.stop_line_m - model_.driver_of(v_.policy[at(slot)]).tables.stop.margin_m - v_.position_m[at(slot)];
    }

    // Returns true if only the signal holds the first vehicle of the lane. Precondition: this vehicle is at rest.
    bool waits_only_for_signal() const {
        const int first = block_.first;
        if (stop_slot_ != first || state_.stop_lines.lines[at(lane_)].stopping_vehicle != v_.id[at(first)])
            return false;
        if (yield_stops_.count > 0 || v_.position_m[at(first)] > plan_.stop_line_m) return false;
        return snap_to_standstill(stopping_speed_mps(model_, v_, first, room_to_line_m(first))) == 0.0;
    }

    // Sleeping lane: caps the speed of each vehicle with a yield stop, that is, a vehicle that must wait for a gap in
    // the adjacent lane. Skips the first vehicle of the lane, which already has a cap.
    void cap_behind_first() {
        for (int k = 0; k < yield_stops_.count; ++k) {
            const YieldStop& stop = yield_stops_.stops[at(k)];
            if (stop.slot == block_.first) continue;
            cap_speed(stop.slot,
                      stopping_speed_mps(model_, v_, stop.slot, stop.position_m - v_.position_m[at(stop.slot)]));
            state_.queues.standing[at(lane_)].last_external_tick = static_cast<int>(state_.tick);
        }
    }

    void cap_all() {
        if (stop_slot_ >= 0)
            cap_speed(stop_slot_, stopping_speed_mps(model_, v_, stop_slot_, room_to_line_m(stop_slot_)));
        for (int k = 0; k < yield_stops_.count; ++k) {
            const YieldStop& stop = yield_stops_.stops[at(k)];
            const double room_m = stop.position_m - v_.position_m[at(stop.slot)];
            cap_speed(stop.slot, stopping_speed_mps(model_, v_, stop.slot, room_m));
        }
        const int first = block_.first;
        if (v_.record[at(first)].leader_id < 0) {
            const int policy = v_.policy[at(first)];
            cap_speed(first, leading_speed_mps(model_, policy, v_.speed_mps[at(first)], v_.limit_mps[at(first)]));
        }
    }

    void cap_speed(int slot, double cap_mps) {
        v_.speed_cap_mps[at(slot)] = std::min(v_.speed_cap_mps[at(slot)], cap_mps);
        part_.capped_slots.push_back(slot);
    }

    // Adds the blocks that contain the slots [from, to). The slots of successive calls must ascend, so that each block
    // is added once.
    void add_blocks(int from, int to) {
        if (from == to) return;
        part_.moving_blocks.push_range(std::max(from >> shift_, part_.moving_blocks.last_or(-1) + 1),
                                       ((to - 1) >> shift_) + 1);
    }

    const Model& model_;
    int shift_;  // binary logarithm of the number of slots in a block
    State& state_;
    VehicleArrays& v_;
    Partition& part_;
    int lane_;
    const LaneBlock& block_;
    const LanePlan& plan_;
    int stop_slot_;
    const YieldStops& yield_stops_;
    bool first_has_target_ = false;  // true: the first vehicle has a speed target
};

}  // namespace

// Called at the end of the decisions of a partition, while the data of the partition are still in the cache.
void collect_moving_blocks(const Model& model, State& state, Partition& part) {
    // Upper bound of the number of moving blocks: one for each vehicle, and a reserve for each lane.
    constexpr std::size_t kReservePerLane = 4;
    const int shift = std::countr_zero(static_cast<unsigned>(meso_block_size(model.scalar_kernels)));
    part.lanes_near_end.reset(part.occupied.size());
    part.moving_blocks.reset(static_cast<std::size_t>(part.present) + kReservePerLane * part.occupied.size());
    part.start_messages.clear();
    for (const int lane : part.occupied) {
        advance_prefetch(state, part.prefetch);
        LaneCollector(model, shift, state, part, lane).collect();
    }
}

}  // namespace stopline
