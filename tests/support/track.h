// A simulation under a test's control. A test places vehicles by hand and may prescribe their motion. Every step checks
// the invariants of all runs: no lost vehicle, no overlap, no red-light violation, unchanged order on a lane.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <string>
#include <vector>

#include "base/containers/index.h"
#include "driver/human.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/perception/reset_leader.h"
#include "sim/state/lane_blocks.h"
#include "sim/state/state.h"
#include "sim/step/simulation.h"

namespace stopline::testing_support {

inline constexpr double kForever_s = 1e5;

// Straight parallel lanes with one policy and one vehicle type.
struct TrackPlan {
    std::string vehicle = "petrol_eu4_72kw";
    std::string policy = "CDG";  // or the name of a population of the scenario, such as MIX
    int lanes = 1;
    double length_m = 2000.0;  // up to the stop line
    double exit_m = 500.0;
    double limit_mps = 50.0 / 3.6;
    double gradient = 0.0;
    double green_from_s = 0.0;  // kForever_s: the signal stays red
    double green_s = kForever_s;
    double step_s = 0.01;
    bool scalar = false;
    std::vector<std::string> overrides;  // overrides of scenario fields, in the form of --set
};

// Returns the population of that name, or a population whose vehicles all use the policy of that name.
inline PopulationSettings population_of(const Scenario& scenario, const std::string& name) {
    for (const PopulationSettings& population : scenario.populations) {
        if (population.name == name) return population;
    }
    return {name, {{name, 1.0}}, PopulationSettings::Pattern::alternating};
}

inline Scenario single_light(const std::string& vehicle, const std::string& policy,
                             std::vector<std::string> overrides = {}) {
    overrides.insert(overrides.begin(), "vehicle=" + vehicle);
    // A queue of vehicles longer than cars does not fit on the approach of the file.
    if (vehicle.front() != '{' && load_vehicle(vehicle).length_m > 6.0)
        overrides.emplace_back("network.approach.length=1400 m");
    Scenario scenario = load_scenario(STOPLINE_SOURCE_DIR "/scenarios/single_light.yaml", overrides);
    scenario.populations = {population_of(scenario, policy)};
    return scenario;
}

inline Scenario scenario_of(const TrackPlan& plan) {
    Scenario scenario = single_light(plan.vehicle, plan.policy, plan.overrides);
    scenario.step_s = plan.step_s;
    scenario.network.approach = {plan.lanes, plan.length_m, plan.exit_m, plan.limit_mps, plan.gradient};
    scenario.signal = {.first_green_s = plan.green_from_s, .green_s = plan.green_s};
    scenario.demand.vehicles = 0;
    return scenario;
}

// The state of one vehicle.
struct VehicleView {
    int id;
    double position_m;  // from the start of the lane
    double speed_mps;
    double acceleration_mps2;
    double request_mps2;
    double gap_m;  // net gap to the leader on the lane; 1e9 without leader
    bool is_platoon_leader;
};

class Track {
public:
    explicit Track(const TrackPlan& plan) : Track(build_model(scenario_of(plan), 0), plan.scalar) {}
    explicit Track(Model model, bool scalar = false) : model_(std::make_unique<Model>(std::move(model))) {
        model_->scalar_kernels = scalar;
        simulation_ = std::make_unique<Simulation>(*model_);
    }

    const Model& model() const { return *model_; }
    Simulation& simulation() { return *simulation_; }
    const State& state() const { return simulation_->state(); }
    // Returns the state that the engine works on, for changes by a test.
    State& mutable_state() { return const_cast<State&>(simulation_->state()); }
    double step_s() const { return model_->step_s; }
    double time_s() const { return simulation_->time_s(); }

