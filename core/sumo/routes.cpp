// The vehicles of a run as SUMO's routes.
#include <algorithm>
#include <map>

#include "record/xml_file.h"
#include "sumo/inputs.h"
#include "sumo/vehicle_type.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

struct Trip {
    double depart_s = 0.0;
    double depart_m = 0.0;
    double depart_mps = 0.0;
    int depart_lane = -1;
    int policy = 0;
    int lane = -1;           // as seen last,
    int route = -1;          // and the way that it was on
    std::vector<int> edges;  // as far as it came
};

class RouteWriter : public RunWriter {
public:
    RouteWriter(std::filesystem::path file, const Model& model, const PlainNetwork& network)
        : file_(std::move(file)), model_(model), network_(network), edges_after_(network.edges.size()) {
        for (const PlainConnection& c : network.connections) {
            edges_after_[at(network.place_of[at(c.from)].edge)].push_back(network.place_of[at(c.to)].edge);
        }
    }

    void look(const State& state) override {
        for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
            const LaneBlock& block = state.blocks[at(lane)];
            for (int slot = block.first; slot < block.stop(); ++slot) see(state, lane, at(slot));
        }
    }

    std::string finish() override {
        XmlFile xml(file_, "routes", "routes_file.xsd");
        xml.add("    <!-- minGap: 1 mm less than the gap by which queues stand at the beginning -->\n");
        for (std::size_t k = 0; k < model_.policies.size(); ++k) {
            add_vehicle_type(
                xml, model_, k,
                {xml_escaped(model_.policies[k].settings.name), model_.vehicles[0].length_m, changes_lanes()});
        }
        // In the order of departure, as SUMO wants them.
        std::vector<std::pair<int, const Trip*>> trips;
        for (const auto& [vehicle, trip] : trips_) trips.emplace_back(vehicle, &trip);
        std::stable_sort(trips.begin(), trips.end(),
                         [](const auto& a, const auto& b) { return a.second->depart_s < b.second->depart_s; });
        for (const auto& [vehicle, trip] : trips) add_trip(xml, vehicle, *trip);
        xml.finish();
        return fmt::format("{} vehicles", trips.size());
    }

private:
    void see(const State& state, int lane, std::size_t slot) {
        const VehicleArrays& v = state.vehicles;
        Trip& trip = trips_[v.id[slot]];
        trip.route = v.record[slot].route;
        if (trip.lane == lane) return;
        if (trip.lane < 0) {
            trip.depart_s = model_.time_s(state.tick);
            trip.depart_m = v.position_m[slot];
            trip.depart_mps = v.speed_mps[slot];
            trip.depart_lane = lane;
            trip.policy = v.policy[slot];
        }
        trip.lane = lane;
        add_edge_of(lane, trip.edges);
    }

    void add_edge_of(int lane, std::vector<int>& edges) const {
        if (model_.graph.lanes[at(lane)].origin >= 0) return;
        const int edge = network_.place_of[at(lane)].edge;
        if (edges.empty()) {
            edges.push_back(edge);
        } else if (edges.back() != edge) {
            add_way_to(edge, edges);
        }
    }

    // Those that the rules moved on were not seen on the edges between: they are given the way of fewest edges.
    void add_way_to(int edge, std::vector<int>& edges) const {
        const int start = edges.back();
        const std::vector<int>& after = edges_after_[at(start)];
        if (std::find(after.begin(), after.end(), edge) != after.end()) {
            edges.push_back(edge);
            return;
        }
        std::vector<int> before(edges_after_.size(), -1);
        std::vector<int> reached = {start};
        for (std::size_t k = 0; k < reached.size() && before[at(edge)] < 0; ++k) {
            for (const int next : edges_after_[at(reached[k])]) {
                if (before[at(next)] >= 0 || next == start) continue;
                before[at(next)] = reached[k];
                reached.push_back(next);
            }
        }
        const auto end = static_cast<std::ptrdiff_t>(edges.size());
        edges.push_back(edge);
        for (int k = before[at(edge)]; k >= 0 && k != start; k = before[at(k)]) edges.insert(edges.begin() + end, k);
    }

    // Who is still under way at the end goes on as it was going to, and then straight on out of the network: nobody leaves in the
    // middle of a queue.
    std::vector<int> whole_way(const Trip& trip) const {
        std::vector<int> edges = trip.edges;
        int lane = trip.lane;
        const std::vector<int>& route = model_.graph.routes[at(trip.route)].lanes;
        for (auto k = std::find(route.begin(), route.end(), lane); k != route.end(); ++k) {
            lane = *k;
            add_edge_of(lane, edges);
        }
        while (edges.size() <= network_.edges.size() && !model_.graph.lanes[at(lane)].next.empty()) {
            const std::vector<int>& next = model_.graph.lanes[at(lane)].next;
            const auto straight = std::find_if(
                next.begin(), next.end(), [&](int way) { return model_.graph.lanes[at(way)].turn == Turn::straight; });
            lane = straight == next.end() ? next.front() : *straight;
            add_edge_of(lane, edges);
        }
        return edges;
    }

    bool changes_lanes() const {
        const std::vector<Lane>& lanes = model_.graph.lanes;
        return std::any_of(lanes.begin(), lanes.end(),
                           [](const Lane& lane) { return lane.left >= 0 || lane.right >= 0; });
    }

    void add_trip(XmlFile& xml, int vehicle, const Trip& trip) const {
        const PlainNetwork::Place& place = network_.place_of[at(trip.depart_lane)];
        xml.add(
            "    <vehicle id=\"{}\" type=\"{}\" depart=\"{:.2f}\" departLane=\"{}\" departPos=\"{:.4f}\" "
            "departSpeed=\"{:.3f}\">",
            vehicle, xml_escaped(model_.policies[at(trip.policy)].settings.name), trip.depart_s, place.index,
            trip.depart_m, trip.depart_mps);
        std::string edges;
        for (const int edge : whole_way(trip)) edges += (edges.empty() ? "" : " ") + network_.edges[at(edge)].id;
        xml.add("<route edges=\"{}\"/></vehicle>\n", xml_escaped(edges));
    }

    std::filesystem::path file_;
    const Model& model_;
    const PlainNetwork& network_;
    std::vector<std::vector<int>> edges_after_;  // [edge]
    std::map<int, Trip> trips_;                  // by number
};

}  // namespace

std::unique_ptr<RunWriter> make_sumo_route_writer(const std::filesystem::path& file, const Model& model,
                                                  const PlainNetwork& network) {
    return std::make_unique<RouteWriter>(file, model, network);
}

}  // namespace stopline
