#include "sumo_import/sumo_net.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <tuple>
#include <unordered_set>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "base/io/printable.h"
#include "sumo_import/sumo_signal_file.h"
#include "sumo_import/sumo_xml.h"

namespace stopline {

namespace {

// Converts a row of a right-of-way matrix to bits, indexed by link. In SUMO's text, the last character belongs to link
// 0.
std::vector<bool> bits_of(std::string_view text) {
    std::vector<bool> bits;
    std::transform(text.rbegin(), text.rend(), std::back_inserter(bits), [](char letter) { return letter == '1'; });
    return bits;
}

// Appends the point unless it coincides with the last point of the line.
void append_point(Polyline& line, const Point& point) {
    constexpr double kCoincident_m = 0.005;
    const bool coincides =
        !line.empty() && std::hypot(line.back().x_m - point.x_m, line.back().y_m - point.y_m) < kCoincident_m;
    if (!coincides) line.push_back(point);
}

// Elements that the import ignores, and the warning for each of them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kIgnored{{
    {"roundabout", "'roundabout' is ignored: the right-of-way matrices of its junctions apply"},
    {"prohibition", "'prohibition' is ignored: the right-of-way matrices of the junctions contain it"},
    {"WAUT", "'WAUT' is ignored: signals do not switch between programmes"},
    {"wautJunction", "'wautJunction' is ignored: signals do not switch between programmes"},
    {"stop", "'stop' is ignored: vehicles make no stops"},
}};

class NetReader {
public:
    explicit NetReader(const std::filesystem::path& file) : file_(file), xml_(file, {"net"}) {}

    SumoNet read() {
        const std::string left_hand = xml_.root().attribute("lefthand").value();
        if (left_hand == "true" || left_hand == "1") xml_.refuse(xml_.root(), "left-hand traffic is not supported");
        for (const pugi::xml_node node : xml_.root()) {
            const std::string_view name = node.name();
            if (name == "edge") read_edge(node);
            if (name == "junction") read_junction(node);
            for (const auto& [ignored, warning] : kIgnored) {
                if (name == ignored) net_.warnings.note(xml_.where(node), std::string(warning));
            }
        }
        check_references();
        for (const pugi::xml_node node : xml_.root().children("tlLogic")) add_sumo_signal(xml_, node, true, net_);
        for (const pugi::xml_node node : xml_.root().children("connection")) read_connection(node);
        const auto is_car_edge = [](const SumoEdge& edge) {
            return !edge.internal &&
                   std::any_of(edge.lanes.begin(), edge.lanes.end(), [](auto& lane) { return lane.allows_cars; });
        };
        if (std::none_of(net_.edges.begin(), net_.edges.end(), is_car_edge)) {
            xml_.refuse(xml_.root(), "the network has no lane for passenger cars");
        }
        net_.hash = xml_.hash();
        net_.version = version();
        net_.file = std::filesystem::absolute(file_).lexically_normal();
        return std::move(net_);
    }

private:
    // Returns the version of SUMO that wrote the file. If no comment in the file names this version, returns the
    // version of the file format if it is below 1.20, and nothing otherwise: every version of SUMO since 1.20 writes
    // the format version 1.20.
    std::optional<SumoVersion> version() const {
        constexpr SumoVersion kLastFormat{1, 20};
        if (xml_.version()) return xml_.version();
        const std::string format = xml_.root().attribute("version").value();
        const std::optional<SumoVersion> version = sumo_version("<!-- SUMO net " + format + " -->");
        return version && *version < kLastFormat ? version : std::nullopt;
    }

    void read_edge(pugi::xml_node node) {
        SumoEdge edge;
        edge.id = xml_.text(node, "id");
        if (!net_.edge_by_id.emplace(edge.id, static_cast<int>(net_.edges.size())).second) {
            xml_.refuse(node, fmt::format("there are two edges '{}'; ids must be unique", edge.id));
        }
        edge.where = xml_.where(node);
        const std::string function = node.attribute("function").value();
        edge.internal = !function.empty() && function != "normal" && function != "connector";
        const bool for_pedestrians = function == "crossing" || function == "walkingarea";
        if (for_pedestrians) net_.warnings.note(edge.where, "edges for pedestrians are ignored");
        note_stop_offset(node);
        for (const pugi::xml_node lane : node.children("lane")) {
            read_lane(lane, edge);
            if (for_pedestrians) edge.lanes.back().allows_cars = false;
        }
        if (edge.lanes.empty()) xml_.refuse(node, fmt::format("edge '{}' has no lane", edge.id));
        net_.edges.push_back(std::move(edge));
    }

    // Warns if an edge or lane has a stop offset.
    void note_stop_offset(pugi::xml_node node) {
        const pugi::xml_node offset = node.child("stopOffset");
        if (offset) net_.warnings.note(xml_.where(offset), "'stopOffset' is ignored");
    }

