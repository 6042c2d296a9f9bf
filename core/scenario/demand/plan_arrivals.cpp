#include "scenario/demand/plan_arrivals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "demand/arrivals.h"
#include "demand/route_search.h"
#include "demand/traffic_table.h"

namespace stopline {

namespace {

constexpr std::array<Turn, 3> kTurnColumns{Turn::left, Turn::straight,
                                           Turn::right};  // in the order of TrafficRow::turns

ArrivalProcess process_of(const DemandSettings& demand) {
    if (demand.arrivals == "poisson") return {ArrivalProcess::Kind::poisson, 1.0, 0.0};
    if (demand.arrivals == "even") return {};
    return {ArrivalProcess::Kind::platooned, demand.platoon_size, demand.platoon_headway_s};
}

// Returns the arrival rate over time of a lane with the constant rate `rate_1ps` and the profile of the demand.
ArrivalRate profiled_rate(const DemandSettings& demand, double rate_1ps, double end_s) {
    ArrivalRate rate;
    const std::vector<ProfilePoint>& points = demand.profile;
    if (points.empty()) rate.append(end_s, rate_1ps, rate_1ps);
    for (std::size_t k = 0; k < points.size() && points[k].from_s < end_s; ++k) {
        const bool is_last = k + 1 == points.size();
        const double begin_1ps = rate_1ps * points[k].inflow;
        const double next_1ps =
            is_last || demand.profile_shape == "steps" ? begin_1ps : rate_1ps * points[k + 1].inflow;
        const double until_s = is_last ? end_s : std::min(points[k + 1].from_s, end_s);
        const double reached = is_last ? 1.0 : (until_s - points[k].from_s) / (points[k + 1].from_s - points[k].from_s);
        rate.append(until_s, begin_1ps, begin_1ps + reached * (next_1ps - begin_1ps));
    }
    return rate;
}

// The lanes of the network where vehicles enter, by the name of their leg.
class EntryLanes {
public:
    explicit EntryLanes(const Model& model) : model_(model) {
        for (int k = 0; k < static_cast<int>(model.demand.inlets.size()); ++k) {
            if (model.demand.inlets[at(k)].vehicles > 0) inlets_[leg_of(k)].push_back(k);
        }
    }

    // Returns the inlets on the lanes of a leg, from the left.
    const std::vector<int>& of(const std::string& leg) const { return inlets_.at(leg); }
    std::string leg_of(int inlet) const { return leg_name(model_.graph.lanes[at(lane_of(inlet))].name); }

    // Returns the inlets of a leg from which vehicles make a turn: those on lanes that allow the turn. If only turn
    // pockets allow it: the inlet nearest to them.
    std::vector<int> with_turn(const std::string& leg, Turn turn) const {
        std::vector<int> allowing;
        const std::vector<int>& inlets = of(leg);
        for (const int inlet : inlets) {
            if (route_on(lane_of(inlet), turn) >= 0) allowing.push_back(inlet);
        }
        const int approach = model_.graph.lanes[at(lane_of(inlets.front()))].approach;
        if (!allowing.empty() || approach < 0) return allowing;
        const std::vector<int>& lanes = model_.graph.approaches[at(approach)].lanes;
        const auto index = [&](int lane) { return std::find(lanes.begin(), lanes.end(), lane) - lanes.begin(); };
        for (const int lane : lanes) {
            if (route_on(lane, turn) < 0) continue;
            return {*std::min_element(inlets.begin(), inlets.end(), [&](int a, int b) {
                return std::abs(index(lane_of(a)) - index(lane)) < std::abs(index(lane_of(b)) - index(lane));
            })};
        }
        return {};
    }

    // Returns the route with a turn that begins on the lane of the inlet, or else on another lane of its approach.
    int route(int inlet, Turn turn) const {
        const int own = route_on(lane_of(inlet), turn);
        const int approach = model_.graph.lanes[at(lane_of(inlet))].approach;
        if (own >= 0 || approach < 0) return own;
        for (const int lane : model_.graph.approaches[at(approach)].lanes) {
            if (const int other = route_on(lane, turn); other >= 0) return other;
        }
        return -1;
    }

private:
    int lane_of(int inlet) const { return model_.demand.inlets[at(inlet)].lane; }
    int route_on(int lane, Turn turn) const {
        for (int route = 0; route < static_cast<int>(model_.graph.routes.size()); ++route) {
            const std::vector<int>& lanes = model_.graph.routes[at(route)].lanes;
            if (lanes[0] == lane && model_.graph.lanes[at(lanes[1])].turn == turn) return route;
        }
        return -1;
    }

    const Model& model_;
    std::map<std::string, std::vector<int>> inlets_;
};

// Vehicles that share their path. They can enter on any of the inlets.
struct VehicleGroup {
    std::vector<int> inlets;
    std::vector<int> paths;  // [inlet in `inlets`] start in DemandPlan::path_routes; -1: no path
    std::int64_t vehicles = 0;
};

// Plans the vehicles of a traffic table.
class TablePlanner {
public:
    TablePlanner(const Scenario& scenario, Model& model)
        : scenario_(scenario), model_(model), entries_(model), process_(process_of(scenario.demand)) {}

