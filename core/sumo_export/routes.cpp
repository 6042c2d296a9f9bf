// Writes the vehicles of a run of Stopline as a SUMO route file.
#include <algorithm>
#include <map>

#include "base/containers/index.h"
#include "base/io/escape.h"
#include "record/xml_file.h"
#include "sumo_export/inputs.h"
#include "sumo_export/vehicle_type.h"

namespace stopline {

namespace {

struct Trip {
    double depart_s = 0.0;
    double depart_m = 0.0;
    double depart_mps = 0.0;
    int depart_lane = -1;
    int policy = 0;
    int lane = -1;           // lane in the latest step
    int route = -1;          // route in the latest step
    std::vector<int> edges;  // edges on which the vehicle has driven so far
};

class RouteWriter : public RunWriter {
public:
    RouteWriter(std::filesystem::path file, const Model& model, const PlainNetwork& network)
        : file_(std::move(file)), model_(model), network_(network), next_edges_(network.edges.size()) {
        for (const PlainConnection& c : network.connections) {
            next_edges_[at(c.begin.edge)].push_back(c.end.edge);
        }
        inlet_of_.assign(model.graph.lanes.size(), -1);
        for (std::size_t k = 0; k < model.demand.inlets.size(); ++k) {
            inlet_of_[at(model.demand.inlets[k].lane)] = static_cast<int>(k);
        }
    }

    void observe(const State& state) override {
        for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
            const LaneBlock& block = state.blocks[at(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot) update_trip(state, lane, at(slot));
        }
    }

    std::string finish() override {
        XmlFile xml(file_, "routes", "routes_file.xsd");
        xml.add("    <!-- minGap: 1 mm less than the standstill gap of the initial queues -->\n");
        for (std::size_t k = 0; k < model_.policies.size(); ++k) {
            add_vehicle_type(xml, model_, k,
                             {escape_xml(model_.policies[k].settings.name),
                              model_.vehicle_of(static_cast<int>(k)).length_m, changes_lanes()});
        }
        // A SUMO route file must list the vehicles in the order of departure.
        std::vector<std::pair<int, const Trip*>> trips;
        for (const auto& [vehicle, trip] : trips_) trips.emplace_back(vehicle, &trip);
        std::stable_sort(trips.begin(), trips.end(),
                         [](const auto& a, const auto& b) { return a.second->depart_s < b.second->depart_s; });
        for (const auto& [vehicle, trip] : trips) add_trip(xml, vehicle, *trip);
        xml.finish();
        return fmt::format("{} vehicles", trips.size());
    }

private:
    void update_trip(const State& state, int lane, std::size_t slot) {
        const VehicleArrays& v = state.vehicles;
        Trip& trip = trips_[v.id[slot]];
        trip.route = v.record[slot].route;
        if (trip.lane == lane) return;
        if (trip.lane < 0) {
            trip.depart_s = arrival_s(state, lane);
            trip.depart_m = v.position_m[slot];
            trip.depart_mps = v.speed_mps[slot];
            trip.depart_lane = lane;
            trip.policy = v.policy[slot];
        }
        trip.lane = lane;
        if (trip.edges.empty()) trip.edges.push_back(network_.part_at(lane, v.position_m[slot]).edge);
        add_edges_of(lane, trip.edges);
    }

    // Returns the departure time for SUMO of a vehicle that has just entered on `lane`: its arrival time if it has one,
    // else the time of its entry. SUMO has a backlog of its own.
    double arrival_s(const State& state, int lane) const {
        const int inlet = inlet_of_[at(lane)];
        const double now_s = model_.time_s(state.tick);
        if (!model_.demand.has_arrival_times || inlet < 0) return now_s;
        const std::int64_t entered = state.insertion.inlets[at(inlet)].entered_arrivals;
        if (entered == 0) return now_s;  // a vehicle of an initial queue
        return model_.demand.inlets[at(inlet)].arrivals_s[static_cast<std::size_t>(entered - 1)];
    }

    // Adds the edges of a lane to the route. If the route already ends on one of these edges, adds only the edges of
    // the lane after that edge. Does nothing if the lane is a connection.
    void add_edges_of(int lane, std::vector<int>& edges) const {
        const std::vector<EdgePart>& parts = network_.parts_of[at(lane)];
        if (parts.empty() || edges.back() == parts.back().edge) return;
        const auto here =
            std::find_if(parts.begin(), parts.end(), [&](const EdgePart& part) { return part.edge == edges.back(); });
        for (auto part = here == parts.end() ? parts.begin() : here + 1; part != parts.end(); ++part) {
            add_path_to(part->edge, edges);
        }
    }