    void read_lane(pugi::xml_node node, SumoEdge& edge) {
        constexpr double kMinLength_m = 0.01;
        constexpr double kMaxLength_m = 1e6;
        constexpr double kMinSpeed_mps = 0.01;
        constexpr double kMaxSpeed_mps = 200.0;
        if (edge.lanes.size() >= kSumoLanesMax) {
            xml_.refuse(node, fmt::format("edge '{}' has more than {} lanes", edge.id, kSumoLanesMax));
        }
        const auto index = xml_.whole_number(node, "index");
        if (index != static_cast<int>(edge.lanes.size()) && !edge.internal) {
            xml_.refuse(node, fmt::format("lanes of edge '{}' must be numbered 0, 1, 2, ... in order", edge.id));
        }
        // netconvert numbers some internal lanes wrongly in `index`, but not in `id`. So `id` is checked for all lanes.
        const std::string id = xml_.text(node, "id");
        if (id != fmt::format("{}_{}", edge.id, edge.lanes.size())) {
            xml_.refuse(node, fmt::format("lane id=\"{}\" must be '{}_{}': the edge and the index of the lane", id,
                                          edge.id, edge.lanes.size()));
        }
        SumoLane lane;
        lane.length_m = xml_.number(node, "length");
        lane.speed_mps = xml_.number(node, "speed");
        if (!(lane.length_m >= kMinLength_m) || lane.length_m > kMaxLength_m) {
            xml_.refuse(node, fmt::format("length=\"{}\" must be from {} to {} m", node.attribute("length").value(),
                                          kMinLength_m, kMaxLength_m));
        }
        lane.allows_cars = sumo_allows_cars(node.attribute("allow").value(), node.attribute("disallow").value());
        if (lane.allows_cars && (!(lane.speed_mps >= kMinSpeed_mps) || lane.speed_mps > kMaxSpeed_mps)) {
            xml_.refuse(node, fmt::format("speed=\"{}\" must be from {} to {} m/s", node.attribute("speed").value(),
                                          kMinSpeed_mps, kMaxSpeed_mps));
        }
        const std::string shape = xml_.text(node, "shape");
        std::optional<Polyline> points = sumo_shape(shape);
        if (!points) xml_.refuse(node, "'shape' has a point that is not a pair of finite numbers");
        if (points->size() < 2 && !edge.internal) xml_.refuse(node, "'shape' needs at least two different points");
        lane.shape = std::move(*points);
        note_stop_offset(node);
        if (node.child("neigh")) {
            net_.warnings.note(xml_.where(node),
                               "'neigh' is ignored: vehicles do not use lanes of the opposite direction");
        }
        if (node.attribute("changeLeft") || node.attribute("changeRight")) {
            net_.warnings.note(xml_.where(node), "'changeLeft' and 'changeRight' are ignored");
        }
        edge.lanes.push_back(std::move(lane));
    }

    void read_junction(pugi::xml_node node) {
        SumoJunction junction{xml_.text(node, "id"), xml_.text(node, "type")};
        junction.where = xml_.where(node);
        const std::string& type = junction.type;
        if (!junction_ids_.insert(junction.id).second) {
            xml_.refuse(node, fmt::format("there are two junctions '{}'; ids must be unique", junction.id));
        }
        if (type == "internal") return;
        if (type == "rail_signal" || type == "rail_crossing") {
            net_.warnings.note(xml_.where(node), "railway signals and crossings are ignored");
        }
        const auto number = static_cast<int>(net_.junctions.size());
        int link = 0;
        for (const std::string_view lane : sumo_words(node.attribute("intLanes").value())) {
            net_.link_of[std::string(lane)] = {number, link++};
        }
        for (const std::string_view lane : sumo_words(node.attribute("incLanes").value())) {
            junction.incoming.emplace_back(lane);
        }
        std::size_t expected = 0;
        for (const pugi::xml_node request : node.children("request")) {
            if (expected == kSumoLinksMax) {
                xml_.refuse(request,
                            fmt::format("junction '{}' has more than {} requests", junction.id, kSumoLinksMax));
            }
            const auto index = at(xml_.whole_number(request, "index"));
            if (index != expected++) xml_.refuse(request, "requests must be numbered 0, 1, 2, ... in order");
            junction.response.push_back(bits_of(xml_.text(request, "response")));
            junction.cont.push_back(std::string_view(request.attribute("cont").value()) == "1");
            junction.foes.push_back(bits_of(xml_.text(request, "foes")));
        }
        for (std::size_t k = 0; k < junction.response.size(); ++k) {
            if (junction.response[k].size() == expected && junction.foes[k].size() == expected) continue;
            xml_.refuse(node, fmt::format("junction '{}': 'response' and 'foes' of request {} must have {} bits, one "
                                          "for each link",
                                          junction.id, k, expected));
        }
        const bool needs_requests = type != "dead_end" && type != "unregulated" && type != "traffic_light_unregulated";
        if (needs_requests && expected < at(link)) {
            xml_.refuse(node, fmt::format("junction '{}' of type '{}' has {} links in 'intLanes' but {} requests; each "
                                          "link needs a request",
                                          junction.id, type, link, expected));
        }
        net_.junctions.push_back(std::move(junction));
    }

