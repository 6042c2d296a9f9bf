// Scenarios for the comparison of core/sim with the reference engine. A Plan holds the values that vary. It is
// converted to YAML text, and the scenario is read from this text. So a test can print the scenario as YAML.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "reference/world.h"
#include "scenario/load_scenario.h"
#include "support/sumo_files.h"

namespace stopline::reference_engine {

struct Plan {
    struct Component {
        std::string policy;
        double share_percent = 100.0;
        std::string vehicle = {};  // empty: that of the plan
        std::string driver = {};
    };
    // A vehicle on a trip through an imported network.
    struct TripPlan {
        double depart_s = 0.0;
        std::string from;
        std::string to;
        std::string speed = "max";  // departSpeed of SUMO
        std::string lane = "best";  // departLane of SUMO
    };
    enum class Roads { straight, intersection, grid, streets, imported };

    std::uint64_t seed = 1;
    double duration_s = 60.0;
    // Name of a file in data/meso; empty: full dynamics.
    std::string meso;
    double step_s = 0.1;
    double dawdling = -1.0;  // of both car-following models; below 0: that of the file

    Roads roads = Roads::straight;
    int lanes = 1;                       // straight road
    std::vector<std::string> movements;  // intersection: those of each lane of an approach, from the left
    std::string streets;                 // YAML text
    std::string net;                     // imported network: a file in tests/data
    std::vector<TripPlan> trips;         // imported network
    double spacing_m = 200.0;            // grid of two intersections: distance of their centres
    double length_m = 300.0;
    double exit_m = 200.0;
    double limit_kmh = 50.0;
    double exit_limit_kmh = 0.0;  // speed limit of the exit lanes; 0: limit_kmh
    double gradient_percent = 0.0;

    double first_green_s = 10.0;
    double green_s = 20.0;
    double yellow_s = 3.0;
    double cycle_s = 60.0;     // straight road; 0: one green, then red
    double all_red_s = 0.0;    // intersection
    bool keeps_clear = false;  // not on a straight road
    std::string demand = "queue";
    int vehicles = 5;
    double inflow_vehph = 600.0;  // of one lane
    double left_percent = 0.0;    // intersection
    double right_percent = 0.0;
    double entry_kmh = 50.0;
    bool starts_queued = false;

