// Inner loops of the receive phase over plain arrays (receive_messages.h). They are part of FullKernels.
#pragma once

#include <array>
#include <span>

#include "sim/state/partition.h"
#include "sim/state/vehicles/full_group.h"
#include "sim/state/vehicles/lane_group.h"
#include "v2v/leader_filter.h"

namespace stopline {

// Plain pointers to the arrays of all vehicles (V2vReceivers), indexed by slot.
struct ReceiveStreams {
    const int *id, *sender, *due_tick, *send_tick, *sent_tick, *mode;
    const float *acceleration, *request, *rate;
    float *leader_speed, *leader_acceleration;
    float *time_gap, *time_gap_rate;
    float* own_speed_now;            // row of this step
    const float* own_speed_delayed;  // row of the radar measurement
};

// The values that all vehicles with one policy share. SI units.
struct ReceivePolicy {
    double has_radio = 1.0;  // 0: human driver
    double response_s = 0.0;
    double margin_m = 0.0;
    double radar_delay_s = 0.0;
    double emergency_mps2 = 0.0;
};

// The values of a step that all vehicles share.
struct ReceiveStep {
    int tick = 0;
    double step_s = 0.0;
    double delay_ticks = 0.0;
    std::span<const float> stable_time_gap_s;  // [age in ticks]
    double radar_time_gap_s = 0.0;
    double acc_time_gap_s = 0.0;
    double platoon_time_gap_s = 0.0;
    LeaderFilter filter;
    std::span<const ReceivePolicy> policies;
};

// The lists of a lane group (ReceiveWork). Each list has room for the vehicles of the group and kSimdWidth more.
struct ReceiveLists {
    int *due, *due_end;
    int *senders, *senders_end;
};

// Counts the vehicles with a leader in each driving mode. `mini_leader` is an input.
struct ReceiveResults {
    std::array<std::int64_t, kV2vModes> mode_steps{};
    const float* mini_leader =
        nullptr;  // [place] 1: the vehicle leads a mini-platoon; null: there are no mini-platoons
};

}  // namespace stopline