    // Inserts a vehicle behind the last vehicle of a lane. Returns its id.
    int place(int lane, double position_m, double speed_mps, int policy = 0, int type = 0) {
        State& state = mutable_state();
        const int slot = append_slot(state, lane);
        VehicleArrays& v = state.vehicles;
        const std::size_t i = at(slot);
        const PowertrainTables& car = model_->vehicles[at(type)];
        v.position_m[i] = position_m;
        v.speed_mps[i] = speed_mps;
        v.acceleration_mps2[i] = 0.0F;
        v.length_m[i] = static_cast<float>(car.length_m);
        v.reset_powertrain(slot, car, speed_mps);
        if (v.has_powertrain()) v.gear_time_s[i] = 100.0F, v.lag_s[i] = 0.2F;
        v.is_platoon_leader[i] = 1.0F;
        v.standstill_gap_m[i] = static_cast<float>(model_->policies[at(policy)].settings.standstill_gap_m);
        v.end_speed_mps[i] = 1e3F;
        v.policy[i] = policy;
        if (v.has_several_types) v.type[i] = type;
        if (v.has_human_drivers) v.start_ticks[i] = kStartedLongAgo_ticks;
        v.id[i] = state.insertion.next_id++;
        v.record[i] = {};
        v.record[i].route = lane / 2;
        v.record[i].route_index = lane % 2;
        v.next_lane[i] = lane % 2 == 0 ? lane + 1 : -1;
        initialise_sensors(v, slot, state.blocks[at(lane)].count == 1);
        ++state.records.entered;
        return v.id[i];
    }

    // Inserts a vehicle at `front_m` and `followers` vehicles behind it, all in equilibrium.
    void place_platoon(int lane, double front_m, double speed_mps, int followers) {
        const double gap_m = equilibrium_gap_m(model_->policies[0].settings, speed_mps);
        for (int k = 0; k <= followers; ++k) {
            place(lane, front_m - k * (model_->vehicles[0].length_m + gap_m), speed_mps);
            if (k > 0) make_follower(lane, k);
        }
    }

    // Marks the k-th vehicle of a lane as a follower within a platoon.
    void make_follower(int lane, int k) { mutable_state().vehicles.is_platoon_leader[slot(lane, k)] = 0.0; }

    // Returns the slot of the k-th vehicle of a lane, counted from the front.
    std::size_t slot(int lane, int k) const { return at(state().blocks[at(lane)].first + k); }

    // Prescribes the state of a vehicle at the beginning of the next step, and the acceleration request (the commanded
    // acceleration) in the message to the follower of this vehicle.
    void drive(int lane, int k, double position_m, double speed_mps, double acceleration_mps2, double request_mps2,
               double lag_s) {
        VehicleArrays& v = mutable_state().vehicles;
        const std::size_t i = slot(lane, k);
        v.position_m[i] = position_m;
        v.speed_mps[i] = speed_mps;
        v.acceleration_mps2[i] = static_cast<float>(acceleration_mps2);
        if (!v.has_powertrain()) return;
        v.request_mps2[i] = static_cast<float>(request_mps2);
        v.lag_s[i] = static_cast<float>(lag_s);
        driven_.push_back({lane, k, request_mps2});
    }

    int count(int lane) const { return state().blocks[at(lane)].count; }

    VehicleView vehicle(int lane, int k) const {
        const VehicleArrays& v = state().vehicles;
        const std::size_t i = slot(lane, k);
        const double gap_m = k == 0 ? 1e9 : v.position_m[i - 1] - v.length_m[i - 1] - v.position_m[i];
        return {v.id[i],
                v.position_m[i],
                v.speed_mps[i],
                v.acceleration_mps2[i],
                (v.has_powertrain() ? v.request_mps2[i] : v.acceleration_mps2[i]),
                gap_m,
                v.is_platoon_leader[i] != 0.0F};
    }

    void step() {
        simulation_->step();
        // The message to the follower must carry the prescribed request, not the request of the driver model.
        for (const PrescribedRequest& driven : driven_) {
            const std::size_t message_slot = state().v2v.now + slot(driven.lane, driven.k);
            mutable_state().vehicles.v2v_request_mps2[message_slot] = static_cast<float>(driven.request_mps2);
            replace_sent_request(static_cast<int>(slot(driven.lane, driven.k)), driven.request_mps2);
        }
        driven_.clear();
        expect_invariants();
    }

