// Checks a run from the positions of its vehicles alone. The simulation has checks of its own (Violations); this one
// does not use them.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "sim/step/simulation.h"

namespace stopline::campaign {

// Observes a run step by step. Stores the first fault.
class MotionCheck {
public:
    void observe(const Simulation& simulation) {
        if (!fault_.empty()) return;
        const State& state = simulation.state();
        const Model& model = simulation.model();
        int present = state.congestion.teleporting.count;
        for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
            const LaneBlock& block = state.blocks[at(lane)];
            present += block.count;
            for (int slot = block.first; slot < block.past_last(); ++slot) check_vehicle(model, state, lane, slot);
            if (block.count > 0) check_rears_downstream(model, state, lane);
        }
        if (state.records.entered - state.records.exited != present)
            report(model, state,
                   fmt::format("{} vehicles entered and {} exited, but {} are present", state.records.entered,
                               state.records.exited, present));
    }

    // Returns the first fault; empty: none.
    const std::string& fault() const { return fault_; }

private:
    static constexpr double kRounding_m = 1e-6;

    struct Seen {
        std::int64_t tick = -1;
        int lane = -1;
        double position_m = 0.0;
        double speed_mps = 0.0;
    };

    void report(const Model& model, const State& state, const std::string& text) {
        if (fault_.empty()) fault_ = fmt::format("at {:.3f} s {}", model.time_s(state.tick), text);
    }

    void check_vehicle(const Model& model, const State& state, int lane, int slot) {
        const VehicleArrays& v = state.vehicles;
        const int id = v.id[at(slot)];
        const Seen now{state.tick, lane, v.position_m[at(slot)], v.speed_mps[at(slot)]};
        const auto fault = [&](const std::string& text) {
            report(model, state, fmt::format("vehicle {} on {}: {}", id, model.graph.lanes[at(lane)].name, text));
        };
        if (id < 0) return fault("the id is negative");
        if (seen_.size() <= at(id)) seen_.resize(2 * at(id) + 1);
        Seen& last = seen_[at(id)];
        if (last.tick == now.tick) return fault("it is at two places");
        if (!std::isfinite(now.position_m) || !std::isfinite(now.speed_mps) || now.speed_mps < 0.0)
            return fault(fmt::format("position {} m, speed {} m/s", now.position_m, now.speed_mps));
        if (now.position_m >= model.graph.lanes[at(lane)].length_m) return fault("it is beyond the lane");
        if (last.tick == now.tick - 1 && last.lane == lane) {
            const double moved_m = now.position_m - last.position_m;
            const double most_m = std::max(now.speed_mps, last.speed_mps) * model.step_s;
            if (moved_m < -kRounding_m || moved_m > most_m + kRounding_m) {
                fault(fmt::format("it moves by {} m in a step, with {} m/s before and {} m/s after it", moved_m,
                                  last.speed_mps, now.speed_mps));
            }
        }
        last = now;
        if (slot == state.blocks[at(lane)].first) return;
        const double gap_m =
            v.position_m[at(slot - 1)] - static_cast<double>(v.length_m[at(slot - 1)]) - now.position_m;
        if (gap_m < -kRounding_m) fault(fmt::format("net gap of {} m to vehicle {}", gap_m, v.id[at(slot - 1)]));
    }

    // A vehicle that has left a lane can have its rear on it. The first vehicle of the lane must stay behind this rear,
    // even if its route leads to another lane.
    void check_rears_downstream(const Model& model, const State& state, int lane) {
        const VehicleArrays& v = state.vehicles;
        const int first = state.blocks[at(lane)].first;
        for (const int next : model.graph.lanes[at(lane)].next) {
            const LaneBlock& block = state.blocks[at(next)];
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                const double rear_m = v.position_m[at(slot)] - static_cast<double>(v.length_m[at(slot)]);
                if (rear_m >= 0.0 || v.record[at(slot)].previous_lane != lane) continue;
                const double gap_m = model.graph.lanes[at(lane)].length_m + rear_m - v.position_m[at(first)];
                if (gap_m >= -kRounding_m) continue;
                report(model, state,
                       fmt::format("vehicle {} on {}: net gap of {} m to vehicle {} on {}", v.id[at(first)],
                                   model.graph.lanes[at(lane)].name, gap_m, v.id[at(slot)],
                                   model.graph.lanes[at(next)].name));
            }
        }
    }

    std::vector<Seen> seen_;  // [vehicle]
    std::string fault_;
};

}  // namespace stopline::campaign
