#include "sumo_import/sumo_departure.h"

#include <map>

#include <fmt/format.h>

#include "base/nearest_name.h"

namespace stopline {

namespace {

constexpr SumoVersion kNewDefaults{1, 27};  // first version of SUMO with the defaults best_prob and avg

// Throws InputError unless an attribute that is none of the known words is a number.
template <class Meaning>
void require_number(const SumoXml& xml, pugi::xml_node node, const char* attribute,
                    const std::map<std::string, Meaning>& known) {
    const std::string text = node.attribute(attribute).value();
    if (sumo_number(text)) return;
    std::vector<std::string> words;
    for (const auto& [word, meaning] : known) {
        if (!word.empty()) words.push_back(word);
    }
    xml.refuse(node, fmt::format("element '{}': {}=\"{}\" is neither a number nor a known word{}", node.name(),
                                 attribute, shortened(text), known_names_hint(text, words)));
}

// Reads departLane. Returns false if the element does not have the attribute.
bool read_lane(const SumoXml& xml, pugi::xml_node node, Trip& trip) {
    const std::string lane = node.attribute("departLane").value();
    const std::map<std::string, Trip::DepartLane> known{
        {"first", Trip::DepartLane::rightmost}, {"random", Trip::DepartLane::random},
        {"free", Trip::DepartLane::free},       {"allowed", Trip::DepartLane::free},
        {"best", Trip::DepartLane::best},       {"best_prob", Trip::DepartLane::best}};
    if (lane.empty()) return false;
    if (const auto found = known.find(lane); found != known.end()) {
        trip.depart_lane = found->second;
        return true;
    }
    require_number(xml, node, "departLane", known);
    trip.depart_lane = Trip::DepartLane::given;
    trip.lane = xml.whole_number(node, "departLane");
    return true;
}

// Reads departSpeed. Returns false if the element does not have the attribute.
bool read_speed(const SumoXml& xml, pugi::xml_node node, Trip& trip) {
    constexpr double kMaxSpeed_mps = 200.0;
    const std::string speed = node.attribute("departSpeed").value();
    const std::map<std::string, Trip::DepartSpeed> known{
        {"max", Trip::DepartSpeed::limit},        {"desired", Trip::DepartSpeed::limit},
        {"speedLimit", Trip::DepartSpeed::limit}, {"last", Trip::DepartSpeed::last},
        {"avg", Trip::DepartSpeed::mean},         {"random", Trip::DepartSpeed::random}};
    if (speed.empty()) return false;
    if (const auto found = known.find(speed); found != known.end()) {
        trip.depart_speed = found->second;
        return true;
    }
    require_number(xml, node, "departSpeed", known);
    const double given_mps = xml.number(node, "departSpeed");
    if (given_mps < 0.0 || given_mps > kMaxSpeed_mps) {
        xml.refuse(node, fmt::format("'departSpeed' must be between 0 and {} m/s", kMaxSpeed_mps));
    }
    trip.depart_speed = Trip::DepartSpeed::given;
    trip.speed_mps = static_cast<float>(given_mps);
    return true;
}

void read_position(const SumoXml& xml, pugi::xml_node node, SumoWarnings& warnings, Trip& trip) {
    const std::string position = node.attribute("departPos").value();
    const std::map<std::string, Trip::DepartPosition> known{
        {"", Trip::DepartPosition::base},     {"base", Trip::DepartPosition::base},
        {"last", Trip::DepartPosition::last}, {"random", Trip::DepartPosition::random},
        {"free", Trip::DepartPosition::free}, {"random_free", Trip::DepartPosition::free}};
    if (const auto found = known.find(position); found != known.end()) {
        trip.depart_position = found->second;
    } else if (position == "stop") {
        warnings.note(xml.where(node), "departPos=\"stop\" is not supported; 'base' is used");
    } else {
        require_number(xml, node, "departPos", known);
        trip.depart_position = Trip::DepartPosition::given;
        trip.front_m = static_cast<float>(xml.number(node, "departPos"));
    }
}

}  // namespace

SumoDepartureDefaults sumo_departure_defaults(const SumoXml& routes, const SumoNet& net) {
    SumoDepartureDefaults defaults;
    const std::optional<SumoVersion> version = routes.version() ? routes.version() : net.version;
    if (!version) {
        defaults.reason = fmt::format("the defaults since SUMO {}; the files name no version", text_of(kNewDefaults));
        return defaults;
    }
    if (*version < kNewDefaults) {
        defaults.lane = Trip::DepartLane::rightmost;
        defaults.speed = Trip::DepartSpeed::given;
    }
    defaults.reason = fmt::format("the defaults of SUMO {}, which wrote the {} file", text_of(*version),
                                  routes.version() ? "route" : "network");
    return defaults;
}

std::string text_of(const SumoDepartureDefaults& defaults) {
    const bool is_new = defaults.lane == Trip::DepartLane::best;
    return fmt::format(R"(departLane="{}" departSpeed="{}" ({}))", is_new ? "best_prob" : "first", is_new ? "avg" : "0",
                       defaults.reason);
}

bool read_sumo_departure(const SumoXml& xml, pugi::xml_node node, const SumoDepartureDefaults& defaults,
                         SumoWarnings& warnings, Trip& trip) {
    trip.depart_lane = defaults.lane;
    trip.depart_speed = defaults.speed;
    const bool has_lane = read_lane(xml, node, trip);
    const bool has_speed = read_speed(xml, node, trip);
    read_position(xml, node, warnings, trip);
    return !has_lane || !has_speed;
}

}  // namespace stopline
