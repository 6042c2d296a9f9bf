// Where the vehicles of a short run of the reference intersection are, step by step, and what follows from that alone: passages,
// times, queues. Nothing of core/measure is used.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "sim/step/simulation.h"

namespace stopline::testing_support {

// The run: scenarios/intersection.yaml with steps of 20 ms and two measured cycles.
inline constexpr double kNotYet_s = -1.0;
inline constexpr double kStep_s = 0.02;
inline constexpr double kStage_s = 15.0 + 3.0 + 5.0;
inline constexpr double kFrom_s = 1.0 + 2.0 * kStage_s;  // first green and a cycle that is not measured
inline constexpr int kCycles = 2;
inline constexpr double kTo_s = kFrom_s + kCycles * 2.0 * kStage_s;
inline constexpr double kLimit_mps = 50.0 / 3.6;
// Lanes of Fig. 7 along a straight path: eight of them, 155 m to the stop line, 40 m inside, 99 m behind.
inline constexpr double kRoad_m = 8.0 * (155.0 + 40.0 + 99.0);
inline constexpr double kRadius_m = 20.0;
inline constexpr double kZones_m[] = {94.0, 40.0};

// One vehicle; its front along its whole route.
struct Trip {
    int entry = 0;
    char from = ' ', to = ' ';  // arms
    double front_m = 0.0;
    double line_s = kNotYet_s;     // stop line
    double through_s = kNotYet_s;  // end of the intersection
    double zone_in_s[2] = {kNotYet_s, kNotYet_s};
    double zone_out_s[2] = {kNotYet_s, kNotYet_s};
    double inside_s = 0.0;  // from the stop line until the rear is out
};

struct Watch {
    explicit Watch(const Model& m) : model(m) {}

    void look(const State& state) {
        const double time_s = model.time_s(state.tick);
        const bool counts = time_s >= kFrom_s - 1e-9 && time_s < kTo_s - 1e-9;
        steps += counts ? 1 : 0;
        present = 0;
        for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
            const LaneBlock& block = state.blocks[at(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot) look_at(state, slot, time_s, counts);
        }
        present_sum += counts ? present : 0;
        // West and east have green with the cycle, south and north a stage later.
        for (int n = 0; n < 2 * kCycles && counts; ++n) {
            if (std::abs(time_s - kFrom_s - n * kStage_s) > 0.5 * kStep_s) continue;
            look_at_queues(state, n % 2 == 0 ? "we" : "sn");
        }
    }

    void look_at(const State& state, int slot, double time_s, bool counts) {
        const VehicleArrays& v = state.vehicles;
        const std::vector<int>& lanes = model.graph.routes[at(v.record[at(slot)].route)].lanes;
        const Lane& entry = model.graph.lanes[at(lanes[0])];
        const double exit_m = entry.length_m + model.graph.lanes[at(lanes[1])].length_m;
        const double starts_m[] = {0.0, entry.length_m, exit_m};
        const double front_m = starts_m[at(v.record[at(slot)].route_index)] + v.position_m[at(slot)];
        const bool is_new = !trips.contains(v.id[at(slot)]);
        Trip& trip = trips[v.id[at(slot)]];
        if (is_new) {
            trip.entry = lanes[0];
            trip.from = entry.name[0];
            trip.to = model.graph.lanes[at(lanes[2])].name[0];
        }
        const auto passes = [&](double mark_m, double& mark_s) {
            if (mark_s != kNotYet_s || front_m < mark_m) return;
            mark_s = is_new ? time_s : time_s - kStep_s * (front_m - mark_m) / (front_m - trip.front_m);
        };
        passes(155.0, trip.line_s);
        passes(exit_m, trip.through_s);
        for (std::size_t zone = 0; zone < 2; ++zone) {
            const double beyond_m = kZones_m[zone] - kRadius_m;
            passes(155.0 - beyond_m, trip.zone_in_s[zone]);
            passes(exit_m + beyond_m, trip.zone_out_s[zone]);
            const bool inside = trip.zone_in_s[zone] != kNotYet_s && trip.zone_out_s[zone] == kNotYet_s;
            zone_sum[zone] += counts && inside ? 1 : 0;
        }
        if (trip.line_s != kNotYet_s && front_m - v.length_m[at(slot)] < exit_m) trip.inside_s = time_s - trip.line_s;
        trip.front_m = front_m;
        length_m = v.length_m[at(slot)];
        ++present;
    }

    // Of the lanes from two arms: those from the line on that are slower than 5 km/h.
    void look_at_queues(const State& state, const std::string& arms) {
        for (const int lane : model.graph.entries) {
            if (arms.find(model.graph.lanes[at(lane)].name[0]) == std::string::npos) continue;
            ++queues;
            const LaneBlock& block = state.blocks[at(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                const double before_m = 155.0 - state.vehicles.position_m[at(slot)];
                if (before_m < 0.0) continue;
                if (state.vehicles.speed_mps[at(slot)] > 5.0 / 3.6) break;
                ++queued;
                longest_m = std::max(longest_m, before_m + length_m);
            }
        }
    }

    const Model& model;
    std::map<int, Trip> trips;  // by vehicle
    int steps = 0, present = 0, queues = 0, queued = 0;
    double present_sum = 0.0, longest_m = 0.0, length_m = 0.0;
    double zone_sum[2] = {0.0, 0.0};
};

}  // namespace stopline::testing_support
