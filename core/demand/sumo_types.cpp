#include "demand/sumo_types.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

namespace stopline {

namespace {

struct Class {
    std::string_view name;
    double length_m;  // SUMO's default, https://sumo.dlr.de/docs/Vehicle_Type_Parameter_Defaults.html
    bool drives;
};

constexpr std::array<Class, 25> kClasses{{
    {"passenger", 5.0, true},     {"private", 5.0, true},   {"taxi", 5.0, true},          {"hov", 5.0, true},
    {"evehicle", 5.0, true},      {"emergency", 6.5, true}, {"authority", 5.0, true},     {"army", 5.0, true},
    {"vip", 5.0, true},           {"custom1", 5.0, true},   {"custom2", 5.0, true},       {"bus", 12.0, true},
    {"coach", 14.0, true},        {"delivery", 6.5, true},  {"truck", 7.1, true},         {"trailer", 16.5, true},
    {"motorcycle", 2.2, true},    {"moped", 2.1, true},     {"ignoring", 5.0, true},      {"bicycle", 1.6, false},
    {"pedestrian", 0.215, false}, {"tram", 22.0, false},    {"rail_urban", 109.5, false}, {"rail", 135.0, false},
    {"ship", 17.0, false},
}};

// Attributes of types that are read, or change nothing but what SUMO draws.
constexpr std::string_view kNotTold = " id length vClass probability color guiShape imgFile osgFile ";
// Of those that are not read.
constexpr std::string_view kNumbers =
    " speedDev sigma tau accel decel emergencyDecel minGap maxSpeed speedFactor lcStrategic ";

bool is_in(std::string_view list, std::string_view word) {
    return list.find(fmt::format(" {} ", word)) != std::string_view::npos;
}

void tell_unread(const SumoXml& xml, pugi::xml_node type, SumoWarnings& warnings) {
    for (const pugi::xml_attribute attribute : type.attributes()) {
        const std::string name = attribute.name();
        if (is_in(kNotTold, name)) continue;
        const std::string_view text = attribute.value();
        if (is_in(kNumbers, name) && text.find('(') == std::string_view::npos) xml.number_if(type, name.c_str());
        warnings.note(xml.where(type), fmt::format("'{}' of types is not read: populations and drivers say it", name));
    }
    for (const pugi::xml_node child : type.children()) {
        if (child.type() != pugi::node_element) continue;
        warnings.note(xml.where(child), fmt::format("'{}' of types is not read", child.name()));
    }
}

}  // namespace

std::size_t sumo_pick(const std::vector<double>& shares, double drawn) {
    double sum = 0.0;
    for (const double share : shares) sum += share;
    std::size_t k = 0;
    double upper = shares[0];
    while (drawn * sum >= upper && k + 1 < shares.size()) upper += shares[++k];
    return k;
}

SumoTypes::SumoTypes() {
    types_.emplace_back();
    for (const char* const name : {"", "DEFAULT_VEHTYPE", "DEFAULT_TAXITYPE"}) named_[name] = {{0, 1.0}};
    types_.push_back({1.6, false});
    for (const char* const name : {"DEFAULT_BIKETYPE", "DEFAULT_PEDTYPE", "DEFAULT_RAILTYPE"})
        named_[name] = {{1, 1.0}};
}

std::size_t SumoTypes::read_type(const SumoXml& xml, pugi::xml_node node, SumoWarnings& warnings) {
    constexpr double kLongest_m = 100.0;
    constexpr double kShortest_m = 1.0;
    SumoType type;
    if (const std::string name = node.attribute("vClass").value(); !name.empty()) {
        const auto known =
            std::find_if(kClasses.begin(), kClasses.end(), [&](auto& each) { return each.name == name; });
        if (known != kClasses.end()) {
            type = {known->length_m, known->drives};
        } else {
            type.drives = false;
            warnings.note(xml.where(node), fmt::format("vehicles of class '{}' do not drive here", name));
        }
    }
    if (const auto length_m = xml.number_if(node, "length")) {
        type.length_m = *length_m;
        if (type.drives && (type.length_m < kShortest_m || type.length_m > kLongest_m)) {
            xml.refuse(node, fmt::format("length=\"{}\" must be {} to {} m", node.attribute("length").value(),
                                         kShortest_m, kLongest_m));
        }
    }
    tell_unread(xml, node, warnings);
    types_.push_back(type);
    return types_.size() - 1;
}

void SumoTypes::add(const SumoXml& xml, pugi::xml_node node, const std::string& name, std::vector<Share> shares) {
    if (name.starts_with("DEFAULT_")) {
        named_[name] = std::move(shares);
        if (name == "DEFAULT_VEHTYPE") named_[""] = named_[name];
        return;
    }
    if (!named_.emplace(name, std::move(shares)).second)
        xml.refuse(node, fmt::format("there are two types '{}'", name));
}

void SumoTypes::read(const SumoXml& xml, pugi::xml_node node, SumoWarnings& warnings) {
    const std::string id = xml.text(node, "id");
    if (node.name() == std::string_view("vType")) return add(xml, node, id, {{read_type(xml, node, warnings), 1.0}});
    std::vector<Share> shares;
    const auto positive = [&](pugi::xml_node at, double share) {
        if (share < 0.0) xml.refuse(at, "a probability is below 0");
        return share;
    };
    for (const pugi::xml_node child : node.children("vType")) {
        const std::size_t type = read_type(xml, child, warnings);
        shares.push_back({type, positive(child, xml.number_or(child, "probability", 1.0))});
        if (child.attribute("id")) add(xml, child, child.attribute("id").value(), {{type, 1.0}});
    }
    const std::string members = node.attribute("vTypes").value();
    const std::vector<std::string_view> probabilities = sumo_words(node.attribute("probabilities").value());
    std::size_t k = 0;
    for (const std::string_view member : sumo_words(members)) {
        const auto known = named_.find(std::string(member));
        if (known == named_.end() || known->second.size() != 1) {
            xml.refuse(node, fmt::format("vTypeDistribution '{}': there is no vType '{}'", id, member));
        }
        const auto share = k < probabilities.size() ? sumo_number(probabilities[k]) : 1.0;
        if (!share) xml.refuse(node, fmt::format("vTypeDistribution '{}': a probability is not a finite number", id));
        shares.push_back({known->second[0].type, positive(node, *share)});
        ++k;
    }
    double sum = 0.0;
    for (const Share& share : shares) sum += share.share;
    if (!(sum > 0.0)) xml.refuse(node, fmt::format("vTypeDistribution '{}' has no type with a share", id));
    add(xml, node, id, std::move(shares));
}

const SumoType& SumoTypes::of(const SumoXml& xml, pugi::xml_node node, const std::string& name, double drawn) const {
    const auto found = named_.find(name);
    if (found == named_.end()) xml.refuse(node, fmt::format("there is no vType '{}'", name));
    std::vector<double> shares;
    for (const Share& share : found->second) shares.push_back(share.share);
    return types_[found->second[sumo_pick(shares, drawn)].type];
}

}  // namespace stopline
