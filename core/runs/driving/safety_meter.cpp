#include "runs/driving/safety_meter.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/perception/look_ahead.h"

namespace stopline {

namespace {

constexpr double kSample_s = 0.1;

}  // namespace

SafetyMeter::SafetyMeter(const Model& model)
    : model_(model), sample_ticks_(std::max<std::int64_t>(to_ticks(kSample_s, model.step_s), 1)) {
    result_.exists = true;
    result_.sample_s = model.time_s(sample_ticks_);
    for (std::size_t k = 0; k < kSafetyMeasures; ++k) {
        result_.distributions[k] = SafetyDistribution(kSafetyAxes[k]);
    }
}

void SafetyMeter::observe(const State& state) {
    if (state.tick % sample_ticks_ != 0) return;
    if (const std::size_t ids = at(state.insertion.next_id); tracks_.size() < ids) {
        if (tracks_.capacity() < ids) tracks_.reserve(2 * ids);
        tracks_.resize(ids);
    }
    for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
        const LaneBlock& block = state.blocks[at(lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) observe(state, lane, slot);
    }
}

void SafetyMeter::observe(const State& state, int lane, int slot) {
    const VehicleArrays& v = state.vehicles;
    Track& track = tracks_[at(v.id[at(slot)])];
    const double speed_mps = v.speed_mps[at(slot)];
    // A vehicle that is new, or was teleported, begins a new sequence of samples.
    if (track.last_tick >= 0 && track.last_tick == state.tick - sample_ticks_) {
        add_motion(track, speed_mps);
    } else {
        track.acceleration_mps2 = kNan;
        track.brakes_hard = false;
    }
    track.last_tick = state.tick;
    track.speed_mps = speed_mps;
    if (speed_mps >= kStoppedSpeed_mps) add_following(state, lane, slot);
}

// The jolt in which a vehicle comes to rest is no sample, because the model stops the vehicle within a step.
void SafetyMeter::add_motion(Track& track, double speed_mps) {
    const auto add = [&](SafetyMeasure measure, double value) {
        result_.distributions[at(static_cast<int>(measure))].add(value);
    };
    const double dt = result_.sample_s;
    result_.vehicle_km += 0.5 * (track.speed_mps + speed_mps) * dt / 1000.0;
    const double acceleration_mps2 = (speed_mps - track.speed_mps) / dt;
    const bool moves = speed_mps >= kStoppedSpeed_mps;
    if (moves) {
        add(SafetyMeasure::acceleration, acceleration_mps2);
        if (!std::isnan(track.acceleration_mps2)) {
            add(SafetyMeasure::jerk, (acceleration_mps2 - track.acceleration_mps2) / dt);
        }
    }
    if (acceleration_mps2 < kHardBrakingBegin_mps2 && !track.brakes_hard) {
        ++result_.hard_brakings;
        track.brakes_hard = true;
    }
    if (acceleration_mps2 > kHardBrakingEnd_mps2) track.brakes_hard = false;
    track.acceleration_mps2 = acceleration_mps2;
}

void SafetyMeter::add_following(const State& state, int lane, int slot) {
    const VehicleArrays& v = state.vehicles;
    LeaderAhead ahead{slot - 1, 0.0};
    if (slot == state.blocks[at(lane)].first) {
        ahead = leader_ahead(state, lane, slot, model_.common_driver().cacc.radar_range_m);
        if (ahead.slot < 0 || rear_is_on_merging_path(state, lane, slot, ahead.slot)) return;
    }
    const std::size_t leader = at(ahead.slot);
    const FollowingState following{rear_m(state, ahead) - v.position_m[at(slot)], v.speed_mps[at(slot)],
                                   v.speed_mps[leader], static_cast<double>(v.acceleration_mps2[leader])};
    const auto add = [&](SafetyMeasure measure, double value) {
        result_.distributions[at(static_cast<int>(measure))].add(value);
    };
    ++result_.following;
    add(SafetyMeasure::net_gap, following.net_gap_m);
    if (following.speed_mps >= kQueuedSpeed_mps)
        add(SafetyMeasure::time_gap, following.net_gap_m / following.speed_mps);
    if (const double ttc_s = time_to_collision_s(following); std::isfinite(ttc_s)) {
        add(SafetyMeasure::time_to_collision, ttc_s);
        if (ttc_s < kCriticalTtc_s) ++result_.critical_ttc;
        if (ttc_s < kShortTtc_s) ++result_.short_ttc;
    }
    const double available_mps2 = model_.vehicle_of(v.policy[at(slot)]).friction_mps2;
    add(SafetyMeasure::brake_threat, required_deceleration_mps2(following) / available_mps2);
}

}  // namespace stopline
