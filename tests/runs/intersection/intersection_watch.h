// Observes the positions of all vehicles in each step of a short run of the reference intersection. It derives
// passages, times and queues from the positions alone, without core/measure.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "sim/step/simulation.h"

namespace stopline::testing_support {

// The run uses scenarios/intersection.yaml with steps of 20 ms and two measured cycles.
inline constexpr double kNotYet_s = -1.0;
inline constexpr double kStep_s = 0.02;
inline constexpr double kStage_s = 15.0 + 3.0 + 5.0;
// Start of the measurement. The first green begins at 1 s; a warm-up cycle of two stages follows.
inline constexpr double kFrom_s = 1.0 + 2.0 * kStage_s;
inline constexpr int kCycles = 2;
inline constexpr double kTo_s = kFrom_s + kCycles * 2.0 * kStage_s;
inline constexpr double kLimit_mps = 50.0 / 3.6;
// Fig. 7 has eight straight paths: 155 m up to the stop line, 40 m in the junction and 99 m downstream.
inline constexpr double kRoad_m = 8.0 * (155.0 + 40.0 + 99.0);
inline constexpr double kRadius_m = 20.0;
inline constexpr double kZones_m[] = {94.0, 40.0};

// Times and position of one vehicle. Positions are those of the front along the whole route.
struct Trip {
    int entry = 0;
    char from = ' ', to = ' ';  // legs of entry and exit
    double front_m = 0.0;
    bool queued = false;        // has been slower than 5 km/h before the stop line
    double line_s = kNotYet_s;  // passage of the stop line
    double exit_s = kNotYet_s;  // passage of the end of the junction
    double zone_in_s[2] = {kNotYet_s, kNotYet_s};
    double zone_out_s[2] = {kNotYet_s, kNotYet_s};
    double inside_s = 0.0;  // from the stop line until the rear has left the junction
};

struct IntersectionWatch {
    explicit IntersectionWatch(const Model& m) : model(m) {}

    // Call before the first step and after each step.
    void observe(const State& state) {
        const double time_s = model.time_s(state.tick);
        const bool is_measured = time_s >= kFrom_s - 1e-9 && time_s < kTo_s - 1e-9;
        steps += is_measured ? 1 : 0;
        present = 0;
        for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
            const LaneBlock& block = state.blocks[at(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot)
                observe_vehicle(state, slot, time_s, is_measured);
        }
        present_sum += is_measured ? present : 0;
        // West and east turn green at the start of the cycle, south and north one stage later.
        for (int n = 0; n < 2 * kCycles && is_measured; ++n) {
            if (std::abs(time_s - kFrom_s - n * kStage_s) > 0.5 * kStep_s) continue;
            observe_queues(state, n % 2 == 0 ? "we" : "sn");
        }
    }

    void observe_vehicle(const State& state, int slot, double time_s, bool is_measured) {
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
        const auto record_passage = [&](double line_m, double& passage_s) {
            if (passage_s != kNotYet_s || front_m < line_m) return;
            passage_s = is_new ? time_s : time_s - kStep_s * (front_m - line_m) / (front_m - trip.front_m);
        };
        if (front_m <= 155.0 && v.speed_mps[at(slot)] <= 5.0 / 3.6) trip.queued = true;
        record_passage(155.0, trip.line_s);
        record_passage(exit_m, trip.exit_s);
        for (std::size_t zone = 0; zone < 2; ++zone) {
            const double margin_m = kZones_m[zone] - kRadius_m;
            record_passage(155.0 - margin_m, trip.zone_in_s[zone]);
            record_passage(exit_m + margin_m, trip.zone_out_s[zone]);
            const bool inside = trip.zone_in_s[zone] != kNotYet_s && trip.zone_out_s[zone] == kNotYet_s;
            zone_sum[zone] += is_measured && inside ? 1 : 0;
        }
        if (trip.line_s != kNotYet_s && front_m - v.length_m[at(slot)] < exit_m) trip.inside_s = time_s - trip.line_s;
        trip.front_m = front_m;
        length_m = v.length_m[at(slot)];
        ++present;
    }

    // Measures the queues on the approach lanes of two legs. A queue begins at the stop line and ends before the first
    // vehicle that is faster than 5 km/h.
    void observe_queues(const State& state, const std::string& legs) {
        for (const int lane : model.graph.entries) {
            if (legs.find(model.graph.lanes[at(lane)].name[0]) == std::string::npos) continue;
            ++queues;
            const LaneBlock& block = state.blocks[at(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                const double to_line_m = 155.0 - state.vehicles.position_m[at(slot)];
                if (to_line_m < 0.0) continue;
                if (state.vehicles.speed_mps[at(slot)] > 5.0 / 3.6) break;
                ++queued;
                longest_m = std::max(longest_m, to_line_m + length_m);
            }
        }
    }

    const Model& model;
    std::map<int, Trip> trips;  // [vehicle]
    int steps = 0, present = 0, queues = 0, queued = 0;
    double present_sum = 0.0, longest_m = 0.0, length_m = 0.0;
    double zone_sum[2] = {0.0, 0.0};
};

}  // namespace stopline::testing_support
