#include "sim/full_dynamics/receive_messages.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "driver/acceleration_laws.h"
#include "sim/full_dynamics/platoons.h"
#include "sim/state/queries/response_time.h"

namespace stopline {

namespace {

// The values that all vehicles with one policy share.
struct PolicyValues {
    int policy = -1;
    bool is_human = false;
    double response_s = 0.0;
    double margin_m = 0.0;
    double radar_delay_s = 0.0;
    double emergency_mps2 = 0.0;
};

// The values of a step that all vehicles share.
struct ReceiveStep {
    const Model& model;
    const V2vPlan& plan;
    State& state;
    int tick;
};

void hold_message(const ReceiveStep& step, int sender_slot, int sent_tick, Reception& receiver) {
    const VehicleArrays& v = step.state.vehicles;
    const auto index = [&](int rows) { return at((sent_tick % rows + rows) % rows) * at(v.slots) + at(sender_slot); };
    const std::size_t i = index(v.v2v_rows);
    receiver.sent_tick = sent_tick;
    receiver.acceleration_mps2 = v.v2v_acceleration_mps2[i];
    receiver.request_mps2 = v.v2v_request_mps2[i];
    receiver.rate_1ps = v.v2v_rate_1ps[i];
    if (!step.plan.uses_platoon_leader) return;
    receiver.speed_mps = v.own_speed_mps[index(v.radar_rows)];
}

// Returns the tick at which a receiver gets the message that a sender sent at `sent_tick`; -1: the message is lost.
int arrival_tick(const ReceiveStep& step, int sender, int receiver, int sent_tick, double distance_m,
                 int intersection) {
    const V2vPlan& plan = step.plan;
    if (distance_m > plan.settings.range_m) return -1;
    V2vMessage message;
    message.link_key = link_key(plan.key, sender, receiver);
    message.number = (sent_tick - first_send_tick(plan, sender)) / plan.interval_ticks;
    message.distance_m = distance_m;
    if (plan.channel->reads_density) message.density_vpkm = step.state.vehicles_per_km[at(intersection)];
    if (plan.channel->is_delivered != nullptr && !plan.channel->is_delivered(plan.settings, message)) return -1;
    return sent_tick + plan.delay_ticks + jitter_ticks(plan, message.link_key, message.number);
}

// One vehicle in the receive phase.
class Receiver {
public:
    Receiver(const ReceiveStep& step, const LaneStep& lane, int slot, int sender_slot, Reception& reception)
        : step_(step),
          v_(step.state.vehicles),
          slot_(slot),
          sender_slot_(sender_slot),
          intersection_(lane.intersection),
          reception_(reception) {}

    // Starts to listen to another sender. Messages of this sender that have already arrived count, because a vehicle
    // hears all vehicles within the range.
    void set_sender(int sender) {
        reception_.sender = sender;
        reception_.sent_tick = kNeverSent;
        reception_.arrival_tick.fill(-1);
        if (sender < 0) return;
        const V2vPlan& plan = step_.plan;
        // The oldest message that the arrays hold. They also hold messages from before the start of the run.
        const int oldest = step_.tick - plan.rows() + 2;
        const int after_phase = oldest - first_send_tick(plan, sender);
        const int late = (after_phase % plan.interval_ticks + plan.interval_ticks) % plan.interval_ticks;
        const int sent_tick = late == 0 ? oldest : oldest + plan.interval_ticks - late;
        reception_.due_tick = sent_tick + plan.delay_ticks;
    }

