#include "demand/sumo_routes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/random.h"
#include "demand/sumo_flow.h"
#include "demand/sumo_router.h"
#include "demand/sumo_types.h"
#include "network/sumo_xml.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

constexpr std::size_t kMostTrips = 20'000'000;
constexpr double kOfLength_m = 0.1;  // as files round

// Edges, all of them, or some between which the fastest way is taken.
struct Way {
    std::vector<int> edges = {};
    bool complete = true;
    bool open = true;            // to cars, all of it
    bool begins_within = false;  // on an edge that was joined to the one before
    std::string where;
    int first_turn = -1;
};

class RouteReader {
public:
    RouteReader(const SumoNetwork& network, double until_s, std::uint64_t seed)
        : network_(network), router_(network), until_s_(until_s), seed_(seed), grown_(network.net.edges.size(), 0) {
        for (const SumoEdge& edge : network.net.edges) {
            if (edge.joined_to >= 0) grown_[at(edge.joined_to)] = 1;
        }
    }

    void read(const std::filesystem::path& file, bool additional) {
        const SumoXml xml(file, {"routes", "trips", "additional", "add", "flows", "tlLogics"});
        additional_ = additional;
        xml_ = &xml;
        for (const pugi::xml_node node : xml.root()) {
            if (node.type() == pugi::node_element) read_element(node);
        }
        traffic_.hash = traffic_.hash * 0x100000001b3U ^ xml.hash();
        xml_ = nullptr;
    }

    SumoTraffic finish() {
        find_ways();
        std::vector<std::size_t> order(traffic_.trips.size());
        for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return traffic_.trips[a].depart_s < traffic_.trips[b].depart_s;
        });
        SumoTraffic sorted;
        sorted.turns = std::move(traffic_.turns);
        sorted.warnings = std::move(traffic_.warnings);
        sorted.hash = traffic_.hash;
        sorted.elements = traffic_.elements;
        sorted.later_s = traffic_.later_s;
        for (const std::size_t k : order) {
            sorted.trips.push_back(traffic_.trips[k]);
            sorted.ids.push_back(std::move(traffic_.ids[k]));
            Trip& trip = sorted.trips.back();
            const Way& way = ways_[way_of_[k]];
            trip.first_turn = way.first_turn;
            trip.turns = static_cast<int>(way.edges.size()) - 1;
            trip.approach = network_.approach_of[at(way.edges[0])];
        }
        return sorted;
    }

