// Random scenarios for the comparison of core/sim with the reference engine. A Plan holds the values that vary. It is
// converted to YAML text, and the scenario is read from this text. So a test can print the scenario as YAML.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "reference/world.h"
#include "scenario/load_scenario.h"

namespace stopline::reference_engine {

struct Plan {
    struct Component {
        std::string policy;
        double share_percent = 100.0;
    };
    std::uint64_t seed = 1;
    double duration_s = 60.0;
    // Name of a file in data/meso; empty: full dynamics.
    std::string meso;
    double step_s = 0.1;
    double dawdling = -1.0;    // of both car-following models; below 0: that of the file
    bool is_crossing = false;  // two streets with one lane for each direction; else a straight road
    int lanes = 1;             // of the straight road
    double length_m = 300.0;
    double exit_m = 200.0;
    double limit_kmh = 50.0;
    double exit_limit_kmh = 0.0;  // speed limit of the exit lanes; 0: limit_kmh
    double gradient_percent = 0.0;
    double first_green_s = 10.0;
    double green_s = 20.0;
    double yellow_s = 3.0;
    double cycle_s = 60.0;     // straight road; 0: one green, then red
    bool keeps_clear = false;  // crossing
    double all_red_s = 0.0;    // crossing
    std::string demand = "queue";
    int vehicles = 5;
    double inflow_vehph = 600.0;  // of one lane
    double entry_kmh = 50.0;
    bool starts_queued = false;
    std::string vehicle = "petrol_eu4_72kw";
    double radar_delay_ms = 150.0;
    double v2v_delay_ms = 20.0;
    double hesitation_s = 0.0;
    double stop_margin_m = 1.0;
    double stop_mps2 = 2.5;      // deceleration before a stop
    double decision_mps2 = 3.5;  // a vehicle stops at yellow if this deceleration suffices
    std::vector<Component> components{{"CDG", 100.0}};
    std::string pattern = "alternating";
};

// Returns the definition of a policy that is not in data/policies; empty for the others.
inline std::string own_policy_yaml(const std::string& name) {
    if (name == "PROGRESSIVE") {
        return "policies:\n- {name: PROGRESSIVE, law: formula, standstill_gap: 2.95 m, "
               "gap: s0 + 0.4 s * v + 0.01 s2/m * v^2, mesoscale: time_gap}\n";
    }
    if (name == "MEASURED") {
        return "policies:\n- {name: MEASURED, law: table, standstill_gap: 2.95 m, "
               "gaps: {20 km/h: 3.5 m, 50 km/h: 9 m}, mesoscale: constant_distance}\n";
    }
    return "";
}

inline std::string yaml_of(const Plan& p) {
    std::string text = fmt::format("seed: {}\nduration: {} s\n", p.seed, p.duration_s);
    if (p.meso.empty()) {
        text += fmt::format("step: {} s\n", p.step_s);
    } else {
        const std::string dawdling =
            p.dawdling < 0.0
                ? ""
                : fmt::format(", constant_time: {{dawdling: {0}}}, constant_distance: {{dawdling: {0}}}", p.dawdling);
        text += fmt::format("fidelity: meso\nmeso: {{base: {}, step: {} s{}}}\n", p.meso, p.step_s, dawdling);
    }
    if (p.is_crossing) {
        text += fmt::format(
            "network:\n  kind: intersection\n  intersection: {{lanes: [{{movements: straight}}], "
            "approach_length: {} m, exit_length: {} m, speed_limit: {} km/h}}\n",
            p.length_m, p.exit_m, p.limit_kmh);
        text += fmt::format("signal: {{first_green: {} s, green: {} s, yellow: {} s, all_red: {} s}}\n",
                            p.first_green_s, p.green_s, p.yellow_s, p.all_red_s);
        text += fmt::format("rules: {{keep_clear: {}}}\nmeasure: {{warmup_cycles: 0}}\n", p.keeps_clear ? "on" : "off");
    } else {
        text += fmt::format(
            "network:\n  kind: approach\n  approach: {{lanes: {}, length: {} m, exit_length: {} m, speed_limit: {} "
            "km/h, gradient: {} %}}\n",
            p.lanes, p.length_m, p.exit_m, p.limit_kmh, p.gradient_percent);
        text += fmt::format("signal: {{first_green: {} s, green: {} s, yellow: {} s, cycle: {} s, all_red: 0 s}}\n",
                            p.first_green_s, p.green_s, p.yellow_s, p.cycle_s);
    }
    if (p.exit_limit_kmh > 0.0)
        text += fmt::format("# The exit lanes have a speed limit of {} km/h. YAML cannot say so.\n", p.exit_limit_kmh);
    text += fmt::format("demand: {{kind: {}, entry_speed: {} km/h, start: {}", p.demand, p.entry_kmh,
                        p.starts_queued ? "queued" : "empty");
    if (p.demand == "queue") text += fmt::format(", vehicles: {}", p.vehicles);
    if (p.demand == "rate") text += fmt::format(", inflow: {} veh/h", p.inflow_vehph * p.lanes);
    text += fmt::format(
        "}}\nvehicle: {}\ndriver:\n  base: startup_kit\n  cacc: {{radar_delay: {} ms, v2v_delay: {} ms}}\n"
        "  free_drive: {{hesitation: {} s}}\n"
        "  stop: {{margin: {} m, deceleration: {} m/s2, decision_deceleration: {} m/s2}}\n",
        p.vehicle, p.radar_delay_ms, p.v2v_delay_ms, p.hesitation_s, p.stop_margin_m, p.stop_mps2, p.decision_mps2);
    for (const Plan::Component& component : p.components) text += own_policy_yaml(component.policy);
    text += fmt::format("populations:\n- name: all\n  pattern: {}\n  components:\n", p.pattern);
    for (const Plan::Component& component : p.components) {
        text += fmt::format("  - {{policy: {}, share: {} %}}\n", component.policy, component.share_percent);
    }
    return text;
}

// Throws InputError if the plan is no valid scenario.
inline Scenario scenario_of(const Plan& plan) { return parse_scenario(yaml_of(plan), "plan"); }
inline Road road_of(const Plan& plan) { return {plan.exit_limit_kmh / 3.6}; }

// Draws random plans.
class PlanDraw {
public:
    explicit PlanDraw(std::uint64_t seed) : random_(seed) {}