    // Checks that the junctions of all edges and the lanes of all junctions exist. The file may list edges and
    // junctions in any order, so call this function after all of them are read.
    void check_references() const {
        for (const pugi::xml_node node : xml_.root().children("edge")) {
            if (net_.edges[at(net_.edge_by_id.at(node.attribute("id").value()))].internal) continue;
            for (const char* const end : {"from", "to"}) {
                const std::string junction = xml_.text(node, end);
                if (junction_ids_.contains(junction)) continue;
                xml_.refuse(node, fmt::format("edge '{}': {}=\"{}\": there is no junction with this id",
                                              node.attribute("id").value(), end, junction));
            }
        }
        for (const pugi::xml_node node : xml_.root().children("junction")) {
            for (const char* const list : {"incLanes", "intLanes"}) {
                for (const std::string_view lane : sumo_words(node.attribute(list).value())) {
                    if (net_.lane(lane)) continue;
                    xml_.refuse(node, fmt::format("junction '{}': '{}' names the lane '{}', which does not exist",
                                                  node.attribute("id").value(), list, lane));
                }
            }
        }
    }

    int known_edge(pugi::xml_node node, const char* attribute) const {
        const std::string id = xml_.text(node, attribute);
        const auto found = net_.edge_by_id.find(id);
        if (found == net_.edge_by_id.end()) xml_.refuse(node, fmt::format("{}: there is no edge '{}'", attribute, id));
        return found->second;
    }

    int known_lane(pugi::xml_node node, const char* attribute, int edge) const {
        const int lane = xml_.whole_number(node, attribute);
        if (at(lane) >= net_.edges[at(edge)].lanes.size()) {
            xml_.refuse(node, fmt::format("{}: edge '{}' has no lane {}", attribute, net_.edges[at(edge)].id, lane));
        }
        return lane;
    }

    const SumoLane& lane(int edge, int index) const { return net_.edges[at(edge)].lanes[at(index)]; }

    void read_via(pugi::xml_node node, SumoConnection& c) const {
        const std::string via = node.attribute("via").value();
        if (via.empty()) return;
        const auto lane = net_.lane(via);
        if (!lane) xml_.refuse(node, fmt::format("via: there is no lane '{}'", via));
        std::tie(c.via, c.via_lane) = *lane;
    }

    void read_signal(pugi::xml_node node, SumoConnection& c) {
        const std::string tl = node.attribute("tl").value();
        if (tl.empty()) return;
        c.tl = net_.signal(tl);
        c.tl_link = xml_.whole_number(node, "linkIndex");
    }

    void read_connection(pugi::xml_node node) {
        SumoConnection c;
        c.from = known_edge(node, "from");
        c.to = known_edge(node, "to");
        c.from_lane = known_lane(node, "fromLane", c.from);
        c.to_lane = known_lane(node, "toLane", c.to);
        c.where = xml_.where(node);
        // Register the signal even if the connection is closed to cars. Otherwise the import would refuse a programme
        // for this signal in an additional file, because it would not know the signal.
        if (const std::string tl = node.attribute("tl").value(); !tl.empty()) net_.signal(tl);
        if (!lane(c.from, c.from_lane).allows_cars || !lane(c.to, c.to_lane).allows_cars) return;
        if (!sumo_allows_cars(node.attribute("allow").value(), node.attribute("disallow").value())) return;
        read_via(node, c);
        read_signal(node, c);
        const std::string_view dir = node.attribute("dir").value();
        const std::string_view state = node.attribute("state").value();
        if (!dir.empty()) c.dir = dir[0];
        if (!state.empty()) c.state = state[0];
        const std::string keep_clear = node.attribute("keepClear").value();
        c.keep_clear = keep_clear != "0" && keep_clear != "false";
        const std::string pass = node.attribute("pass").value();
        c.pass = pass == "1" || pass == "true";
        count_connection(node, c);
        net_.connections.push_back(std::move(c));
    }