private:
    void read_element(pugi::xml_node node) {
        const std::string_view name = node.name();
        if (name == "vType" || name == "vTypeDistribution") return types_.read(*xml_, node, traffic_.warnings);
        if (name == "route") return name_route(node, {{read_route(node), 1.0}});
        if (name == "routeDistribution") return read_distribution(node);
        if (name == "vehicle" || name == "trip" || name == "flow") ++traffic_.elements;
        if (name == "vehicle" || name == "trip") return read_vehicle(node);
        if (name == "flow") return read_flow(node);
        if (name == "include") xml_->refuse(node, "'include' is not read: name the file in the scenario");
        if (!additional_) traffic_.warnings.note(xml_->where(node), fmt::format("'{}' is not read", name));
    }

    int edge_of(pugi::xml_node node, const char* attribute, std::string_view id) const {
        const auto found = network_.net.edge_by_id.find(std::string(id));
        if (found == network_.net.edge_by_id.end()) {
            xml_->refuse(node, fmt::format("{}: there is no edge '{}'", attribute, id));
        }
        int edge = found->second;
        while (network_.net.edges[at(edge)].joined_to >= 0) edge = network_.net.edges[at(edge)].joined_to;
        return edge;
    }

    // A route's edges follow each other.
    std::size_t read_route(pugi::xml_node node) {
        Way way;
        way.where = xml_->where(node);
        const std::string edges = xml_->text(node, "edges");
        for (const std::string_view id : sumo_words(edges)) {
            const int edge = edge_of(node, "edges", id);
            way.open = way.open && router_.drives(edge);
            if (way.edges.empty()) way.begins_within = network_.net.edges[at(edge)].id != id;
            // Twice the same: an edge that was joined to the one before.
            if (way.edges.empty() || way.edges.back() != edge) way.edges.push_back(edge);
        }
        if (way.edges.empty()) xml_->refuse(node, "edges: there is none");
        for (std::size_t k = 1; k < way.edges.size(); ++k) {
            if (!way.open || router_.turn(way.edges[k - 1], way.edges[k]) != Turn::none) continue;
            xml_->refuse(node, fmt::format("edges: edge '{}' does not lead to edge '{}'",
                                           network_.net.edges[at(way.edges[k - 1])].id,
                                           network_.net.edges[at(way.edges[k])].id));
        }
        if (node.child("stop")) traffic_.warnings.note(way.where, "stops are not read: nobody stops for them");
        if (node.attribute("repeat")) xml_->refuse(node, "repeated routes are not read");
        ways_.push_back(std::move(way));
        return ways_.size() - 1;
    }

    using Shares = std::vector<std::pair<std::size_t, double>>;  // way and share

    void name_route(pugi::xml_node node, Shares shares) {
        const std::string id = xml_->text(node, "id");
        if (!routes_.emplace(id, std::move(shares)).second) {
            xml_->refuse(node, fmt::format("there are two routes '{}'", id));
        }
    }

    void read_distribution(pugi::xml_node node) {
        Shares shares;
        double sum = 0.0;
        const auto add = [&](pugi::xml_node from, std::size_t way, double share) {
            if (share < 0.0) xml_->refuse(from, "a probability is below 0");
            shares.emplace_back(way, share);
            sum += share;
        };
        for (const pugi::xml_node child : node.children("route")) {
            const double share = xml_->number_or(child, "probability", 1.0);
            if (child.attribute("refId")) {
                add(child, known_route(child, child.attribute("refId").value()), share);
            } else {
                const std::size_t way = read_route(child);
                add(child, way, share);
                if (child.attribute("id")) name_route(child, {{way, 1.0}});
            }
        }
        const std::string members = node.attribute("routes").value();
        const std::vector<std::string_view> probabilities = sumo_words(node.attribute("probabilities").value());
        std::size_t k = 0;
        for (const std::string_view member : sumo_words(members)) {
            const auto share = k < probabilities.size() ? sumo_number(probabilities[k]) : 1.0;
            if (!share) xml_->refuse(node, "probabilities: one is not a finite number");
            add(node, known_route(node, std::string(member)), *share);
            ++k;
        }
        if (!(sum > 0.0)) xml_->refuse(node, "the distribution has no route with a share");
        name_route(node, std::move(shares));
    }

    // A distribution cannot contain itself or another one: only single routes that were read before.
    std::size_t known_route(pugi::xml_node node, const std::string& id) const {
        const auto found = routes_.find(id);
        if (found == routes_.end()) xml_->refuse(node, fmt::format("there is no route '{}' before this", id));
        if (found->second.size() != 1) xml_->refuse(node, fmt::format("'{}' is a distribution, not a route", id));
        return found->second[0].first;
    }

    // The ways among which a vehicle or a flow draws.
    Shares ways_of(pugi::xml_node node) {
        if (const pugi::xml_node child = node.child("route")) return {{read_route(child), 1.0}};
        if (const std::string id = node.attribute("route").value(); !id.empty()) {
            const auto found = routes_.find(id);
            if (found == routes_.end()) xml_->refuse(node, fmt::format("route: there is no route '{}'", id));
            return found->second;
        }
        for (const char* const other : {"fromTaz", "toTaz", "fromJunction", "toJunction", "fromXY", "toXY"}) {
            if (node.attribute(other)) xml_->refuse(node, fmt::format("'{}' is not read: give edges", other));
        }
        Way way;
        way.complete = false;
        way.where = xml_->where(node);
        const std::string from = xml_->text(node, "from");
        way.edges.push_back(edge_of(node, "from", from));
        way.begins_within = network_.net.edges[at(way.edges[0])].id != from;
        const std::string via = node.attribute("via").value();
        for (const std::string_view id : sumo_words(via)) way.edges.push_back(edge_of(node, "via", id));
        way.edges.push_back(edge_of(node, "to", xml_->text(node, "to")));
        for (const int edge : way.edges) way.open = way.open && router_.drives(edge);
        ways_.push_back(std::move(way));
        return {{ways_.size() - 1, 1.0}};
    }

    void read_where(pugi::xml_node node, Trip& trip) {
        const std::string lane = node.attribute("departLane").value();
        const std::map<std::string, Trip::Where> known{
            {"", Trip::Where::rightmost},    {"first", Trip::Where::rightmost}, {"random", Trip::Where::random},
            {"free", Trip::Where::free},     {"allowed", Trip::Where::free},    {"best", Trip::Where::best},
            {"best_prob", Trip::Where::best}};
        const auto found = known.find(lane);
        if (found != known.end()) {
            trip.where = found->second;
        } else {
            trip.where = Trip::Where::lane;
            trip.lane = xml_->whole(node, "departLane");
        }
        if (node.attribute("arrivalPos") || node.attribute("arrivalLane") || node.attribute("arrivalSpeed")) {
            traffic_.warnings.note(xml_->where(node), "'arrival...' is not read: vehicles leave at the end of an edge");
        }
        if (node.child("stop")) traffic_.warnings.note(xml_->where(node), "stops are not read: nobody stops for them");
    }

    void read_along(pugi::xml_node node, Trip& trip) {
        const std::string position = node.attribute("departPos").value();
        const std::map<std::string, Trip::Along> known{{"", Trip::Along::base},     {"base", Trip::Along::base},
                                                       {"last", Trip::Along::last}, {"random", Trip::Along::random},
                                                       {"free", Trip::Along::free}, {"random_free", Trip::Along::free}};
        if (const auto found = known.find(position); found != known.end()) {
            trip.along = found->second;
        } else if (position == "stop") {
            traffic_.warnings.note(xml_->where(node), "departPos 'stop' is not read: base is used");
        } else {
            trip.along = Trip::Along::given;
            trip.front_m = static_cast<float>(xml_->number(node, "departPos"));
        }
    }

    void read_speed(pugi::xml_node node, Trip& trip) {
        const std::string speed = node.attribute("departSpeed").value();
        const std::map<std::string, Trip::Fast> known{
            {"max", Trip::Fast::limit},    {"desired", Trip::Fast::limit}, {"speedLimit", Trip::Fast::limit},
            {"last", Trip::Fast::as_last}, {"avg", Trip::Fast::as_last},   {"random", Trip::Fast::random}};
        if (speed.empty()) return;
        if (const auto found = known.find(speed); found != known.end()) {
            trip.fast = found->second;
            return;
        }
        const double given = xml_->number(node, "departSpeed");
        if (given < 0.0 || given > 200.0) xml_->refuse(node, "departSpeed is not usable");
        trip.speed_mps = static_cast<float>(given);
    }

    // Everything but the time. False: its class does not drive here.
    struct Template {
        Trip trip;
        Shares ways;
        std::string type;
    };
    Template template_of(pugi::xml_node node) {
        Template made{{}, ways_of(node), node.attribute("type").value()};
        read_where(node, made.trip);
        read_along(node, made.trip);
        read_speed(node, made.trip);
        return made;
    }

    double drawn(std::uint64_t key) const {
        return random_uniform(seed_, traffic_.trips.size(), key, Purpose::vehicle_type);
    }

    void add(pugi::xml_node node, const Template& made, const std::string& id, double depart_s) {
        if (depart_s >= until_s_) return note_later(depart_s);
        if (traffic_.trips.size() >= kMostTrips) xml_->refuse(node, fmt::format("more than {} vehicles", kMostTrips));
        const SumoType& type = types_.of(*xml_, node, made.type, drawn(0));
        if (!type.drives) {
            traffic_.warnings.note(xml_->where(node), "vehicles of this class do not drive here and are left out");
            return;
        }
        if (!known_.insert(id).second) xml_->refuse(node, fmt::format("there are two vehicles '{}'", id));
        Trip trip = made.trip;
        trip.depart_s = depart_s;
        trip.length_m = static_cast<float>(type.length_m);
        std::vector<double> shares;
        for (const auto& [way, share] : made.ways) shares.push_back(share);
        const std::size_t way = made.ways[sumo_pick(shares, drawn(1))].first;
        if (!ways_[way].open) {
            traffic_.warnings.note(ways_[way].where,
                                   "a way over edges closed to passenger cars: its vehicles are left out");
            return;
        }
        if (trip.where == Trip::Where::lane) trip.lane = lane_from_left(node, ways_[way].edges[0], made.trip.lane);
        if (trip.along == Trip::Along::given) check_along(node, ways_[way], trip);
        way_of_.push_back(way);
        traffic_.trips.push_back(trip);
        traffic_.ids.push_back(id);
    }

    void note_later(double depart_s) { traffic_.later_s = std::min(depart_s, traffic_.later_s.value_or(depart_s)); }

    void check_along(pugi::xml_node node, const Way& way, Trip& trip) {
        const SumoEdge& edge = network_.net.edges[at(way.edges[0])];
        const double length_m = edge.lanes[0].length_m;
        if (std::abs(static_cast<double>(trip.front_m)) > length_m + kOfLength_m) {
            xml_->refuse(node, fmt::format("departPos lies beyond edge '{}' of {:.2f} m", edge.id, length_m));
        }
        const bool grown = grown_[at(way.edges[0])] != 0;
        if (!way.begins_within && (trip.front_m >= 0.0F || !grown)) {
            if (trip.front_m < 0.0F) trip.front_m = std::max(trip.front_m + static_cast<float>(length_m), 0.0F);
            return;
        }
        traffic_.warnings.note(
            xml_->where(node),
            "departPos on an edge that became the end of another one, or from the end of one that others were "
            "joined to, is not read: base is used");
        trip.along = Trip::Along::base;
    }

    // Of those on which cars may drive.
    int lane_from_left(pugi::xml_node node, int edge, int index) const {
        const std::vector<int>& lanes = network_.lane_of[at(edge)];
        if (at(index) >= lanes.size() || lanes[at(index)] < 0) {
            xml_->refuse(node, fmt::format("departLane: edge '{}' has no lane {} for passenger cars",
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
                                          "vehicles that wait for persons or containers are left out");
        }
        add(node, template_of(node), id,
            depart == "now" || depart == "begin" ? 0.0 : sumo_time_s(*xml_, node, "depart", 0.0));
    }

    void read_flow(pugi::xml_node node) {
        const std::string id = xml_->text(node, "id");
        const Template made = template_of(node);
        int count = 0;
        const double begin_s = sumo_time_s(*xml_, node, "begin", 0.0);
        if (begin_s >= until_s_) note_later(begin_s);
        for (const double depart_s : sumo_departures(*xml_, node, until_s_, seed_)) {
            add(node, made, fmt::format("{}.{}", id, count++), depart_s);
        }
    }

    // Ways that are given by some of their edges, those with the same end together; then the turns of all.
    void find_ways() {
        struct Piece {
            int to;
            int from;
            std::size_t way;
            std::size_t place;
        };
        std::vector<Piece> pieces;
        for (std::size_t k = 0; k < ways_.size(); ++k) {
            for (std::size_t i = 1; !ways_[k].complete && ways_[k].open && i < ways_[k].edges.size(); ++i) {
                pieces.push_back({ways_[k].edges[i], ways_[k].edges[i - 1], k, i});
            }
        }
        std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.to < b.to; });
        std::map<std::pair<std::size_t, std::size_t>, std::vector<int>> found;
        for (const Piece& piece : pieces) {
            std::optional<std::vector<int>> edges = router_.way(piece.from, piece.to);
            if (!edges) {
                throw InputError(fmt::format("{}: there is no way for cars from edge '{}' to edge '{}'",
                                             ways_[piece.way].where, network_.net.edges[at(piece.from)].id,
                                             network_.net.edges[at(piece.to)].id));
            }
            found[{piece.way, piece.place}] = std::move(*edges);
        }
        for (std::size_t k = 0; k < ways_.size(); ++k) {
            if (!ways_[k].open) continue;
            if (!ways_[k].complete) join(k, found);
            ways_[k].first_turn = static_cast<int>(traffic_.turns.size());
            for (std::size_t i = 1; i < ways_[k].edges.size(); ++i) {
                traffic_.turns.push_back(router_.turn(ways_[k].edges[i - 1], ways_[k].edges[i]));
            }
        }
    }

    void join(std::size_t k, const std::map<std::pair<std::size_t, std::size_t>, std::vector<int>>& found) {
        std::vector<int> all{ways_[k].edges[0]};
        for (std::size_t i = 1; i < ways_[k].edges.size(); ++i) {
            const std::vector<int>& piece = found.at({k, i});
            all.insert(all.end(), piece.begin() + 1, piece.end());
        }
        ways_[k].edges = std::move(all);
    }

    const SumoNetwork& network_;
    SumoRouter router_;
    double until_s_;
    std::uint64_t seed_;
    std::vector<char> grown_;       // [edge] 1: others are its end
    const SumoXml* xml_ = nullptr;  // the file that is read
    bool additional_ = false;
    SumoTypes types_;
    std::vector<Way> ways_;
    std::unordered_map<std::string, Shares> routes_;
    std::unordered_set<std::string> known_;
    std::vector<std::size_t> way_of_;  // [trip]
    SumoTraffic traffic_;
};

}  // namespace

double SumoTraffic::shortest_m() const {
    double shortest_m = 1e9;
    for (const Trip& trip : trips) shortest_m = std::min(shortest_m, static_cast<double>(trip.length_m));
    return shortest_m;
}

SumoTraffic read_sumo_routes(const SumoRouteFiles& files, const SumoNetwork& network, double until_s,
                             std::uint64_t seed) {
    RouteReader reader(network, until_s, seed);
    for (const std::filesystem::path& file : files.additional) reader.read(file, true);
    for (const std::filesystem::path& file : files.routes) reader.read(file, false);
    return reader.finish();
}

}  // namespace stopline