    void run(double duration_s) {
        const std::int64_t end = state().tick + to_ticks(duration_s, step_s());
        while (state().tick < end) step();
    }

    // Checks the invariants. Returns at the first failure.
    void expect_invariants() const {
        const State& s = state();
        std::int64_t present = 0;
        for (const LaneBlock& block : s.blocks) {
            present += block.count;
            ASSERT_GE(block.first, block.begin);
            ASSERT_LE(block.past_last(), block.end);
            if (!model_->graph.approaches.empty()) continue;
            // Ids rise in the order of insertion. Without lane changes they rise from front to rear on each lane.
            for (int k = block.first + 1; k < block.past_last(); ++k) {
                ASSERT_LT(s.vehicles.id[at(k - 1)], s.vehicles.id[at(k)]) << "order changed at " << time_s() << " s";
            }
        }
        ASSERT_EQ(s.records.entered, s.records.exited + present) << "vehicles lost at " << time_s() << " s";
        ASSERT_EQ(s.records.violations.overlaps, 0) << "overlap at " << time_s() << " s";
        ASSERT_EQ(s.records.violations.red_entries, 0) << "passed on red at " << time_s() << " s";
        ASSERT_EQ(s.records.violations.lost_vehicles, 0) << "at " << time_s() << " s";
    }

private:
    // With a V2V channel: replaces the request of the message that a vehicle has sent in the last step, if it has.
    void replace_sent_request(int message_slot, double request_mps2) {
        VehicleArrays& v = mutable_state().vehicles;
        if (!v.has_v2v_channel) return;
        const V2vPlan& plan = model().v2v_plan;
        const int sent_tick = v.v2v.send_tick[at(message_slot)] - plan.interval_ticks;
        if (sent_tick != static_cast<int>(state().tick) - 1) return;
        const int number = (sent_tick - first_send_tick(plan, v.id[at(message_slot)])) / plan.interval_ticks;
        v.v2v.sent[v.v2v.index_of(message_slot, number)].request_mps2 = static_cast<float>(request_mps2);
    }

    struct PrescribedRequest {
        int lane, k;
        double request_mps2;
    };
    std::vector<PrescribedRequest> driven_;  // vehicles with a prescribed state in this step
    std::unique_ptr<Model> model_;
    std::unique_ptr<Simulation> simulation_;
};

// A combination of a shipped policy and a shipped vehicle.
struct Pairing {
    std::string policy;
    std::string vehicle;
};

inline std::vector<Pairing> every_pairing() {
    std::vector<Pairing> all;
    for (const GapPolicySettings& policy : load_policies()) {
        for (const std::string& vehicle : data_names("vehicles")) all.push_back({policy.name, vehicle});
    }
    return all;
}

inline bool is_human(const std::string& policy) {
    const std::vector<GapPolicySettings> policies = load_policies();
    return std::any_of(policies.begin(), policies.end(), [&](const GapPolicySettings& known) {
        return known.name == policy && find_gap_law(known.law).is_human;
    });
}

// Leaves out human drivers, who keep their gaps only roughly.
inline std::vector<Pairing> every_automated_pairing() {
    std::vector<Pairing> automated = every_pairing();
    std::erase_if(automated, [](const Pairing& pairing) { return is_human(pairing.policy); });
    return automated;
}

inline void PrintTo(const Pairing& pairing, std::ostream* out) {
    *out << pairing.policy << " with " << pairing.vehicle;
}

// Returns the parameter as a valid test name.
inline std::string as_name(const testing::TestParamInfo<std::string>& info) {
    std::string text = info.param;
    for (char& c : text) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    return text;
}
inline std::string as_pairing_name(const testing::TestParamInfo<Pairing>& info) {
    return as_name({info.param.policy + "_" + info.param.vehicle, info.index});
}

}  // namespace stopline::testing_support