    std::string vehicle = "petrol_eu4_72kw";
    double radar_delay_ms = 150.0;
    double v2v_delay_ms = 20.0;
    double hesitation_s = 0.0;
    double stop_margin_m = 1.0;
    double stop_mps2 = 2.5;      // deceleration before a stop
    double decision_mps2 = 3.5;  // a vehicle stops at yellow if this deceleration suffices
    double critical_gap_s = 5.0;
    double critical_lag_s = 0.0;       // 0: follows from critical_gap_s
    double gap_share_percent = 100.0;  // of lane changes
    double politeness = 0.0;           // of lane changes
    double keep_right_mps2 = 0.0;
    std::string gap_opening = "on";
    int max_platoon = 0;      // largest number of vehicles of a platoon; 0: no limit
    double reaction_s = 1.0;  // of human drivers
    double gap_error = 0.05;
    std::vector<Component> components{{"CDG", 100.0}};
    std::string pattern = "alternating";
};

// Returns the definition of a policy that is not in data/policies; empty for the others.
inline std::string own_policy_yaml(const std::string& name) {
    if (name == "PROGRESSIVE") {
        return "- {name: PROGRESSIVE, law: formula, standstill_gap: 2.95 m, "
               "gap: s0 + 0.4 s * v + 0.01 s2/m * v^2, mesoscale: time_gap}\n";
    }
    if (name == "MEASURED") {
        return "- {name: MEASURED, law: table, standstill_gap: 2.95 m, "
               "gaps: {20 km/h: 3.5 m, 50 km/h: 9 m}, mesoscale: constant_distance}\n";
    }
    if (name == "IDM") {
        return "- {name: IDM, law: constant_time, time_gap: 1.2 s, standstill_gap: 2.2 m, mesoscale: idm}\n";
    }
    return "";
}

inline std::string network_yaml(const Plan& p) {
    std::string text;
    if (p.roads == Plan::Roads::straight) {
        text += fmt::format(
            "network:\n  kind: approach\n  approach: {{lanes: {}, length: {} m, exit_length: {} m, speed_limit: {} "
            "km/h, gradient: {} %}}\n",
            p.lanes, p.length_m, p.exit_m, p.limit_kmh, p.gradient_percent);
        text += fmt::format("signal: {{first_green: {} s, green: {} s, yellow: {} s, cycle: {} s, all_red: 0 s}}\n",
                            p.first_green_s, p.green_s, p.yellow_s, p.cycle_s);
        return text;
    }
    if (p.roads == Plan::Roads::intersection || p.roads == Plan::Roads::grid) {
        std::vector<std::string> lanes;
        for (const std::string& movements : p.movements) lanes.push_back("{movements: " + movements + "}");
        text += fmt::format(
            "network:\n  kind: {}\n  intersection: {{lanes: [{}], approach_length: {} m, exit_length: {} m, "
            "speed_limit: {} km/h}}\n",
            p.roads == Plan::Roads::grid ? "grid" : "intersection", fmt::join(lanes, ", "), p.length_m, p.exit_m,
            p.limit_kmh);
        if (p.roads == Plan::Roads::grid)
            text += fmt::format("  grid: {{columns: 2, rows: 1, column_spacing: {} m}}\n", p.spacing_m);
        text += fmt::format("signal: {{first_green: {} s, green: {} s, yellow: {} s, all_red: {} s}}\n",
                            p.first_green_s, p.green_s, p.yellow_s, p.all_red_s);
        text += p.roads == Plan::Roads::grid ? "measure: {window: 1 s}\n" : "measure: {warmup_cycles: 0}\n";
    } else if (p.roads == Plan::Roads::streets) {
        text += "network:\n  kind: streets\n  streets:\n" + p.streets + "measure: {window: 1 s}\n";
    } else {
        text += "network: {kind: sumo, net: " STOPLINE_TEST_DATA_DIR "/" + p.net +
                ", routes: [./plan.rou.xml]}\nmeasure: {window: 1 s}\n";
    }
    return text + fmt::format("rules: {{keep_clear: {}}}\n", p.keeps_clear ? "on" : "off");
}

inline std::string demand_yaml(const Plan& p) {
    if (p.roads == Plan::Roads::imported) return "";
    std::string text = fmt::format("demand: {{kind: {}, entry_speed: {} km/h, start: {}", p.demand, p.entry_kmh,
                                   p.starts_queued ? "queued" : "empty");
    const auto lanes = !p.movements.empty() ? static_cast<int>(p.movements.size()) : p.lanes;
    if (p.demand == "queue") text += fmt::format(", vehicles: {}", p.vehicles);
    if (p.demand == "rate") text += fmt::format(", inflow: {} veh/h", p.inflow_vehph * lanes);
    if (p.left_percent > 0.0) text += fmt::format(", left: {} %", p.left_percent);
    if (p.right_percent > 0.0) text += fmt::format(", right: {} %", p.right_percent);
    return text + "}\n";
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
    text += network_yaml(p);
    if (p.exit_limit_kmh > 0.0)
        text += fmt::format("# The exit lanes have a speed limit of {} km/h. YAML cannot say so.\n", p.exit_limit_kmh);
    text += demand_yaml(p);
    text += fmt::format(
        "vehicle: {}\ndriver:\n  base: startup_kit\n  cacc: {{radar_delay: {} ms, v2v_delay: {} ms}}\n"
        "  free_drive: {{hesitation: {} s}}\n"
        "  stop: {{margin: {} m, deceleration: {} m/s2, decision_deceleration: {} m/s2}}\n"
        "  give_way: {{critical_gap: {} s, critical_lag: {} s}}\n"
        "  lane_change: {{gap_share: {} %, politeness: {}, keep_right: {} m/s2, gap_opening: {}}}\n"
        "  human: {{reaction: {} s, gap_error: {}}}\n",
        p.vehicle, p.radar_delay_ms, p.v2v_delay_ms, p.hesitation_s, p.stop_margin_m, p.stop_mps2, p.decision_mps2,
        p.critical_gap_s, p.critical_lag_s, p.gap_share_percent, p.politeness, p.keep_right_mps2, p.gap_opening,
        p.reaction_s, p.gap_error);
    if (p.max_platoon > 0) text += fmt::format("  platoon: {{max_vehicles: {}}}\n", p.max_platoon);
    std::string policies;
    for (const Plan::Component& component : p.components) {
        const std::string own = own_policy_yaml(component.policy);
        if (policies.find(own) == std::string::npos) policies += own;
    }
    if (!policies.empty()) text += "policies:\n" + policies;
    text += fmt::format("populations:\n- name: all\n  pattern: {}\n  components:\n", p.pattern);
    for (const Plan::Component& component : p.components) {
        text += fmt::format("  - {{policy: {}, share: {} %", component.policy, component.share_percent);
        if (!component.vehicle.empty()) text += ", vehicle: " + component.vehicle;
        if (!component.driver.empty()) text += ", driver: " + component.driver;
        text += "}\n";
    }
    return text;
}

// Returns the route file of an imported network.
inline std::string routes_of(const Plan& p) {
    std::string text = "<routes>\n";
    for (std::size_t k = 0; k < p.trips.size(); ++k) {
        const Plan::TripPlan& trip = p.trips[k];
        text += fmt::format(
            "    <trip id=\"{}\" depart=\"{}\" from=\"{}\" to=\"{}\" departSpeed=\"{}\" departLane=\"{}\"/>\n", k,
            trip.depart_s, trip.from, trip.to, trip.speed, trip.lane);
    }
    return text + "</routes>\n";
}

// Throws InputError if the plan is no valid scenario.
inline Scenario scenario_of(const Plan& plan) {
    if (plan.roads != Plan::Roads::imported) return parse_scenario(yaml_of(plan), "plan");
    const testing::SumoFiles files;
    files.write("plan.rou.xml", routes_of(plan));
    return parse_scenario(yaml_of(plan), "plan", {}, files.folder());
}

}  // namespace stopline::reference_engine
