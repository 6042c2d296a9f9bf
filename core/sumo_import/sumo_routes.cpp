#include "sumo_import/sumo_routes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "base/random.h"
#include "base/text_hash.h"
#include "sumo_import/sumo_departure.h"
#include "sumo_import/sumo_flow.h"
#include "sumo_import/sumo_router.h"
#include "sumo_import/sumo_types.h"
#include "sumo_import/sumo_xml.h"

namespace stopline {

namespace {

constexpr const char* kStopIgnored = "'stop' is ignored: vehicles make no stops";
constexpr std::size_t kMaxTrips = 20'000'000;
constexpr double kRoundingTolerance_m = 0.1;  // tolerance for departure positions, which are rounded in the files

// The route of one or more trips.
struct TripRoute {
    std::vector<int> edges = {};
    bool complete = true;                // false: fastest routes must fill the gaps between the edges
    bool open_to_cars = true;            // all edges are open to cars
    bool starts_on_merged_edge = false;  // the first edge was merged into another edge (sumo_short_edges.h)
    std::string where;                   // file:line
    int first_turn = -1;                 // index in SumoTraffic::turns
};

class RouteReader {
public:
    RouteReader(const SumoNetwork& network, double until_s, std::uint64_t seed, bool uses_driving)
        : network_(network),
          router_(network),
          until_s_(until_s),
          seed_(seed),
          uses_driving_(uses_driving),
          merged_(network.net.edges.size(), 0),
          types_(uses_driving) {
        for (const SumoEdge& edge : network.net.edges) {
            if (edge.merged_into >= 0) merged_[at(edge.merged_into)] = 1;
        }
    }

    void read(const std::filesystem::path& file, bool additional) {
        const SumoXml xml(file, {"routes", "trips", "additional", "add", "flows", "tlLogics"});
        additional_ = additional;
        xml_ = &xml;
        defaults_ = sumo_departure_defaults(xml, network_.net);
        uses_defaults_ = false;
        for (const pugi::xml_node node : xml.root()) {
            if (node.type() == pugi::node_element) read_element(node);
        }
        if (uses_defaults_) traffic_.notes.push_back(fmt::format("{}: {}", xml.name(), text_of(defaults_)));
        traffic_.hash = extended_hash(traffic_.hash, xml.hash());
        xml_ = nullptr;
    }

    SumoTraffic finish() {
        complete_routes_and_turns();
        std::vector<std::size_t> order(traffic_.trips.size());
        for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return traffic_.trips[a].depart_s < traffic_.trips[b].depart_s;
        });
        SumoTraffic sorted;
        sorted.turns = std::move(traffic_.turns);
        sorted.warnings = std::move(traffic_.warnings);
        sorted.notes = std::move(traffic_.notes);
        sorted.types = std::move(traffic_.types);
        sorted.hash = traffic_.hash;
        sorted.elements = traffic_.elements;
        sorted.first_late_departure_s = traffic_.first_late_departure_s;
        for (const std::size_t k : order) {
            sorted.trips.push_back(traffic_.trips[k]);
            sorted.ids.push_back(std::move(traffic_.ids[k]));
            if (uses_driving_) sorted.type_of.push_back(traffic_.type_of[k]);
            Trip& trip = sorted.trips.back();
            const TripRoute& route = routes_[route_of_trip_[k]];
            trip.first_turn = route.first_turn;
            trip.turn_count = static_cast<int>(route.edges.size()) - 1;
            trip.approach = network_.approach_of[at(route.edges[0])];
        }
        return sorted;
    }

private:
    void read_element(pugi::xml_node node) {
        const std::string_view name = node.name();
        if (name == "vType" || name == "vTypeDistribution") return types_.read(*xml_, node, traffic_.warnings);
        if (name == "route") return add_named_route(node, {{read_route(node), 1.0}});
        if (name == "routeDistribution") return read_distribution(node);
        if (name == "vehicle" || name == "trip" || name == "flow") ++traffic_.elements;
        if (name == "vehicle" || name == "trip") return read_vehicle(node);
        if (name == "flow") return read_flow(node);
        if (name == "include") xml_->refuse(node, "'include' is not supported: name the file in the scenario instead");
        if (!additional_) traffic_.warnings.note(xml_->where(node), fmt::format("the element '{}' is ignored", name));
    }