    // Adds `edge` to the route. If a teleported vehicle has skipped edges, first adds the edges between the end of the
    // route and `edge`, on the path with the fewest edges.
    void add_path_to(int edge, std::vector<int>& edges) const {
        const int start = edges.back();
        const std::vector<int>& next_edges = next_edges_[at(start)];
        if (std::find(next_edges.begin(), next_edges.end(), edge) != next_edges.end()) {
            edges.push_back(edge);
            return;
        }
        std::vector<int> predecessor(next_edges_.size(), -1);
        std::vector<int> reached = {start};
        for (std::size_t k = 0; k < reached.size() && predecessor[at(edge)] < 0; ++k) {
            for (const int next : next_edges_[at(reached[k])]) {
                if (predecessor[at(next)] >= 0 || next == start) continue;
                predecessor[at(next)] = reached[k];
                reached.push_back(next);
            }
        }
        const auto end = static_cast<std::ptrdiff_t>(edges.size());
        edges.push_back(edge);
        for (int k = predecessor[at(edge)]; k >= 0 && k != start; k = predecessor[at(k)])
            edges.insert(edges.begin() + end, k);
    }

    // Returns the edges of the trip. If the vehicle is still in the network at the end of the run, the function adds
    // the rest of its route and then edges straight on until the vehicle leaves the network. Otherwise the trip would
    // end in the middle of a queue in SUMO.
    std::vector<int> complete_route(const Trip& trip) const {
        std::vector<int> edges = trip.edges;
        int lane = trip.lane;
        const std::vector<int>& route = model_.graph.routes[at(trip.route)].lanes;
        auto k = std::find(route.begin(), route.end(), lane);
        const int approach = model_.graph.lanes[at(lane)].approach;
        // On the approach, the vehicle may still have to change to the first lane of its route. So the rest of the
        // route begins with that lane.
        if (approach >= 0 && model_.graph.lanes[at(route[0])].approach == approach) k = route.begin();
        for (; k != route.end(); ++k) {
            lane = *k;
            add_edges_of(lane, edges);
        }
        while (edges.size() <= network_.edges.size() && !model_.graph.lanes[at(lane)].next.empty()) {
            const std::vector<int>& next = model_.graph.lanes[at(lane)].next;
            const auto straight = std::find_if(next.begin(), next.end(), [&](int connection) {
                return model_.graph.lanes[at(connection)].turn == Turn::straight;
            });
            lane = straight == next.end() ? next.front() : *straight;
            add_edges_of(lane, edges);
        }
        return edges;
    }

    // Returns true if the network has adjacent lanes between which vehicles can change.
    bool changes_lanes() const {
        const std::vector<Lane>& lanes = model_.graph.lanes;
        return std::any_of(lanes.begin(), lanes.end(),
                           [](const Lane& lane) { return lane.left >= 0 || lane.right >= 0; });
    }

    void add_trip(XmlFile& xml, int vehicle, const Trip& trip) const {
        const EdgePart& part = network_.part_at(trip.depart_lane, trip.depart_m);
        // If the front is between two edges of an approach, the vehicle departs at the end of the first edge.
        const double depart_m = std::min(trip.depart_m - part.from_m, network_.edges[at(part.edge)].length_m);
        xml.add(
            "    <vehicle id=\"{}\" type=\"{}\" depart=\"{:.2f}\" departLane=\"{}\" departPos=\"{:.4f}\" "
            "departSpeed=\"{:.3f}\">",
            vehicle, escape_xml(model_.policies[at(trip.policy)].settings.name), trip.depart_s, part.index, depart_m,
            trip.depart_mps);
        std::string edges;
        for (const int edge : complete_route(trip)) edges += (edges.empty() ? "" : " ") + network_.edges[at(edge)].id;
        xml.add("<route edges=\"{}\"/></vehicle>\n", escape_xml(edges));
    }

    std::filesystem::path file_;
    const Model& model_;
    const PlainNetwork& network_;
    std::vector<std::vector<int>> next_edges_;  // [edge] edges to which the edge leads
    std::vector<int> inlet_of_;                 // [lane] index in DemandPlan::inlets; -1: none
    std::map<int, Trip> trips_;                 // [vehicle]
};

}  // namespace

std::unique_ptr<RunWriter> make_sumo_route_writer(const std::filesystem::path& file, const Model& model,
                                                  const PlainNetwork& network) {
    return std::make_unique<RouteWriter>(file, model, network);
}

}  // namespace stopline