    // Takes the messages that arrive up to this step.
    void receive(double distance_m) {
        const V2vPlan& plan = step_.plan;
        while (reception_.due_tick <= step_.tick) {
            const int sent_tick = reception_.due_tick - plan.delay_ticks;
            reception_.due_tick += plan.interval_ticks;
            const int arrival =
                arrival_tick(step_, reception_.sender, v_.id[at(slot_)], sent_tick, distance_m, intersection_);
            if (arrival < 0) continue;
            if (arrival <= step_.tick) {
                hold_message(step_, sender_slot_, sent_tick, reception_);
            } else {
                await(sent_tick, arrival);
            }
        }
        if (plan.longest_jitter_ticks == 0) return;
        for (std::size_t k = 0; k < reception_.arrival_tick.size(); ++k) {
            if (reception_.arrival_tick[k] != step_.tick) continue;
            reception_.arrival_tick[k] = -1;
            if (reception_.arriving_sent_tick[k] <= reception_.sent_tick) continue;
            hold_message(step_, sender_slot_, reception_.arriving_sent_tick[k], reception_);
        }
    }

    // Stores a message that is on its way. It takes the place of a message that has arrived, or of one that will arrive
    // later although it was sent earlier.
    void await(int sent_tick, int arrival) {
        for (std::size_t k = 0; k < reception_.arrival_tick.size(); ++k) {
            if (reception_.arrival_tick[k] >= 0 && reception_.arrival_tick[k] < arrival) continue;
            reception_.arrival_tick[k] = arrival;
            reception_.arriving_sent_tick[k] = sent_tick;
            return;
        }
    }