    // Returns the edge with this id. If the import has merged this edge into another edge, returns the other edge.
    int edge_of(pugi::xml_node node, const char* attribute, std::string_view id) const {
        const auto found = network_.net.edge_by_id.find(std::string(id));
        if (found == network_.net.edge_by_id.end()) {
            std::vector<std::string> ids;
            for (const SumoEdge& edge : network_.net.edges) {
                if (!edge.internal) ids.push_back(edge.id);
            }
            xml_->refuse(node, fmt::format("{}: there is no edge '{}'{}", attribute, id, known_ids_hint(id, ids)));
        }
        int edge = found->second;
        while (network_.net.edges[at(edge)].merged_into >= 0) edge = network_.net.edges[at(edge)].merged_into;
        return edge;
    }

    // Reads a route that lists all its edges. Returns the index of the route in routes_. Throws InputError if two
    // successive edges are not connected, unless the route has edges closed to cars.
    std::size_t read_route(pugi::xml_node node) {
        TripRoute route;
        route.where = xml_->where(node);
        const std::string edges = xml_->text(node, "edges");
        std::string_view last_id;
        for (const std::string_view id : sumo_words(edges)) {
            const int edge = edge_of(node, "edges", id);
            route.open_to_cars = route.open_to_cars && router_.allows_cars(edge);
            if (route.edges.empty()) route.starts_on_merged_edge = network_.net.edges[at(edge)].id != id;
            // Consecutive edges of the file can be the same edge after the import has merged short edges.
            const bool is_same_edge = !route.edges.empty() && route.edges.back() == edge;
            if (!is_same_edge || id == last_id) route.edges.push_back(edge);
            last_id = id;
        }
        if (route.edges.empty()) xml_->refuse(node, "'edges' is empty; at least one edge is needed");
        for (std::size_t k = 1; k < route.edges.size(); ++k) {
            if (!route.open_to_cars || router_.turn(route.edges[k - 1], route.edges[k]) != Turn::none) continue;
            xml_->refuse(node, fmt::format("edges: edge '{}' does not lead to edge '{}'",
                                           network_.net.edges[at(route.edges[k - 1])].id,
                                           network_.net.edges[at(route.edges[k])].id));
        }
        if (node.child("stop")) traffic_.warnings.note(route.where, kStopIgnored);
        if (node.attribute("repeat")) xml_->refuse(node, "'repeat' is not supported; give each edge of the route");
        routes_.push_back(std::move(route));
        return routes_.size() - 1;
    }

    // Routes and their shares. Each element holds the index of a route in routes_, and the sum of the shares up to it.
    using Shares = std::vector<std::pair<std::size_t, double>>;

    void add_named_route(pugi::xml_node node, Shares shares) {
        const std::string id = xml_->text(node, "id");
        if (!named_routes_.emplace(id, std::move(shares)).second) {
            xml_->refuse(node, fmt::format("there are two routes '{}'; ids must be unique", id));
        }
    }

    void read_distribution(pugi::xml_node node) {
        Shares shares;
        double sum = 0.0;
        const auto add = [&](pugi::xml_node from, std::size_t route, double share) {
            if (share < 0.0) xml_->refuse(from, "a probability must be at least 0");
            shares.emplace_back(route, sum += share);
        };
        for (const pugi::xml_node child : node.children("route")) {
            const double share = xml_->number_or(child, "probability", 1.0);
            if (child.attribute("refId")) {
                add(child, known_route(child, child.attribute("refId").value()), share);
            } else {
                const std::size_t route = read_route(child);
                add(child, route, share);
                if (child.attribute("id")) add_named_route(child, {{route, 1.0}});
            }
        }
        const std::string members = node.attribute("routes").value();
        const std::vector<std::string_view> probabilities = sumo_words(node.attribute("probabilities").value());
        std::size_t k = 0;
        for (const std::string_view member : sumo_words(members)) {
            const auto share = k < probabilities.size() ? sumo_number(probabilities[k]) : 1.0;
            if (!share) xml_->refuse(node, "'probabilities' must be finite numbers");
            add(node, known_route(node, std::string(member)), *share);
            ++k;
        }
        if (!(sum > 0.0)) xml_->refuse(node, "the distribution needs a route with a probability above 0");
        add_named_route(node, std::move(shares));
    }

