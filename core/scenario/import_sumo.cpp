#include "scenario/import_sumo.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/text_hash.h"
#include "scenario/driving_checks.h"
#include "sumo_import/sumo_graph.h"
#include "sumo_import/sumo_net.h"
#include "sumo_import/sumo_routes.h"
#include "sumo_import/xml/xml_text.h"

namespace stopline {

std::vector<FieldProblem> sumo_file_problems(const Scenario& scenario, const std::filesystem::path& directory) {
    std::vector<FieldProblem> problems;
    const NetworkSettings& network = scenario.network;
    const auto check = [&](const std::string& field, const std::string& name) {
        const std::filesystem::path file = (directory / name).lexically_normal();
        const std::string problem = sumo_file_problem(file);
        if (!problem.empty()) problems.emplace_back(field, file.generic_string() + ": " + problem);
    };
    check("network.net", network.net);
    for (std::size_t k = 0; k < network.routes.size(); ++k) {
        check("network.routes[" + std::to_string(k) + "]", network.routes[k]);
    }
    for (std::size_t k = 0; k < network.additional.size(); ++k) {
        check("network.additional[" + std::to_string(k) + "]", network.additional[k]);
    }
    return problems;
}

void import_sumo(Scenario& scenario, const std::filesystem::path& directory) {
    NetworkSettings& network = scenario.network;
    SumoNet net = read_sumo_net(directory / network.net);
    std::vector<std::filesystem::path> additional;
    for (const std::string& file : network.additional) {
        additional.push_back(directory / file);
        read_sumo_additional(additional.back(), net);
    }
    const auto sumo_network =
        std::make_shared<SumoNetwork>(make_sumo_network(std::move(net), network.intersection.clearance_m));
    network.sumo = sumo_network;
    std::vector<std::filesystem::path> routes;
    for (const std::string& file : network.routes) routes.push_back(directory / file);
    scenario.demand.sumo = std::make_shared<SumoTraffic>(read_sumo_routes(
        {additional, routes, network.vehicles == "from_routes"}, *sumo_network, scenario.duration_s, scenario.seed));
}

void add_sumo_trips(const Scenario& scenario, DemandPlan& plan) {
    const SumoTraffic& traffic = *scenario.demand.sumo;
    plan.trips = traffic.trips;
    plan.trip_turns = traffic.turns;
    plan.trip_names = {scenario.demand.sumo, &traffic.ids};
    plan.shortest_vehicle_m = traffic.shortest_vehicle_m();
    plan.seed = scenario.seed;
}

std::vector<SumoLoopPlace> sumo_loops(const Scenario& scenario) {
    std::vector<SumoLoopPlace> places;
    if (!scenario.network.sumo) return places;
    const SumoNetwork& network = *scenario.network.sumo;
    for (const SumoLoop& loop : network.net.loops) {
        const int lane = network.lane_of[static_cast<std::size_t>(loop.edge)][static_cast<std::size_t>(loop.lane)];
        places.push_back({loop.id, lane, loop.position_m});
    }
    return places;
}

std::vector<std::string> sumo_warnings(const Scenario& scenario) {
    std::vector<std::string> lines;
    if (!scenario.network.sumo || !scenario.demand.sumo) return lines;
    lines = scenario.network.sumo->net.warnings.lines();
    for (std::string& line : scenario.demand.sumo->warnings.lines()) lines.push_back(std::move(line));
    return lines;
}

std::vector<std::string> sumo_notes(const Scenario& scenario) {
    return scenario.demand.sumo ? scenario.demand.sumo->notes : std::vector<std::string>{};
}

std::vector<FieldProblem> sumo_demand_problems(const Scenario& scenario) {
    std::vector<FieldProblem> problems;
    if (!scenario.demand.sumo) return problems;
    if (scenario.demand.sumo->elements == 0) {
        problems.emplace_back("network.routes", "the files of 'routes' and 'additional' have no vehicle, trip or flow");
    }
    for (const SumoType& type : scenario.demand.sumo->types) {
        if (scenario.is_meso() || type.driving.standstill_gap_m >= kMinStandstillGap_m) continue;
        problems.emplace_back("network.vehicles",
                              fmt::format("{}: minGap=\"{:g}\" is too small: in full dynamics at least {:g} m",
                                          type.where, type.driving.standstill_gap_m, kMinStandstillGap_m));
    }
    return problems;
}

std::string sumo_demand_warning(const Scenario& scenario) {
    if (!scenario.demand.sumo || !scenario.demand.sumo->trips.empty()) return "";
    if (const std::optional<double> first_late_departure_s = scenario.demand.sumo->first_late_departure_s) {
        return fmt::format(
            "no vehicle departs: the run ends at {:g} s (duration), but the first vehicle departs at {:g} s",
            scenario.duration_s, *first_late_departure_s);
    }
    return "no vehicle departs: no vehicle has a route in this network, or the flows have 0 vehicles";
}

std::uint64_t sumo_files_hash(const Scenario& scenario) {
    if (!scenario.network.sumo || !scenario.demand.sumo) return 0;
    return extended_hash(scenario.network.sumo->net.hash, scenario.demand.sumo->hash);
}

}  // namespace stopline