    // Throws InputError if the file has this connection twice, or too many connections from one lane.
    void count_connection(pugi::xml_node node, const SumoConnection& c) {
        std::vector<std::pair<int, int>>& targets = targets_[{c.from, c.from_lane}];
        const std::pair target{c.to, c.to_lane};
        if (std::find(targets.begin(), targets.end(), target) != targets.end()) {
            xml_.refuse(node, fmt::format("there are two connections from lane {} of edge '{}' to lane {} of edge '{}'",
                                          c.from_lane, net_.edges[at(c.from)].id, c.to_lane, net_.edges[at(c.to)].id));
        }
        if (targets.size() >= kSumoConnectionsMax) {
            xml_.refuse(node, fmt::format("more than {} connections begin on lane {} of edge '{}'", kSumoConnectionsMax,
                                          c.from_lane, net_.edges[at(c.from)].id));
        }
        targets.push_back(target);
    }

    std::filesystem::path file_;
    SumoXml xml_;
    SumoNet net_;
    std::unordered_set<std::string> junction_ids_;
    std::map<std::pair<int, int>, std::vector<std::pair<int, int>>> targets_;  // [edge, lane] lanes that it leads to
};

}  // namespace

double SumoSignal::cycle_s() const {
    double sum_s = 0.0;
    for (const SumoPhase& phase : phases) sum_s += phase.duration_s;
    return sum_s;
}

std::optional<std::pair<int, int>> SumoNet::lane(std::string_view id) const {
    const std::size_t cut = id.rfind('_');
    if (cut == std::string_view::npos) return std::nullopt;
    const auto edge = edge_by_id.find(std::string(id.substr(0, cut)));
    const std::string_view text = id.substr(cut + 1);
    int index = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (edge == edge_by_id.end() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    if (index < 0 || at(index) >= edges[at(edge->second)].lanes.size()) return std::nullopt;
    return std::pair{edge->second, index};
}

int SumoNet::signal(const std::string& id) {
    const auto [found, added] = signal_by_id.try_emplace(id, static_cast<int>(signals.size()));
    if (added) signals.push_back({id, "", 0.0, {}, ""});
    return found->second;
}

void SumoNet::check_lights() const {
    for (const SumoConnection& c : connections) {
        if (c.tl < 0) continue;
        const SumoSignal& signal = signals[at(c.tl)];
        if (signal.phases.empty()) {
            throw InputError(
                fmt::format("{}: tl=\"{}\": neither the network nor the additional files have a tlLogic with this id",
                            c.where, signal.id));
        }
        const std::size_t links = signal.phases[0].state.size();
        if (at(c.tl_link) < links) continue;
        throw InputError(
            fmt::format("{}: linkIndex=\"{}\" must be below {}, the number of letters in the phases of "
                        "tlLogic '{}'",
                        c.where, c.tl_link, links, signal.id));
    }
}

void SumoWarnings::note(const std::string& where, const std::string& message) {
    constexpr int kListedPlaces = 3;
    const auto [known, is_new] = kind_by_message_.try_emplace(message, kinds_.size());
    if (is_new) kinds_.push_back({message, {}, 0});
    Kind& kind = kinds_[known->second];
    if (++kind.count <= kListedPlaces) kind.places.push_back(where);
}

std::vector<std::string> SumoWarnings::lines() const {
    std::vector<std::string> lines;
    for (const Kind& kind : kinds_) {
        for (const std::string& place : kind.places) lines.push_back(printable_text(place + ": " + kind.message));
        const int unlisted = kind.count - static_cast<int>(kind.places.size());
        if (unlisted > 0) lines.push_back(printable_text(fmt::format("{} more times: {}", unlisted, kind.message)));
    }
    return lines;
}

bool sumo_allows_cars(std::string_view allow, std::string_view disallow) {
    const auto has = [](std::string_view list, std::string_view name) {
        const std::vector<std::string_view> words = sumo_words(list);
        return std::find(words.begin(), words.end(), name) != words.end();
    };
    if (!allow.empty()) return has(allow, "passenger") || has(allow, "all");
    return !has(disallow, "passenger") && !has(disallow, "all");
}

std::optional<Polyline> sumo_shape(std::string_view text) {
    constexpr double kMaxCoordinate_m = 1e8;
    Polyline line;
    for (const std::string_view word : sumo_words(text)) {
        const std::size_t comma = word.find(',');
        if (comma == std::string_view::npos) return std::nullopt;
        const std::size_t end = std::min(word.find(',', comma + 1), word.size());
        const auto x = sumo_number(word.substr(0, comma));
        const auto y = sumo_number(word.substr(comma + 1, end - comma - 1));
        if (!x || !y || std::abs(*x) > kMaxCoordinate_m || std::abs(*y) > kMaxCoordinate_m) return std::nullopt;
        append_point(line, {*x, *y});
    }
    return line;
}

void sumo_append(Polyline& line, const Polyline& points) {
    for (const Point& point : points) append_point(line, point);
}

SumoNet read_sumo_net(const std::filesystem::path& file) { return NetReader(file).read(); }

}  // namespace stopline