    Plan mesoscale() {
        Plan p = road_and_signal();
        p.meso = one_of({"table2", "fitted", "passages", "start", "start_passages"});
        p.step_s = chance(50) ? 0.1 : chance(50) ? 0.05 : 0.2;
        p.duration_s = number(30, 110);
        if (chance(30)) p.dawdling = number(0, 8) / 10.0;
        add_demand(p, 14);
        return p;
    }

    Plan full_dynamics() {
        Plan p = road_and_signal();
        p.step_s = chance(20) ? 0.02 : 0.01;
        p.duration_s = number(15, 45);
        p.first_green_s = number(0, 8);
        if (chance(40)) p.radar_delay_ms = number(0, 50) * 5.0;
        if (chance(40)) p.v2v_delay_ms = 20.0 + number(0, 60);
        if (chance(25)) p.gradient_percent = number(-6, 6);
        add_demand(p, 7);
        return p;
    }

    // Two streets that cross. Short clearance times make vehicles of both streets meet.
    Plan crossing(bool is_mesoscale) {
        Plan p = is_mesoscale ? mesoscale() : full_dynamics();
        p.is_crossing = true;
        p.lanes = 1;
        p.gradient_percent = 0.0;
        p.keeps_clear = chance(50);
        // At 3 km/h, the exit lanes count as jammed.
        p.exit_limit_kmh = chance(40) ? 3.0 : 0.0;
        p.length_m = std::max(p.length_m, 50.0);
        p.green_s = number(3, 50) / 5.0;
        p.yellow_s = number(0, 10) / 5.0;
        p.all_red_s = number(0, 8) / 5.0;
        const double cycle_s = 2.0 * (p.green_s + p.yellow_s + p.all_red_s);
        p.duration_s = std::ceil(std::max(p.duration_s, p.first_green_s + cycle_s + 1.0));
        return p;
    }

private:
    int number(int from, int to) { return from + static_cast<int>(random_() % static_cast<unsigned>(to - from + 1)); }
    bool chance(int percent) { return number(1, 100) <= percent; }
    std::string one_of(const std::vector<std::string>& names) {
        return names[static_cast<std::size_t>(number(0, static_cast<int>(names.size()) - 1))];
    }

