// The kind `sumo`: a network, signals and trips from files of SUMO.
#include <algorithm>
#include <utility>

#include "network/lane_graph.h"
#include "scenario/fleets.h"
#include "scenario/kinds/kind_parts.h"
#include "sumo_import/sumo_graph.h"
#include "sumo_import/sumo_signals.h"

namespace stopline {

namespace {

std::vector<Row<NetworkSettings>> sumo_fields() {
    return {
        text<&NetworkSettings::net>("net", TextField::Rule::title,
                                    "SUMO network file, plain or gzipped, relative to the folder of the scenario")
            .required(),
        texts<&NetworkSettings::routes>("routes", TextField::Rule::title, {0, 1000},
                                        "SUMO route files with vehicles, trips, flows and vehicle types"),
        texts<&NetworkSettings::additional>("additional", TextField::Rule::title, {0, 1000},
                                            "SUMO additional files with signal programmes, offsets, induction loops, "
                                            "vehicle types and routes"),
        choice<&NetworkSettings::vehicles>(
            "vehicles", {"from_scenario", "from_routes"},
            "source of the driving behaviour; from_routes: the vehicle types in SUMO's files give maxSpeed, accel and "
            "decel, and for policies with the law constant_time also tau, minGap and (mesoscale mode) sigma; "
            "from_scenario: only lengths come from SUMO's files")};
}

void add_signals_of_sumo(const Scenario& scenario, Model& model) {
    model.signals = make_sumo_signals(*scenario.network.sumo, scenario.tick_s());
    model.priorities_by_phase = make_sumo_priorities_by_phase(*scenario.network.sumo);
    model.phase_priorities = make_sumo_phase_priorities(*scenario.network.sumo, scenario.tick_s());
}

double sumo_limit_mps(const NetworkSettings& network) {
    double highest_mps = 0.0;
    if (!network.sumo) return highest_mps;
    for (const Lane& lane : network.sumo->graph.lanes) highest_mps = std::max(highest_mps, lane.limit_mps);
    return highest_mps;
}

NominalCycle sumo_cycle(const Scenario& scenario) {
    return {scenario.network.sumo->longest_cycle_s(), scenario.network.sumo->longest_green_s()};
}

std::vector<FieldProblem> import_files(Scenario& scenario, const std::filesystem::path& directory) {
    std::vector<FieldProblem> problems = sumo_file_problems(scenario, directory);
    if (!problems.empty()) return problems;
    import_sumo(scenario, directory);
    problems = sumo_demand_problems(scenario);
    for (FieldProblem& problem : late_brake_problems(scenario)) problems.push_back(std::move(problem));
    return problems;
}

}  // namespace

extern const NetworkKind kSumoKind{
    .name = "sumo",
    .meaning = "a network with its signals and trips, imported from files of SUMO",
    .run = kRunAsNetwork,
    .has_trips = true,
    .is_exportable = false,
    .has_measured_area = true,
    .fields = sumo_fields,
    .graph = [](const NetworkSettings& network) { return network.sumo->graph; },
    .add_signals = add_signals_of_sumo,
    .add_demand = [](const Scenario& scenario, Model& model) { add_sumo_trips(scenario, model.demand); },
    .outer_legs = [](const NetworkSettings& /*network*/) { return std::vector<OuterLeg>{}; },
    .highest_limit_mps = sumo_limit_mps,
    .lane_width_m = intersection_lane_width_m,
    .check = [](const Scenario& /*scenario*/, Checker& /*check*/) {},
    .nominal_cycle = sumo_cycle,
    .import_files = import_files};

}  // namespace stopline