    // Returns the end of a message about an unknown route: the most similar id, and some known ids.
    std::string routes_hint(const std::string& unknown) const {
        std::vector<std::string> ids;
        for (const auto& [id, shares] : named_routes_) ids.push_back(id);
        return known_ids_hint(unknown, std::move(ids));
    }

    // Returns the index of the route with this id. Throws InputError for an unknown id or the id of a distribution.
    std::size_t known_route(pugi::xml_node node, const std::string& id) const {
        const auto found = named_routes_.find(id);
        if (found == named_routes_.end())
            xml_->refuse(node, fmt::format("there is no route '{}' before this element{}", id, routes_hint(id)));
        if (found->second.size() != 1)
            xml_->refuse(node, fmt::format("'{}' is a distribution; a single route is needed", id));
        return found->second[0].first;
    }

    // Returns the routes of a vehicle, trip or flow element. Each vehicle later gets one of these routes at random.
    Shares read_route_choice(pugi::xml_node node) {
        if (const pugi::xml_node child = node.child("route")) return {{read_route(child), 1.0}};
        if (const std::string id = node.attribute("route").value(); !id.empty()) {
            const auto found = named_routes_.find(id);
            if (found == named_routes_.end())
                xml_->refuse(node, fmt::format("route: there is no route '{}'{}", id, routes_hint(id)));
            return found->second;
        }
        refuse_places_without_edges(node);
        TripRoute route;
        route.complete = false;
        route.where = xml_->where(node);
        const std::string from = xml_->text(node, "from");
        route.edges.push_back(edge_of(node, "from", from));
        route.starts_on_merged_edge = network_.net.edges[at(route.edges[0])].id != from;
        const std::string via = node.attribute("via").value();
        for (const std::string_view id : sumo_words(via)) route.edges.push_back(edge_of(node, "via", id));
        route.edges.push_back(edge_of(node, "to", xml_->text(node, "to")));
        for (const int edge : route.edges) route.open_to_cars = route.open_to_cars && router_.allows_cars(edge);
        routes_.push_back(std::move(route));
        return {{routes_.size() - 1, 1.0}};
    }

    // Throws InputError if a zone, a junction or a point is given as origin or destination without an edge. If 'from'
    // or 'to' names an edge, as in the output of od2trips, the edge counts and the zone is ignored.
    void refuse_places_without_edges(pugi::xml_node node) const {
        for (const std::string end : {"from", "to"}) {
            if (node.attribute(end.c_str())) continue;
            for (const char* const place : {"Taz", "Junction", "XY", "LonLat"}) {
                if (!node.attribute((end + place).c_str())) continue;
                xml_->refuse(node, fmt::format("'{0}{1}' is not supported without an edge; give an edge with '{0}'",
                                               end, place));
            }
        }
    }

    // Reads departLane, departPos and departSpeed, or takes the defaults of the file. Warns if the element has an
    // attribute of the arrival (arrivalPos, ...) or a stop, because the import ignores both.
    void read_departure(pugi::xml_node node, Trip& trip) {
        if (read_sumo_departure(*xml_, node, defaults_, traffic_.warnings, trip)) uses_defaults_ = true;
        if (node.attribute("arrivalPos") || node.attribute("arrivalLane") || node.attribute("arrivalSpeed")) {
            traffic_.warnings.note(
                xml_->where(node),
                "'arrivalPos', 'arrivalLane' and 'arrivalSpeed' are ignored: trips end at the end of an edge");
        }
        if (node.child("stop")) traffic_.warnings.note(xml_->where(node), kStopIgnored);
    }

    // All attributes of a vehicle, trip or flow element except its times.
    struct VehicleTemplate {
        Trip trip;
        Shares routes;
        std::string type;
    };
    VehicleTemplate read_template(pugi::xml_node node) {
        VehicleTemplate vehicle{{}, read_route_choice(node), node.attribute("type").value()};
        read_departure(node, vehicle.trip);
        return vehicle;
    }

    double random_number(std::uint64_t key) const {
        return random_uniform(seed_, traffic_.trips.size(), key, Purpose::vehicle_type);
    }

