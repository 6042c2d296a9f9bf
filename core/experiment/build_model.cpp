#include "experiment/build_model.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/input_error.h"

namespace stopline {

namespace {

void add_policies(const Scenario& scenario, const PopulationSettings& population, Model& model) {
    for (const PopulationSettings::Component& component : population.components) {
        const auto named = [&](const GapPolicySettings& policy) { return policy.name == component.policy; };
        const auto found = std::find_if(scenario.policies.begin(), scenario.policies.end(), named);
        if (found == scenario.policies.end()) {
            throw InputError(fmt::format("population '{}': unknown policy '{}'", population.name, component.policy));
        }
        model.demand.policies.push_back(static_cast<int>(model.policies.size()));
        model.demand.policy_shares.push_back(component.share);
        model.policies.push_back({*found, &find_gap_law(found->law)});
    }
    using Pattern = PopulationSettings::Pattern;
    model.demand.pattern =
        population.pattern == Pattern::random ? DemandPlan::Pattern::random : DemandPlan::Pattern::alternating;
}

void add_demand(const Scenario& scenario, Model& model) {
    model.demand.entry_speed_mps = scenario.demand.entry_speed_mps;
    model.demand.seed = scenario.seed;
    for (std::size_t k = 0; k < model.graph.routes.size(); ++k) {
        model.demand.inlets.push_back({model.graph.entries[k], scenario.demand.vehicles, {static_cast<int>(k)}, {1.0}});
    }
}

void add_detectors(const Scenario& /*scenario*/, Model& model) {
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        const Lane& road = model.graph.lanes[static_cast<std::size_t>(lane)];
        if (road.signal_group >= 0) model.detectors.push_back({lane, road.stop_line_m, -1, false});
    }
}

}  // namespace

Model build_model(const Scenario& scenario, std::size_t population) {
    Model model;
    model.step_s = scenario.step_s;
    model.seed = scenario.seed;
    model.graph = make_approach(scenario.network.approach);
    model.signals.push_back(make_single_light(scenario.signal, scenario.step_s));
    model.vehicles.push_back(compile_powertrain(scenario.vehicle));
    model.driver = compile_driver(scenario.driver);
    model.hesitation_ticks = to_ticks(scenario.driver.free_drive.hesitation_s, scenario.step_s);
    // What is planned in a step is in force at its end: what has been seen by then is a step younger than now.
    model.radar = make_delay(std::max(scenario.driver.cacc.radar_delay_s - scenario.step_s, 0.0), scenario.step_s);
    model.v2v = make_delay(scenario.driver.cacc.v2v_delay_s, scenario.step_s);
    model.give_way = scenario.driver.give_way;
    add_detectors(scenario, model);
    add_policies(scenario, scenario.populations.at(population), model);
    add_demand(scenario, model);
    check(model);
    return model;
}

}  // namespace stopline