    void plan() {
        const std::vector<TrafficRow>& rows = scenario_.demand.table->rows;
        // Rows of one interval and origin are planned together, because their vehicles share lanes.
        std::map<std::pair<double, std::string>, std::vector<const TrafficRow*>> by_interval;
        for (const TrafficRow& row : rows) by_interval[{row.from_s, row.origin}].push_back(&row);
        for (const auto& [interval, members] : by_interval) {
            std::vector<VehicleGroup> groups;
            for (const TrafficRow* row : members) add_groups(*row, groups);
            plan_interval(*members.front(), std::move(groups));
        }
    }

private:
    // Scales a number of vehicles. The fractions that rounding leaves are carried over to the next number with the same
    // name, so that no vehicles are lost over several intervals.
    std::int64_t scaled(std::int64_t vehicles, const std::string& name) {
        double& carried = carried_[name];
        const double exact = static_cast<double>(vehicles) * scenario_.demand.scale + carried;
        const double whole = std::floor(exact + 0.5);
        carried = exact - whole;
        return static_cast<std::int64_t>(std::max(whole, 0.0));
    }

    int add_path(const std::vector<int>& routes) {
        const auto [known, is_new] =
            known_paths_.try_emplace(routes, static_cast<int>(model_.demand.path_routes.size()));
        if (is_new) {
            std::vector<int>& all = model_.demand.path_routes;
            all.insert(all.end(), routes.begin(), routes.end());
            all.push_back(-1);
        }
        return known->second;
    }

    void add_group(const std::string& leg, Turn turn, const std::vector<int>& later_routes, std::int64_t vehicles,
                   std::vector<VehicleGroup>& groups) {
        VehicleGroup group{entries_.with_turn(leg, turn), {}, vehicles};
        for (const int inlet : group.inlets) {
            std::vector<int> routes{entries_.route(inlet, turn)};
            routes.insert(routes.end(), later_routes.begin(), later_routes.end());
            group.paths.push_back(add_path(routes));
        }
        groups.push_back(std::move(group));
    }

    void add_groups(const TrafficRow& row, std::vector<VehicleGroup>& groups) {
        if (!row.destination.empty()) {
            const std::vector<int> routes = path_between(row.origin, row.destination);
            const Turn turn = model_.graph.lanes[at(model_.graph.routes[at(routes[0])].lanes[1])].turn;
            const std::int64_t vehicles = scaled(row.vehicles, row.origin + " " + row.destination);
            return add_group(row.origin, turn, {routes.begin() + 1, routes.end()}, vehicles, groups);
        }
        if (!row.turns) {
            const std::vector<int>& inlets = entries_.of(row.origin);
            groups.push_back({inlets, std::vector<int>(inlets.size(), -1), scaled(row.vehicles, row.origin)});
            return;
        }
        for (std::size_t k = 0; k < kTurnColumns.size(); ++k) {
            const std::int64_t vehicles = scaled((*row.turns)[k], fmt::format("{} {}", row.origin, k));
            if (vehicles > 0) add_group(row.origin, kTurnColumns[k], {}, vehicles, groups);
        }
    }

    std::vector<int> path_between(const std::string& origin, const std::string& destination) {
        const int lane = model_.demand.inlets[at(entries_.of(origin).front())].lane;
        const int approach = model_.graph.lanes[at(lane)].approach;
        const auto paths = paths_from_.try_emplace(approach, model_.graph, approach).first;
        return paths->second.to(destination)->routes;  // read_traffic_file() refuses pairs without a way
    }

    // Distributes the vehicles of an interval over the lanes of their approach, so that all lanes carry equal traffic
    // as far as the turns allow. Groups with few lanes to choose from come first.
    void plan_interval(const TrafficRow& row, std::vector<VehicleGroup> groups) {
        std::stable_sort(groups.begin(), groups.end(), [](const VehicleGroup& a, const VehicleGroup& b) {
            return a.inlets.size() < b.inlets.size();
        });
        std::map<int, std::vector<int>> paths;  // [inlet] path of each vehicle
        for (const int inlet : entries_.of(row.origin)) paths[inlet];
        for (const VehicleGroup& group : groups) {
            for (std::int64_t k = 0; k < group.vehicles; ++k) {
                const auto least = std::min_element(group.inlets.begin(), group.inlets.end(),
                                                    [&](int a, int b) { return paths[a].size() < paths[b].size(); });
                paths[*least].push_back(group.paths[static_cast<std::size_t>(least - group.inlets.begin())]);
            }
        }
        for (const auto& [inlet, of_vehicles] : paths) plan_lane(row, inlet, of_vehicles);
    }

