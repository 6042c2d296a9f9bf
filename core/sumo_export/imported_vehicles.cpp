#include "sumo_export/imported_vehicles.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/containers/index.h"
#include "base/io/escape.h"
#include "record/xml_file.h"
#include "sim/state/queries/vehicle_names.h"
#include "sumo_export/vehicle_type.h"

namespace stopline {

namespace {

std::string type_id(const Model& model, int policy, float length_m) {
    return fmt::format("{}_{:g}m", escape_xml(model.policies[at(policy)].settings.name), length_m);
}

// Finds the SUMO edges of a trip from its first approach and its turns.
class RouteEdges {
    using Turns = std::array<int, kMaxTurns>;

public:
    explicit RouteEdges(const SumoNetwork& network)
        : network_(network),
          edge_of_(network.graph.approaches.size(), -1),
          next_approach_(network.graph.approaches.size()),
          merged_(network.net.edges.size()) {
        for (std::size_t edge = 0; edge < network.approach_of.size(); ++edge) {
            if (network.approach_of[edge] >= 0) edge_of_[at(network.approach_of[edge])] = static_cast<int>(edge);
            const int before = network.net.edges[edge].merged_into;
            if (before >= 0) merged_[at(before)].push_back(static_cast<int>(edge));
        }
        for (Turns& turns : next_approach_) turns.fill(-1);
        const std::vector<Lane>& lanes = network.graph.lanes;
        for (const Lane& lane : lanes) {
            if (lane.origin < 0) continue;
            next_approach_[at(lanes[at(lane.origin)].approach)][at(static_cast<int>(lane.turn))] =
                lanes[at(lane.next[0])].approach;
        }
    }

    std::vector<std::string> edges_of(const DemandPlan& plan, int trip) const {
        std::vector<std::string> edges;
        int approach = plan.trips[at(trip)].approach;
        for (int step = 0; approach >= 0; ++step) {
            add(edge_of_[at(approach)], edges);
            const Turn turn = plan.turn_of_trip(trip, step);
            if (turn == Turn::none) break;
            approach = next_approach_[at(approach)][at(static_cast<int>(turn))];
        }
        return edges;
    }

    int first_edge(const Trip& trip) const { return edge_of_[at(trip.approach)]; }

private:
    // Adds the edge and all edges that the import merged into it, in driving order.
    void add(int edge, std::vector<std::string>& edges) const {
        edges.push_back(network_.net.edges[at(edge)].id);
        for (const int merged_edge : merged_[at(edge)]) add(merged_edge, edges);
    }

    const SumoNetwork& network_;
    std::vector<int> edge_of_;              // [approach] its SUMO edge
    std::vector<Turns> next_approach_;      // [approach][turn] approach after the turn; -1: none
    std::vector<std::vector<int>> merged_;  // [SUMO edge] edges that the import merged into it
};

std::string depart_lane(const Trip& trip, const SumoNetwork& network, int edge) {
    switch (trip.depart_lane) {
        case Trip::DepartLane::rightmost:
            return "first";
        case Trip::DepartLane::free:
            return "free";
        case Trip::DepartLane::random:
            return "random";
        case Trip::DepartLane::best:
            return "best";
        case Trip::DepartLane::given:
            break;
    }
    const int lane = network.graph.approaches[at(trip.approach)].lanes[at(trip.lane)];
    const std::vector<int>& lanes = network.lane_of[at(edge)];
    return std::to_string(std::find(lanes.begin(), lanes.end(), lane) - lanes.begin());
}

std::string depart_pos(const Trip& trip, const SumoNetwork& network) {
    switch (trip.depart_position) {
        case Trip::DepartPosition::base:
            return "base";
        case Trip::DepartPosition::last:
            return "last";
        case Trip::DepartPosition::random:
            return "random";
        case Trip::DepartPosition::free:
            return "random_free";
        case Trip::DepartPosition::given:
            break;
    }
    // The route file of the scenario can have a rounded position slightly beyond the end of the lane.
    const Approach& approach = network.graph.approaches[at(trip.approach)];
    const double max_m = network.graph.lanes[at(approach.lanes[0])].stop_line_m;
    return fmt::format("{:.2f}", std::min(static_cast<double>(trip.front_m), max_m));
}

std::string depart_speed(const Trip& trip) {
    switch (trip.depart_speed) {
        case Trip::DepartSpeed::limit:
            return "max";
        case Trip::DepartSpeed::last:
            return "last";
        case Trip::DepartSpeed::mean:
            return "avg";
        case Trip::DepartSpeed::random:
            return "random";
        case Trip::DepartSpeed::given:
            break;
    }
    return fmt::format("{:.2f}", trip.speed_mps);
}

}  // namespace

void write_imported_vehicles(const std::filesystem::path& file, const Model& model, const SumoNetwork& network) {
    const DemandPlan& plan = model.demand;
    XmlFile xml(file, "routes", "routes_file.xsd");
    std::set<std::pair<int, float>> types;  // pairs of policy and vehicle length, m
    for (std::size_t k = 0; k < plan.trips.size(); ++k) types.emplace(plan.trip_policies[k], plan.trips[k].length_m);
    for (const auto& [policy, length_m] : types) {
        add_vehicle_type(xml, model, at(policy), {type_id(model, policy, length_m), static_cast<double>(length_m)});
    }
    const RouteEdges routes(network);
    for (int k = 0; k < static_cast<int>(plan.trips.size()); ++k) {
        const Trip& trip = plan.trips[at(k)];
        xml.add(R"(    <vehicle id="{}" type="{}" depart="{:.3f}" departLane="{}" departPos="{}" departSpeed="{}">)",
                escape_xml(vehicle_name(model, k, k)), type_id(model, plan.trip_policies[at(k)], trip.length_m),
                trip.depart_s, depart_lane(trip, network, routes.first_edge(trip)), depart_pos(trip, network),
                depart_speed(trip));
        xml.add("<route edges=\"{}\"/></vehicle>\n",
                escape_xml(fmt::format("{}", fmt::join(routes.edges_of(plan, k), " "))));
    }
    xml.finish();
}

}  // namespace stopline