    // Adds the trip of one vehicle. Adds nothing if the vehicle departs at or after the end of the run, if its vehicle
    // class may not use car lanes, or if its route has edges closed to cars.
    void add(pugi::xml_node node, const VehicleTemplate& vehicle, const std::string& id, double depart_s) {
        if (depart_s >= until_s_) return note_late_departure(depart_s);
        if (traffic_.trips.size() >= kMaxTrips)
            xml_->refuse(node, fmt::format("the files have more than {} vehicles", kMaxTrips));
        const SumoType& type = types_.pick(*xml_, node, vehicle.type, random_number(0));
        if (!type.uses_car_lanes) {
            traffic_.warnings.note(xml_->where(node),
                                   "the vehicle is ignored: vehicles of its class do not use car lanes");
            return;
        }
        if (!vehicle_ids_.insert(id).second)
            xml_->refuse(node, fmt::format("there are two vehicles '{}'; ids must be unique", id));
        Trip trip = vehicle.trip;
        trip.depart_s = depart_s;
        trip.length_m = static_cast<float>(type.length_m);
        const auto upper_of = [](const auto& share) { return share.second; };
        const std::size_t route = pick_by_share(vehicle.routes, random_number(1), upper_of).first;
        if (!routes_[route].open_to_cars) {
            traffic_.warnings.note(routes_[route].where,
                                   "the route has edges closed to cars: its vehicles are ignored");
            return;
        }
        if (trip.depart_lane == Trip::DepartLane::given)
            trip.lane = lane_from_left(node, routes_[route].edges[0], vehicle.trip.lane);
        if (trip.depart_position == Trip::DepartPosition::given) check_depart_position(node, routes_[route], trip);
        route_of_trip_.push_back(route);
        traffic_.trips.push_back(trip);
        traffic_.ids.push_back(id);
        if (uses_driving_) traffic_.type_of.push_back(index_of(*xml_, node, type, traffic_.types));
    }

    void note_late_departure(double depart_s) {
        traffic_.first_late_departure_s = std::min(depart_s, traffic_.first_late_departure_s.value_or(depart_s));
    }

    // Checks a numeric departPos and converts it to a distance from the start of the lane. A negative departPos counts
    // from the end of the lane. If merged edges make the conversion impossible, the trip departs at 'base'.
    void check_depart_position(pugi::xml_node node, const TripRoute& route, Trip& trip) {
        const SumoEdge& edge = network_.net.edges[at(route.edges[0])];
        const double length_m = edge.lanes[0].length_m;
        if (std::abs(static_cast<double>(trip.front_m)) > length_m + kRoundingTolerance_m) {
            xml_->refuse(node, fmt::format("departPos=\"{}\" must lie on edge '{}', which is {:.2f} m long",
                                           node.attribute("departPos").value(), edge.id, length_m));
        }
        const bool has_merged = merged_[at(route.edges[0])] != 0;
        if (!route.starts_on_merged_edge && (trip.front_m >= 0.0F || !has_merged)) {
            if (trip.front_m < 0.0F) trip.front_m = std::max(trip.front_m + static_cast<float>(length_m), 0.0F);
            return;
        }
        traffic_.warnings.note(
            xml_->where(node),
            "'departPos' is ignored and 'base' is used: the first edge was merged with a short edge");
        trip.depart_position = Trip::DepartPosition::base;
    }

    // Converts SUMO's lane index, which counts from the right, to an index from the left among the lanes open to cars.
    int lane_from_left(pugi::xml_node node, int edge, int index) const {
        const std::vector<int>& lanes = network_.lane_of[at(edge)];
        if (at(index) >= lanes.size() || lanes[at(index)] < 0) {
            xml_->refuse(node, fmt::format("departLane=\"{1}\": edge '{0}' has no lane {1} for passenger cars",
                                           network_.net.edges[at(edge)].id, index));
        }
        const std::vector<int>& all = network_.graph.approaches[at(network_.approach_of[at(edge)])].lanes;
        return static_cast<int>(std::find(all.begin(), all.end(), lanes[at(index)]) - all.begin());
    }

    void read_vehicle(pugi::xml_node node) {
        const std::string depart = xml_->text(node, "depart");
        const std::string id = xml_->text(node, "id");
        if (depart == "triggered" || depart == "containerTriggered" || depart == "split") {
            return traffic_.warnings.note(xml_->where(node),
                                          "the vehicle is ignored: it departs only with a person or a container");
        }
        add(node, read_template(node), id,
            depart == "now" || depart == "begin" ? 0.0 : sumo_time_s(*xml_, node, "depart", 0.0));
    }

