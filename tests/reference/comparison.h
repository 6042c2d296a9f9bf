// Runs core/sim and the reference engine side by side, and shrinks a scenario in which they differ.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "base/containers/index.h"
#include "reference/engine.h"
#include "reference/plan.h"
#include "scenario/build_model.h"
#include "sim/state/state.h"
#include "sim/step/simulation.h"

namespace stopline::reference_engine {

// The largest differences that count as rounding.
struct Tolerance {
    double position_m = 0.0;
    double speed_mps = 0.0;
    double time_s = 0.0;  // of passages
};

// Mesoscale mode: both engines compute with doubles and differ in the order of operations only. Their rounding errors
// of about 1e-15 m grow in stop-and-go waves (stored() in world.h). Of 2000 scenarios, ten exceed the tolerance. In
// these ten, noise of 1e-13 m/s changes the run of the reference engine just as much.
inline constexpr Tolerance kMesoTolerance{1e-5, 1e-5, 1e-4};
// Full dynamics: core/sim computes accelerations with floats, whose errors are about 1e-6 m/s2. The controllers keep
// the resulting differences bounded: they are 1e-5 m in most scenarios and below 2e-4 m in 99 %, whatever the duration.
// If rounding releases the brake of a starting vehicle a step earlier, its position differs by 1e-3 m.
inline constexpr Tolerance kFullTolerance{3e-3, 3e-3, 3e-3};

// The first difference between core/sim and the reference engine.
struct Difference {
    std::int64_t step = 0;
    double time_s = 0.0;
    std::string what;
    int lane = -1;
    int vehicle = -1;
    double simulated = 0.0;
    double reference = 0.0;

    std::string text() const {
        return fmt::format(
            "step {} ({:.3f} s), lane {}, vehicle {}: {} is {:.9g} in core/sim and {:.9g} in the reference", step,
            time_s, lane, vehicle, what, simulated, reference);
    }
};

struct Comparison {
    std::optional<Difference> difference;
    std::string uncovered_event;  // the event that the reference engine does not cover, at which the run ended
    Situations situations;
    double max_position_m = 0.0;  // largest difference of a position
    double max_speed_mps = 0.0;
};

// Returns the model for a scenario. `exit_limit_mps`: speed limit of the lanes where vehicles leave; 0: as in the
// scenario. `scalar`: the kernels of core/sim compute one vehicle at a time.
inline Model model_of(const Scenario& scenario, double exit_limit_mps, bool scalar) {
    Model model = build_model(scenario, 0);
    model.scalar_kernels = scalar;
    if (exit_limit_mps <= 0.0) return model;
    for (stopline::Lane& lane : model.graph.lanes) {
        if (!lane.next.empty()) continue;
        lane.limit_mps = exit_limit_mps;
        model.has_fast_lanes |= model.speed_factor * exit_limit_mps > model.calibrated_limit_mps;
    }
    return model;
}
inline Model model_of(const Scenario& scenario, const Plan& plan) {
    return model_of(scenario, plan.exit_limit_kmh / 3.6, plan.seed % 2 == 0);
}

// Compares two runs step by step.
class SideBySide {
public:
    // Keeps references to the scenario and the model. `rules`: rules of the reference engine.
    SideBySide(const Scenario& scenario, const Model& model, const Tolerance& tolerance, const UndocumentedRules& rules)
        : tolerance_(tolerance), model_(model), simulation_(model), engine_(scenario, model, rules) {}

    // Runs both engines up to a time. Stops at the first difference, or at an event that the reference engine does not
    // cover.
    Comparison run(double until_s) {
        const std::int64_t steps = ticks_in(until_s, model_.step_s);
        compare_vehicles();
        while (engine_.tick() < steps && !result_.difference && engine_.uncovered_event().empty()) {
            simulation_.step();
            engine_.step();
            compare_holds();
            compare_vehicles();
            compare_passages();
        }
        result_.situations = engine_.situations();
        result_.uncovered_event = engine_.uncovered_event();
        return result_;
    }

private:
    // Stores a difference unless an earlier one is stored or both values are equal within `tolerance`.
    void compare(const char* what, int lane, int vehicle, double simulated, double reference, double tolerance) {
        if (result_.difference || std::abs(simulated - reference) <= tolerance) return;
        result_.difference = {engine_.tick(), engine_.time_s(), what, lane, vehicle, simulated, reference};
    }

    // Compares for each lane the vehicle that the keep-clear rule holds.
    void compare_holds() {
        for (const Lane& lane : engine_.lanes()) {
            if (lane.signal_group < 0 || lane.vehicles.empty()) continue;
            const int simulated = simulation_.state().stop_lines.lines[at(lane.number)].keep_clear_vehicle;
            const int reference = lane.is_held ? lane.stop_id : -1;
            compare("the vehicle held by the keep-clear rule", lane.number, reference, simulated, reference, 0.0);
        }
    }

