// The vehicles that an import planned, as SUMO's routes.
#include "sumo/imported_vehicles.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "record/vehicle_name.h"
#include "record/xml_file.h"
#include "sumo/vehicle_type.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

std::string type_id(const Model& model, int policy, float length_m) {
    return fmt::format("{}_{:g}m", xml_escaped(model.policies[at(policy)].settings.name), length_m);
}

// What the turns of trips lead to.
class Ways {
    using Turns = std::array<int, kMostTurns>;

public:
    explicit Ways(const SumoNetwork& network)
        : network_(network),
          edge_of_(network.graph.approaches.size(), -1),
          after_(network.graph.approaches.size()),
          joined_(network.net.edges.size()) {
        for (std::size_t edge = 0; edge < network.approach_of.size(); ++edge) {
            if (network.approach_of[edge] >= 0) edge_of_[at(network.approach_of[edge])] = static_cast<int>(edge);
            const int before = network.net.edges[edge].joined_to;
            if (before >= 0) joined_[at(before)].push_back(static_cast<int>(edge));
        }
        for (Turns& turns : after_) turns.fill(-1);
        const std::vector<Lane>& lanes = network.graph.lanes;
        for (const Lane& lane : lanes) {
            if (lane.origin < 0) continue;
            after_[at(lanes[at(lane.origin)].approach)][at(static_cast<int>(lane.turn))] =
                lanes[at(lane.next[0])].approach;
        }
    }

    std::vector<std::string> of(const DemandPlan& plan, int trip) const {
        std::vector<std::string> edges;
        int approach = plan.trips[at(trip)].approach;
        for (int leg = 0; approach >= 0; ++leg) {
            add(edge_of_[at(approach)], edges);
            const Turn turn = plan.turn_of_trip(trip, leg);
            if (turn == Turn::none) break;
            approach = after_[at(approach)][at(static_cast<int>(turn))];
        }
        return edges;
    }

    int first_edge(const Trip& trip) const { return edge_of_[at(trip.approach)]; }

private:
    // With those that were joined to it: in the order of their numbers, as they were joined.
    void add(int edge, std::vector<std::string>& edges) const {
        edges.push_back(network_.net.edges[at(edge)].id);
        for (const int more : joined_[at(edge)]) add(more, edges);
    }

    const SumoNetwork& network_;
    std::vector<int> edge_of_;              // [approach]
    std::vector<Turns> after_;              // [approach][turn] approach
    std::vector<std::vector<int>> joined_;  // [edge]
};

std::string depart_lane(const Trip& trip, const SumoNetwork& network, int edge) {
    switch (trip.where) {
        case Trip::Where::rightmost:
            return "first";
        case Trip::Where::free:
            return "free";
        case Trip::Where::random:
            return "random";
        case Trip::Where::best:
            return "best";
        case Trip::Where::lane:
            break;
    }
    const int lane = network.graph.approaches[at(trip.approach)].lanes[at(trip.lane)];
    const std::vector<int>& lanes = network.lane_of[at(edge)];
    return std::to_string(std::find(lanes.begin(), lanes.end(), lane) - lanes.begin());
}

std::string depart_pos(const Trip& trip, const SumoNetwork& network) {
    switch (trip.along) {
        case Trip::Along::base:
            return "base";
        case Trip::Along::last:
            return "last";
        case Trip::Along::random:
            return "random";
        case Trip::Along::free:
            return "random_free";
        case Trip::Along::given:
            break;
    }
    // Files round: it may be a little beyond the end.
    const Approach& approach = network.graph.approaches[at(trip.approach)];
    const double most_m = network.graph.lanes[at(approach.lanes[0])].stop_line_m;
    return fmt::format("{:.2f}", std::min(static_cast<double>(trip.front_m), most_m));
}

std::string depart_speed(const Trip& trip) {
    switch (trip.fast) {
        case Trip::Fast::limit:
            return "max";
        case Trip::Fast::as_last:
            return "last";
        case Trip::Fast::random:
            return "random";
        case Trip::Fast::given:
            break;
    }
    return fmt::format("{:.2f}", trip.speed_mps);
}

}  // namespace

void write_imported_vehicles(const std::filesystem::path& file, const Model& model, const SumoNetwork& network) {
    const DemandPlan& plan = model.demand;
    XmlFile xml(file, "routes", "routes_file.xsd");
    std::set<std::pair<int, float>> types;  // policy and length
    for (std::size_t k = 0; k < plan.trips.size(); ++k) types.emplace(plan.trip_policies[k], plan.trips[k].length_m);
    for (const auto& [policy, length_m] : types) {
        add_vehicle_type(xml, model, at(policy), {type_id(model, policy, length_m), static_cast<double>(length_m)});
    }
    const Ways ways(network);
    for (int k = 0; k < static_cast<int>(plan.trips.size()); ++k) {
        const Trip& trip = plan.trips[at(k)];
        xml.add(R"(    <vehicle id="{}" type="{}" depart="{:.3f}" departLane="{}" departPos="{}" departSpeed="{}">)",
                vehicle_name(model, k, k), type_id(model, plan.trip_policies[at(k)], trip.length_m), trip.depart_s,
                depart_lane(trip, network, ways.first_edge(trip)), depart_pos(trip, network), depart_speed(trip));
        xml.add("<route edges=\"{}\"/></vehicle>\n", xml_escaped(fmt::format("{}", fmt::join(ways.of(plan, k), " "))));
    }
    xml.finish();
}

}  // namespace stopline