    // Returns the sum of three times that are multiples of 0.1 s. Removes the rounding errors of the addition.
    static double sum(double a_s, double b_s, double c_s) { return std::round(10.0 * (a_s + b_s + c_s)) / 10.0; }

    Plan road_and_signal() {
        Plan p;
        p.seed = static_cast<std::uint64_t>(number(1, 1'000'000));
        p.length_m = number(60, 400);
        p.exit_m = number(30, 300);
        p.limit_kmh = chance(50) ? 50.0 : number(3, 10) * 10.0;
        if (chance(20)) p.exit_limit_kmh = number(2, 9) * 10.0;
        p.first_green_s = number(0, 125) / 5.0;
        p.green_s = number(10, 125) / 5.0;
        p.yellow_s = number(0, 20) / 5.0;
        p.cycle_s = chance(75) ? sum(p.green_s, p.yellow_s, number(10, 150) / 5.0) : 0.0;
        if (chance(30)) p.hesitation_s = number(1, 15) / 10.0;
        if (chance(20)) p.stop_margin_m = number(1, 40) / 10.0;
        if (chance(20)) p.stop_mps2 = number(15, 35) / 10.0;
        if (chance(20)) p.decision_mps2 = number(25, 60) / 10.0;
        p.vehicle = one_of({"petrol_eu4_72kw", "petrol_eu4_84kw", "diesel_eu4_103kw", "electric_100kw"});
        return p;
    }

    void add_demand(Plan& p, int most_vehicles) {
        p.lanes = chance(20) ? number(2, 3) : 1;
        p.demand = one_of({"queue", "queue", "saturated", "rate"});
        p.vehicles = number(1, most_vehicles);
        p.starts_queued = chance(p.demand == "rate" ? 10 : 25);
        p.entry_kmh = chance(70) ? p.limit_kmh : number(1, 5) * 10.0;
        p.inflow_vehph = number(2, 30) * 60.0;
        if (p.demand == "queue") p.length_m = std::max(p.length_m, 12.0 * p.vehicles + 1.0);
        if (p.demand == "saturated" || p.starts_queued) p.length_m = std::min(p.length_m, 15.0 * most_vehicles);
        // The length must suffice to stop from the entry speed.
        p.length_m = std::max(p.length_m, 20.0 + std::ceil(0.04 * p.entry_kmh * p.entry_kmh));
        add_policies(p);
    }

    void add_policies(Plan& p) {
        static const std::vector<std::string> kPolicies{"CDG",     "CDG-6m",   "CTG-Ref",     "CTG-HCM",
                                                        "CTG-HBS", "SWITCH-1", "SWITCH-1-6m", "SWITCH-2"};
        const int components = chance(50) ? 1 : number(2, 3);
        p.components.clear();
        for (int k = 0; k < components; ++k) {
            const double share_percent = k + 1 == components ? 100.0 - 30.0 * k : 30.0;
            p.components.push_back({one_of(kPolicies), share_percent});
        }
        if (chance(15)) p.components.front().policy = one_of({"PROGRESSIVE", "MEASURED"});
        p.pattern = one_of({"alternating", "random", "balanced"});
    }

    std::mt19937_64 random_;
};

}  // namespace stopline::reference_engine