    int age_ticks() const { return step_.tick - reception_.sent_tick; }

private:
    const ReceiveStep& step_;
    VehicleArrays& v_;
    int slot_;
    int sender_slot_;
    int intersection_;
    Reception& reception_;
};

V2vMode demanded_mode(const V2vPlan& plan, int age_ticks) {
    std::size_t mode = 0;
    while (mode < plan.longest_age_ticks.size() && age_ticks > plan.longest_age_ticks[mode]) ++mode;
    return static_cast<V2vMode>(mode);
}

double target_time_gap_s(const V2vPlan& plan, V2vMode mode, double age_s) {
    switch (mode) {
        case V2vMode::messages:
            return 0.0;
        case V2vMode::old_messages:
            return stable_time_gap_s(age_s);
        case V2vMode::radar:
            return plan.settings.fallback.radar_time_gap_s;
        case V2vMode::acc:
            break;
    }
    return plan.settings.fallback.acc_time_gap_s;
}

// Writes what the vehicle at `place` knows about its leader's acceleration into the group.
void use_message(const ReceiveStep& step, const Reception& receiver, int place, const FullGroup& g) {
    const double beyond_s = (step.tick - receiver.sent_tick - step.plan.delay_ticks) * step.model.step_s;
    const double request = receiver.request_mps2;
    // 1 / (1 + x + x^2 / 2) instead of exp(-x): the error is below 0.02 up to x = 1, and the result also tends to 0.
    const double x = beyond_s * static_cast<double>(receiver.rate_1ps);
    const double left = 1.0 / (1.0 + x * (1.0 + 0.5 * x));
    g.heard_acceleration[place] =
        static_cast<float>(request + (static_cast<double>(receiver.acceleration_mps2) - request) * left);
    g.heard_request[place] = receiver.request_mps2;
    g.heard_rate[place] = receiver.rate_1ps;
}

void use_radar(float acceleration_mps2, int place, const FullGroup& g) {
    g.heard_acceleration[place] = acceleration_mps2;
    g.heard_request[place] = acceleration_mps2;
    g.heard_rate[place] = 1.0F;  // without effect: the request equals the acceleration
}

// Enlarges the desired gap of the vehicle at `place` to `gap_m`, which grows with the speed by `slope_s`.
void enlarge_gap(double gap_m, double slope_s, int place, const FullGroup& g) {
    if (gap_m <= g.desired_gap[place]) return;
    g.desired_gap[place] = gap_m;
    g.slope[place] = slope_s;
}

// Radar overrides a message if it shows that the leader brakes clearly harder than the message says.
void use_seen_braking(float seen_mps2, int place, const FullGroup& g) {
    constexpr float kClearly_mps2 = 1.0F;  // twice the noise of the estimate
    if (seen_mps2 >= std::min(g.heard_acceleration[place], g.heard_request[place]) - kClearly_mps2) return;
    use_radar(seen_mps2, place, g);
}

PolicyValues values_of(const Model& model, int policy) {
    const DriverPlan& driver = model.driver_of(policy);
    const CaccSettings& cacc = driver.tables.cacc;
    return {policy,
            driver.is_human,
            response_time_s(model, policy),
            cacc.emergency_gap_m,
            cacc.radar_delay_s,
            cacc.deceleration_emergency_mps2};
}

// Returns true if a vehicle with an old message must not start: radar does not show yet that its leader drives off.
bool must_stay(const FullGroup& g, int place) {
    constexpr double kDrivesOff_mps = 0.1;  // six times the noise of the radar
    return static_cast<double>(g.speed[place]) <= kBrakeHoldSpeed_mps &&
           static_cast<double>(g.closing[place]) > -kDrivesOff_mps;
}

// Returns true if the vehicle at `place` follows its leader at about the desired gap. `was_following`: it did before.
bool follows(const FullGroup& g, int place, bool was_following) {
    constexpr double kJoins_m = 15.0;
    constexpr double kLeaves_m = 25.0;
    const double extra_m = static_cast<double>(g.gap[place]) - g.desired_gap[place];
    return g.is_platoon_leader[place] == 0.0F && extra_m < (was_following ? kLeaves_m : kJoins_m);
}

// Updates the platoon of a vehicle. `leader`: data of its leader; null: none.
void find_platoon(const ReceiveStep& step, const V2vReceiver* leader, int slot, int place, const FullGroup& g,
                  V2vReceiver& own) {
    const VehicleArrays& v = step.state.vehicles;
    PlatoonLink link;
    link.leader = leader;
    link.leader_has_v2v = own.leader_has_v2v;
    link.is_following = follows(g, place, own.place_in_platoon > 0 || own.leads_mini_platoon);
    link.is_stopped = static_cast<double>(g.speed[place]) <= kBrakeHoldSpeed_mps;
    update_platoon(link, step.plan.max_platoon, v.id[at(slot)], slot, own);
}

// Receives the messages of the platoon leader, and replaces the law for following by that of Rajamani while they are
// recent. To replace the law, the desired gap becomes so small that it does not limit the acceleration, and the law of
// Rajamani becomes an external demand. All other laws, such as emergency braking, stay as they are. A vehicle that is
// too close to its leader keeps the law of its policy. The law of Rajamani would follow the platoon leader's start even
// if its own leader still stands.
// Precondition: the spacing policy keeps a constant distance at this speed.
void follow_platoon_leader(const ReceiveStep& step, const LaneStep& lane, int slot, int place, const FullGroup& g,
                           V2vReceiver& own) {
    constexpr double kLongestAge_s = 0.15;  // our choice, after the states of PlatoonSAFE
    constexpr double kUnlimitedGap_m = -1e3;
    constexpr double kTooClose_m = 0.5;
    VehicleArrays& v = step.state.vehicles;
    const int sender_slot = own.platoon_leader_slot;
    Receiver radio(step, lane, slot, sender_slot, own.platoon_leader);
    const int sender = own.place_in_platoon > 0 ? own.platoon : -1;
    if (sender != own.platoon_leader.sender) radio.set_sender(sender);
    if (sender < 0) return;
    // For one step after the platoon leader has changed its lane, its slot is not known.
    // The distance is that to the leader times the number of vehicles between.
    if (v.id[at(sender_slot)] == sender) {
        const double spacing_m = static_cast<double>(g.gap[place]) + static_cast<double>(v.length_m[at(slot)]);
        radio.receive(own.place_in_platoon * spacing_m);
    }
    if (own.fallback.mode != V2vMode::messages || radio.age_ticks() * step.model.step_s > kLongestAge_s) return;
    if (static_cast<double>(g.gap[place]) < g.desired_gap[place] - kTooClose_m) return;
    const double u =
        platoon_acceleration(step.plan.settings.platoon_law, step.model.driver_of(v.policy[at(slot)]).tables.cacc, g,
                             place, own.platoon_leader.request_mps2, own.platoon_leader.speed_mps);
    g.demand[place] = std::min(g.demand[place], static_cast<float>(u));
    g.desired_gap[place] = kUnlimitedGap_m;
    g.slope[place] = 0.0;
}

// Limits the speed at which a vehicle closes up to its leader, so that the vehicle could still respond to full braking
// of its leader after response_time_s(): v^2 <= v_p^2 + 2 b (gap - reserve - T v), with the speed v_p of the leader and
// the maximum braking b. A faster vehicle brakes like keep_room_acceleration(). The law for following keeps more than
// this reserve, so it alone acts in equilibrium.
void keep_response_room(const PolicyValues& values, int place, const FullGroup& g) {
    constexpr double kSpeedGain_1ps = 2.0;
    const double closing_mps = g.closing[place];
    if (closing_mps <= 0.0) return;
    const double b = values.emergency_mps2;
    const double speed_mps = g.speed[place];
    const double leader_mps = std::max(speed_mps - closing_mps, 0.0);
    const double reserve_m = 0.5 * values.margin_m + values.response_s * speed_mps;
    const double room_m =
        std::max(static_cast<double>(g.gap[place]) - values.radar_delay_s * closing_mps - reserve_m, 0.0);
    const double safe_squared = leader_mps * leader_mps + 2.0 * b * room_m;
    if (speed_mps * speed_mps <= safe_squared) return;
    const double safe_mps = std::sqrt(safe_squared);
    const double leader_mps2 = std::min(static_cast<double>(g.heard_acceleration[place]), 0.0);
    const double along_mps2 = (leader_mps * leader_mps2 - b * closing_mps) / std::max(safe_mps, 1.0);
    const double demand_mps2 = std::max(along_mps2 + kSpeedGain_1ps * (safe_mps - speed_mps), -b);
    g.demand[place] = std::min(g.demand[place], static_cast<float>(demand_mps2));
}

// Updates the driving mode, and writes what the vehicle knows about its leader into the group.
void fall_back(const ReceiveStep& step, const PolicyValues& values, int slot, int place, const FullGroup& g,
               V2vReceiver& own, Partition& part) {
    const Model& model = step.model;
    VehicleArrays& v = step.state.vehicles;
    const int age_ticks = step.tick - own.leader.sent_tick;
    const double age_s = age_ticks * model.step_s;
    const V2vMode before = own.fallback.mode;
    if (update_mode(own.fallback, demanded_mode(step.plan, age_ticks), step.tick, step.plan.hysteresis_ticks)) {
        const bool is_known = own.leader.sent_tick != kNeverSent;
        part.v2v_mode_changes.push_back({model.time_s(step.tick), v.id[at(slot)], own.leader.sender,
                                         static_cast<int>(before), static_cast<int>(own.fallback.mode),
                                         is_known ? static_cast<float>(age_s) : -1.0F, g.gap[place], g.speed[place]});
    }
    const V2vMode mode = own.fallback.mode;
    ++part.v2v_mode_steps[static_cast<std::size_t>(mode)];
    if (mode <= V2vMode::old_messages) {
        use_message(step, own.leader, place, g);
    } else {
        use_radar(mode == V2vMode::radar ? own.estimate.acceleration_mps2 : 0.0F, place, g);
    }
    use_seen_braking(own.estimate.acceleration_mps2, place, g);
    if (mode > V2vMode::messages && must_stay(g, place)) g.demand[place] = std::min(g.demand[place], 0.0F);
    // The leader of a mini-platoon keeps a time gap only while it drives. From rest it starts like all others.
    const bool keeps_time_gap = own.leads_mini_platoon && static_cast<double>(g.speed[place]) > kBrakeHoldSpeed_mps;
    const double target_s =
        std::max(target_time_gap_s(step.plan, mode, age_s), keeps_time_gap ? step.plan.platoon_time_gap_s : 0.0);
    update_time_gap(own.fallback, target_s, g.speed[place], model.step_s);
    const double speed_mps = g.coming_speed[place];
    enlarge_gap(values.margin_m + values.response_s * speed_mps, values.response_s, place, g);
    keep_response_room(values, place, g);
    if (own.fallback.time_gap_s == 0.0F) return;
    const double time_gap_s = own.fallback.time_gap_s;
    enlarge_gap(static_cast<double>(g.standstill_gap[place]) + time_gap_s * speed_mps, time_gap_s, place, g);
}

}  // namespace

void receive_messages(const Model& model, State& state, std::span<const LaneStep> lanes, const FullGroup& g,
                      Partition& part) {
    VehicleArrays& v = state.vehicles;
    if (!v.has_v2v_channel) return;
    const V2vPlan& plan = model.v2v_plan;
    const ReceiveStep step{model, plan, state, static_cast<int>(state.tick)};
    const bool needs_platoons = plan.uses_platoon_leader || plan.max_platoon > 0;
    PolicyValues values;
    int place = -1;
    for (const LaneStep& lane : lanes) {
        for (int slot = lane.begin; slot < lane.stop; ++slot) {
            ++place;
            v.own_speed_mps[state.radar.now + at(slot)] = g.speed[place];
            V2vReceiver& own = v.receiver[at(slot)];
            if (v.policy[at(slot)] != values.policy) values = values_of(model, v.policy[at(slot)]);
            if (values.is_human) continue;
            const V2vReceiver& ahead = v.receiver[at(slot - 1)];
            const int sender_slot = slot == lane.begin ? ahead.sender_slot : slot - 1;
            const int sender = sender_slot < 0 ? -1 : v.id[at(sender_slot)];
            const double leader_mps = static_cast<double>(v.own_speed_mps[state.radar.delayed + at(slot)]) -
                                      static_cast<double>(g.closing[place]);
            Receiver radio(step, lane, slot, sender_slot, own.leader);
            if (sender != own.leader.sender) {
                radio.set_sender(sender);
                own.estimate = {static_cast<float>(leader_mps), 0.0F};
                own.leader_has_v2v = sender >= 0 && !model.driver_of(v.policy[at(sender_slot)]).is_human;
                own.leads_mini_platoon = false;
            }
            if (needs_platoons) find_platoon(step, sender < 0 ? nullptr : &ahead, slot, place, g, own);
            if (sender < 0) {
                update_time_gap(own.fallback, 0.0, g.speed[place], model.step_s);
                continue;
            }
            update_estimate(plan.filter, leader_mps, own.estimate);
            if (own.leader_has_v2v) radio.receive(g.gap[place]);
            const bool keeps_distance = g.slope[place] <= 0.0;  // by the spacing policy, before any fallback
            fall_back(step, values, slot, place, g, own, part);
            if (plan.uses_platoon_leader && keeps_distance) follow_platoon_leader(step, lane, slot, place, g, own);
        }
    }
}

void measure_density(const Model& model, State& state) {
    if (model.v2v_plan.channel == nullptr || !model.v2v_plan.channel->reads_density) return;
    constexpr double kInterval_s = 1.0;
    if (state.tick % to_ticks(kInterval_s, model.step_s) != 0) return;
    const std::size_t intersections = state.blocks.size();  // the number of an intersection is that of one of its lanes
    state.longest_lane_m.assign(intersections, 1.0);
    state.vehicles_per_km.assign(intersections, 0.0F);
    for (std::size_t lane = 0; lane < state.blocks.size(); ++lane) {
        const std::size_t k = at(state.plan.intersection_of(static_cast<int>(lane)));
        state.longest_lane_m[k] = std::max(state.longest_lane_m[k], state.plan.lane(static_cast<int>(lane)).length_m);
        state.vehicles_per_km[k] += static_cast<float>(state.blocks[lane].count);
    }
    // The vehicles of an intersection are within its longest lane, on both sides of the junction.
    constexpr double kKmPerM = 1e-3;
    for (std::size_t k = 0; k < intersections; ++k) {
        state.vehicles_per_km[k] /= static_cast<float>(2.0 * kKmPerM * state.longest_lane_m[k]);
    }
}

}  // namespace stopline