    void read_flow(pugi::xml_node node) {
        const std::string id = xml_->text(node, "id");
        const VehicleTemplate vehicle = read_template(node);
        int count = 0;
        const double begin_s = sumo_time_s(*xml_, node, "begin", 0.0);
        if (begin_s >= until_s_) note_late_departure(begin_s);
        for (const double depart_s : sumo_departures(*xml_, node, until_s_, seed_)) {
            add(node, vehicle, fmt::format("{}.{}", id, count++), depart_s);
        }
    }

    // Completes partial routes and lists the turns of all routes that are open to cars. A piece is the part of a route
    // between two successive edges of the file. The pieces are sorted by their last edge, because the router is faster
    // if successive calls have the same destination.
    void complete_routes_and_turns() {
        struct Piece {
            int to;
            int from;
            std::size_t route;
            std::size_t position;  // index of `to` in the edges of the incomplete route
        };
        std::vector<Piece> pieces;
        for (std::size_t k = 0; k < routes_.size(); ++k) {
            const std::vector<int>& edges = routes_[k].edges;
            if (routes_[k].complete || !routes_[k].open_to_cars) continue;
            for (std::size_t i = 1; i < edges.size(); ++i) pieces.push_back({edges[i], edges[i - 1], k, i});
        }
        std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.to < b.to; });
        std::map<std::pair<std::size_t, std::size_t>, std::vector<int>> found;
        for (const Piece& piece : pieces) {
            std::optional<std::vector<int>> edges = router_.fastest_route(piece.from, piece.to);
            if (!edges) {
                throw InputError(fmt::format("{}: there is no route for cars from edge '{}' to edge '{}'",
                                             routes_[piece.route].where, network_.net.edges[at(piece.from)].id,
                                             network_.net.edges[at(piece.to)].id));
            }
            found[{piece.route, piece.position}] = std::move(*edges);
        }
        for (std::size_t k = 0; k < routes_.size(); ++k) {
            if (!routes_[k].open_to_cars) continue;
            if (!routes_[k].complete) join_pieces(k, found);
            routes_[k].first_turn = static_cast<int>(traffic_.turns.size());
            for (std::size_t i = 1; i < routes_[k].edges.size(); ++i) {
                traffic_.turns.push_back(router_.turn(routes_[k].edges[i - 1], routes_[k].edges[i]));
            }
        }
    }

    // Replaces the edges of route k by the edges of all its pieces. `found` holds the edges of each piece, by route and
    // Piece::position.
    void join_pieces(std::size_t k, const std::map<std::pair<std::size_t, std::size_t>, std::vector<int>>& found) {
        std::vector<int> all{routes_[k].edges[0]};
        for (std::size_t i = 1; i < routes_[k].edges.size(); ++i) {
            const std::vector<int>& piece = found.at({k, i});
            all.insert(all.end(), piece.begin() + 1, piece.end());
        }
        routes_[k].edges = std::move(all);
    }

    const SumoNetwork& network_;
    SumoRouter router_;
    double until_s_;
    std::uint64_t seed_;
    bool uses_driving_;
    std::vector<char> merged_;      // [edge] 1: short edges were merged into it
    const SumoXml* xml_ = nullptr;  // the file that is being read
    bool additional_ = false;       // the file that is being read is an additional file
    SumoDepartureDefaults defaults_;
    bool uses_defaults_ = false;  // a vehicle of the present file lacks departLane or departSpeed
    SumoTypes types_;
    std::vector<TripRoute> routes_;
    std::unordered_map<std::string, Shares> named_routes_;
    std::unordered_set<std::string> vehicle_ids_;
    std::vector<std::size_t> route_of_trip_;  // [trip]
    SumoTraffic traffic_;
};

}  // namespace

double SumoTraffic::shortest_vehicle_m() const {
    double shortest_m = 1e9;
    for (const Trip& trip : trips) shortest_m = std::min(shortest_m, static_cast<double>(trip.length_m));
    return shortest_m;
}

SumoTraffic read_sumo_routes(const SumoRouteFiles& files, const SumoNetwork& network, double until_s,
                             std::uint64_t seed) {
    RouteReader reader(network, until_s, seed, files.uses_driving);
    for (const std::filesystem::path& file : files.additional) reader.read(file, true);
    for (const std::filesystem::path& file : files.routes) reader.read(file, false);
    return reader.finish();
}

}  // namespace stopline