    void compare_vehicles() {
        const State& state = simulation_.state();
        const VehicleArrays& v = state.vehicles;
        for (int number = 0; number < static_cast<int>(engine_.lanes().size()); ++number) {
            const Lane& lane = engine_.lanes()[at(number)];
            const LaneBlock& block = state.blocks[at(number)];
            compare("the number of vehicles", number, -1, block.count, static_cast<double>(lane.vehicles.size()), 0.0);
            if (result_.difference) return;
            for (int k = 0; k < block.count; ++k) {
                const Vehicle& own = lane.vehicles[at(k)];
                const std::size_t slot = at(block.first + k);
                compare("the id", number, own.id, v.id[slot], own.id, 0.0);
                compare("the policy", number, own.id, v.policy[slot], own.policy, 0.0);
                compare("the speed", number, own.id, v.speed_mps[slot], own.speed_mps, tolerance_.speed_mps);
                compare("the position", number, own.id, v.position_m[slot], own.position_m, tolerance_.position_m);
                compare_decisions(number, slot, own);
                if (result_.difference) return;
                result_.max_speed_mps = std::max(result_.max_speed_mps, std::abs(v.speed_mps[slot] - own.speed_mps));
                result_.max_position_m =
                    std::max(result_.max_position_m, std::abs(v.position_m[slot] - own.position_m));
            }
        }
    }

    // Compares the decisions of a vehicle.
    void compare_decisions(int lane, std::size_t slot, const Vehicle& own) {
        const VehicleArrays& v = simulation_.state().vehicles;
        const VehicleRecord& record = v.record[slot];
        const auto same = [&](const char* what, auto simulated, auto reference) {
            compare(what, lane, own.id, static_cast<double>(simulated), static_cast<double>(reference), 0.0);
        };
        same("the next lane", v.next_lane[slot], own.next_lane);
        same("the accepted gap", record.accepted_gap_on, own.accepted_gap_on);
        same("the latest step of yielding", record.yield_tick, own.yield_tick);
        same("the step of entering the intersection", record.junction_entry_tick, own.entry_tick);
    }

    // Compares the passages of this step. Passages of vehicles that enter the network are left out.
    void compare_passages() {
        const std::vector<Passage>& all = simulation_.state().records.passages;
        for (; next_passage_ < all.size(); ++next_passage_) {
            const Passage& simulated = all[next_passage_];
            if (simulated.from_lane < 0) continue;
            if (next_own_ == engine_.passages().size())
                return compare("the number of passages", simulated.from_lane, simulated.vehicle, 1.0, 0.0, 0.0);
            const LanePassage& own = engine_.passages()[next_own_++];
            compare("the lane of a passage", own.from_lane, own.vehicle, simulated.from_lane, own.from_lane, 0.0);
            compare("the vehicle of a passage", own.from_lane, own.vehicle, simulated.vehicle, own.vehicle, 0.0);
            compare("the time of a passage", own.from_lane, own.vehicle, simulated.time_s, own.time_s,
                    tolerance_.time_s);
        }
        compare("the number of passages", -1, -1, static_cast<double>(next_own_),
                static_cast<double>(engine_.passages().size()), 0.0);
    }

    Tolerance tolerance_;
    const Model& model_;
    Simulation simulation_;
    Engine engine_;
    std::size_t next_passage_ = 0;
    std::size_t next_own_ = 0;
    Comparison result_;
};

inline Comparison compare_engines(const Plan& plan, const Tolerance& tolerance, const UndocumentedRules& rules = {}) {
    const Scenario scenario = scenario_of(plan);
    const Model model = model_of(scenario, plan);
    return SideBySide(scenario, model, tolerance, rules).run(scenario.duration_s);
}

// Returns true if rounding alone can explain a difference after `steps` steps. A decision, such as a gear change or the
// release of a brake, can depend on the last digit of a value. core/sim rounds differently, so it may decide otherwise.
// The function repeats the run of the reference engine with noise of the size of rounding errors. It returns true if a
// run with noise differs from the run without noise by more than half of the tolerance.
inline bool is_decided_by_rounding(const Scenario& scenario, const Model& model, std::int64_t steps,
                                   const Tolerance& tolerance, const UndocumentedRules& rules = {}) {
    constexpr std::uint64_t kRuns = 40;
    const auto run = [&](std::uint64_t seed) {
        const double amplitude = (scenario.is_meso() ? 1e-13 : 5e-5) * (seed % 2 == 0 ? 1.0 : 4.0);
        Engine engine(scenario, model, rules, {seed == 0 ? 0.0 : amplitude, seed});
        while (engine.tick() < steps) engine.step();
        return engine.lanes();
    };
    const std::vector<Lane> exact = run(0);
    for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
        const std::vector<Lane> noisy = run(seed);
        for (std::size_t lane = 0; lane < exact.size(); ++lane) {
            const std::deque<Vehicle>& a = exact[lane].vehicles;
            const std::deque<Vehicle>& b = noisy[lane].vehicles;
            if (a.size() != b.size()) return true;
            for (std::size_t k = 0; k < a.size(); ++k) {
                if (std::abs(a[k].position_m - b[k].position_m) > 0.5 * tolerance.position_m) return true;
                if (std::abs(a[k].speed_mps - b[k].speed_mps) > 0.5 * tolerance.speed_mps) return true;
            }
        }
    }
    return false;
}

inline bool is_decided_by_rounding(const Plan& plan, std::int64_t steps, const Tolerance& tolerance,
                                   const UndocumentedRules& rules = {}) {
    const Scenario scenario = scenario_of(plan);
    return is_decided_by_rounding(scenario, model_of(scenario, plan), steps, tolerance, rules);
}

}  // namespace stopline::reference_engine