    void plan_lane(const TrafficRow& row, int number, const std::vector<int>& paths) {
        DemandPlan::Inlet& inlet = model_.demand.inlets[at(number)];
        const ArrivalKey key{scenario_.seed, number};
        const auto count = static_cast<std::int64_t>(paths.size());
        const double headways_s = static_cast<double>(count) * process_.platoon_headway_s;
        if (headways_s >= row.to_s - row.from_s) {
            throw PlatoonsDoNotFit(fmt::format(
                "{:g} s is too long for the {} vehicles that arrive on "
                "lane '{}' between {:g} s and {:g} s",
                process_.platoon_headway_s, count, model_.graph.lanes[at(inlet.lane)].name, row.from_s, row.to_s));
        }
        const CountedArrivals counted{row.from_s, row.to_s, count, static_cast<std::int64_t>(inlet.arrivals_s.size())};
        const std::vector<double> times_s = counted_arrival_times(process_, counted, key);
        inlet.arrivals_s.insert(inlet.arrivals_s.end(), times_s.begin(), times_s.end());
        for (const std::int64_t k : random_order(count, counted.first, key)) {
            inlet.paths.push_back(paths[static_cast<std::size_t>(k)]);
        }
    }

    const Scenario& scenario_;
    Model& model_;
    EntryLanes entries_;
    ArrivalProcess process_;
    std::map<std::string, double> carried_;
    std::map<std::vector<int>, int> known_paths_;  // [routes] start in DemandPlan::path_routes
    std::map<int, ShortestPaths> paths_from_;      // [approach]
};

void plan_rate(const Scenario& scenario, Model& model) {
    const DemandSettings& demand = scenario.demand;
    const EntryLanes entries(model);
    const ArrivalProcess process = process_of(demand);
    for (int k = 0; k < static_cast<int>(model.demand.inlets.size()); ++k) {
        DemandPlan::Inlet& inlet = model.demand.inlets[at(k)];
        if (inlet.vehicles == 0) continue;
        const auto lanes = static_cast<double>(entries.of(entries.leg_of(k)).size());
        const ArrivalRate rate = profiled_rate(demand, demand.scale * demand.inflow_1ps / lanes, scenario.end_s());
        if (process.kind == ArrivalProcess::Kind::platooned && rate.highest_1ps() * process.platoon_headway_s >= 1.0) {
            throw PlatoonsDoNotFit(fmt::format(
                "{:g} s is too long for up to {:.0f} veh/h per lane; give at most {:.2f} s, or a lower demand.inflow",
                process.platoon_headway_s, 3600.0 * rate.highest_1ps(), std::floor(99.0 / rate.highest_1ps()) / 100.0));
        }
        inlet.arrivals_s = arrival_times(process, rate, {scenario.seed, k});
    }
}

std::vector<std::string> unique_legs(const LaneGraph& graph, const std::vector<int>& lanes) {
    std::vector<std::string> legs;
    for (const int lane : lanes) {
        std::string leg = leg_name(graph.lanes[at(lane)].name);
        if (std::find(legs.begin(), legs.end(), leg) == legs.end()) legs.push_back(std::move(leg));
    }
    return legs;
}

}  // namespace

bool plans_arrivals(const Scenario& scenario) {
    const DemandSettings& demand = scenario.demand;
    if (demand.kind == "counts" || demand.kind == "od") return true;
    return demand.kind == "rate" && (demand.arrivals != "even" || !demand.profile.empty());
}

void add_approaches(LaneGraph& graph) {
    if (!graph.approaches.empty()) return;
    std::vector<int> lanes = graph.entries;
    lanes.insert(lanes.end(), graph.links.begin(), graph.links.end());
    std::map<std::string, int> index;  // [name of the leg] index of the approach
    for (const int number : lanes) {
        Lane& lane = graph.lanes[at(number)];
        const std::string leg = leg_name(lane.name);
        const auto [known, is_new] = index.try_emplace(leg, static_cast<int>(graph.approaches.size()));
        if (is_new) graph.approaches.push_back({leg, {}});
        std::vector<int>& own = graph.approaches[at(known->second)].lanes;
        lane.approach = known->second;
        if (!own.empty()) {
            lane.left = own.back();
            graph.lanes[at(own.back())].right = number;
        }
        own.push_back(number);
    }
}

std::vector<std::string> entry_legs(const LaneGraph& graph) { return unique_legs(graph, graph.entries); }

std::vector<std::string> exit_legs(const LaneGraph& graph) {
    std::vector<int> exits;
    for (int lane = 0; lane < static_cast<int>(graph.lanes.size()); ++lane) {
        if (graph.lanes[at(lane)].next.empty()) exits.push_back(lane);
    }
    return unique_legs(graph, exits);
}

void plan_arrivals(const Scenario& scenario, Model& model) {
    model.demand.has_arrival_times = true;
    if (scenario.demand.table == nullptr) return plan_rate(scenario, model);
    TablePlanner(scenario, model).plan();
}

}  // namespace stopline
