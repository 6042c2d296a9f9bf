#include "sumo_import/sumo_types.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

namespace stopline {

namespace {

struct VehicleClass {
    std::string_view name;
    // Defaults of SUMO 1.28, https://sumo.dlr.de/docs/Vehicle_Type_Parameter_Defaults.html
    double length_m;
    bool uses_car_lanes;
    double acceleration_mps2 = 2.6;
    double deceleration_mps2 = 4.5;
    double maximum_speed_kmh = 200.0;
};

constexpr std::array<VehicleClass, 25> kClasses{{
    {"passenger", 5.0, true},
    {"private", 5.0, true},
    {"taxi", 5.0, true},
    {"hov", 5.0, true},
    {"evehicle", 5.0, true},
    {"emergency", 6.5, true},
    {"authority", 5.0, true},
    {"army", 5.0, true},
    {"vip", 5.0, true},
    {"custom1", 5.0, true},
    {"custom2", 5.0, true},
    {"bus", 12.0, true, 1.2, 4.0, 100.0},
    {"coach", 14.0, true, 2.0, 4.0, 100.0},
    {"delivery", 6.5, true},
    {"truck", 7.1, true, 1.3, 4.0, 130.0},
    {"trailer", 16.5, true, 1.1, 4.0, 130.0},
    {"motorcycle", 2.2, true, 6.0, 10.0, 200.0},
    {"moped", 2.1, true, 1.1, 7.0, 60.0},
    {"ignoring", 5.0, true},
    {"bicycle", 1.6, false},
    {"pedestrian", 0.215, false},
    {"tram", 22.0, false},
    {"rail_urban", 109.5, false},
    {"rail", 135.0, false},
    {"ship", 17.0, false},
}};

// Attributes without a warning: the import reads them, or they only change how SUMO draws a vehicle.
constexpr std::string_view kWithoutWarning = " id length vClass probability color guiShape imgFile osgFile ";
// Attributes that the import ignores. Their values must still be numbers or distributions such as normc(...).
constexpr std::string_view kIgnoredNumbers =
    " speedDev sigma tau accel decel emergencyDecel minGap maxSpeed speedFactor lcStrategic ";

bool is_in(std::string_view list, std::string_view word) {
    return list.find(fmt::format(" {} ", word)) != std::string_view::npos;
}

// Attributes that describe the driving behaviour (SumoDriving).
constexpr std::string_view kDriving = " accel decel maxSpeed tau minGap sigma ";

// Reads an attribute of the driving behaviour. Throws InputError if it is outside of the range.
void read_driving(const SumoXml& xml, pugi::xml_node node, const char* name, double min, double max, double& value) {
    const auto given = xml.optional_number(node, name);
    if (!given) return;
    if (*given < min || *given > max) {
        xml.refuse(
            node, fmt::format("{}=\"{}\" must be between {:g} and {:g}", name, node.attribute(name).value(), min, max));
    }
    value = *given;
}

SumoDriving read_driving(const SumoXml& xml, pugi::xml_node node, SumoDriving driving) {
    read_driving(xml, node, "accel", 0.1, 20.0, driving.acceleration_mps2);
    read_driving(xml, node, "decel", 0.5, 20.0, driving.deceleration_mps2);
    read_driving(xml, node, "maxSpeed", 1.0, 150.0, driving.maximum_speed_mps);
    read_driving(xml, node, "tau", 0.1, 10.0, driving.time_gap_s);
    read_driving(xml, node, "minGap", 0.5, 100.0, driving.standstill_gap_m);
    read_driving(xml, node, "sigma", 0.0, 1.0, driving.dawdling);
    return driving;
}

void warn_about_ignored(const SumoXml& xml, pugi::xml_node type, bool uses_driving, SumoWarnings& warnings) {
    for (const pugi::xml_attribute attribute : type.attributes()) {
        const std::string name = attribute.name();
        if (is_in(kWithoutWarning, name) || (uses_driving && is_in(kDriving, name))) continue;
        const std::string_view text = attribute.value();
        if (is_in(kIgnoredNumbers, name) && text.find('(') == std::string_view::npos)
            xml.optional_number(type, name.c_str());
        warnings.note(
            xml.where(type),
            fmt::format("'{}' is ignored: the scenario's populations and drivers define the driving behaviour", name));
    }
    for (const pugi::xml_node child : type.children()) {
        if (child.type() != pugi::node_element) continue;
        warnings.note(xml.where(child), fmt::format("the element '{}' is ignored", child.name()));
    }
}

}  // namespace

int index_of(const SumoXml& xml, pugi::xml_node node, const SumoType& type, std::vector<SumoType>& types) {
    constexpr std::size_t kMaxTypes = 100;
    const auto found =
        std::find_if(types.begin(), types.end(), [&](const SumoType& known) { return known.is_like(type); });
    const auto index = static_cast<int>(found - types.begin());
    if (found != types.end()) return index;
    if (types.size() == kMaxTypes) {
        xml.refuse(node, fmt::format("the vehicles have more than {} different types (network.vehicles is "
                                     "'from_routes')",
                                     kMaxTypes));
    }
    types.push_back(type);
    return index;
}

SumoTypes::SumoTypes(bool uses_driving) : uses_driving_(uses_driving) {
    types_.emplace_back();
    for (const char* const name : {"", "DEFAULT_VEHTYPE", "DEFAULT_TAXITYPE"}) types_by_name_[name] = {{0, 1.0}};
    types_.push_back({1.6, false});
    for (const char* const name : {"DEFAULT_BIKETYPE", "DEFAULT_PEDTYPE", "DEFAULT_RAILTYPE"})
        types_by_name_[name] = {{1, 1.0}};
}

std::size_t SumoTypes::read_type(const SumoXml& xml, pugi::xml_node node, SumoWarnings& warnings) {
    constexpr double kMaxLength_m = 100.0;
    constexpr double kMinLength_m = 1.0;
    SumoType type;
    if (const std::string name = node.attribute("vClass").value(); !name.empty()) {
        const auto known =
            std::find_if(kClasses.begin(), kClasses.end(), [&](auto& known_class) { return known_class.name == name; });
        if (known != kClasses.end()) {
            type.length_m = known->length_m;
            type.uses_car_lanes = known->uses_car_lanes;
            type.driving.acceleration_mps2 = known->acceleration_mps2;
            type.driving.deceleration_mps2 = known->deceleration_mps2;
            type.driving.maximum_speed_mps = known->maximum_speed_kmh / 3.6;
        } else {
            type.uses_car_lanes = false;
            warnings.note(xml.where(node),
                          fmt::format("vehicles of class '{}' are ignored: they do not use car lanes", name));
        }
    }
    if (const auto length_m = xml.optional_number(node, "length")) {
        type.length_m = *length_m;
        if (type.uses_car_lanes && (type.length_m < kMinLength_m || type.length_m > kMaxLength_m)) {
            xml.refuse(node, fmt::format("length=\"{}\" must be between {} and {} m", node.attribute("length").value(),
                                         kMinLength_m, kMaxLength_m));
        }
    }
    if (uses_driving_) type.driving = read_driving(xml, node, type.driving);
    type.where = xml.where(node);
    warn_about_ignored(xml, node, uses_driving_, warnings);
    types_.push_back(type);
    return types_.size() - 1;
}

void SumoTypes::add(const SumoXml& xml, pugi::xml_node node, const std::string& name, std::vector<Share> shares) {
    if (name.starts_with("DEFAULT_")) {
        types_by_name_[name] = std::move(shares);
        if (name == "DEFAULT_VEHTYPE") types_by_name_[""] = types_by_name_[name];
        return;
    }
    if (!types_by_name_.emplace(name, std::move(shares)).second)
        xml.refuse(node, fmt::format("there are two types '{}'; ids must be unique", name));
}

void SumoTypes::read(const SumoXml& xml, pugi::xml_node node, SumoWarnings& warnings) {
    const std::string id = xml.text(node, "id");
    if (node.name() == std::string_view("vType")) return add(xml, node, id, {{read_type(xml, node, warnings), 1.0}});
    std::vector<Share> shares;
    double sum = 0.0;
    const auto add_share = [&](pugi::xml_node at, std::size_t type, double share) {
        if (share < 0.0) xml.refuse(at, "a probability must be at least 0");
        shares.push_back({type, sum += share});
    };
    for (const pugi::xml_node child : node.children("vType")) {
        const std::size_t type = read_type(xml, child, warnings);
        add_share(child, type, xml.number_or(child, "probability", 1.0));
        if (child.attribute("id")) add(xml, child, child.attribute("id").value(), {{type, 1.0}});
    }
    const std::string members = node.attribute("vTypes").value();
    const std::vector<std::string_view> probabilities = sumo_words(node.attribute("probabilities").value());
    std::size_t k = 0;
    for (const std::string_view member : sumo_words(members)) {
        const auto known = types_by_name_.find(std::string(member));
        if (known == types_by_name_.end() || known->second.size() != 1) {
            xml.refuse(node, fmt::format("vTypeDistribution '{}': there is no vType '{}' before this element{}", id,
                                         member, names_hint(member)));
        }
        const auto share = k < probabilities.size() ? sumo_number(probabilities[k]) : 1.0;
        if (!share) xml.refuse(node, fmt::format("vTypeDistribution '{}': a probability must be a finite number", id));
        add_share(node, known->second[0].type, *share);
        ++k;
    }
    if (!(sum > 0.0))
        xml.refuse(node, fmt::format("vTypeDistribution '{}' needs a type with a probability above 0", id));
    add(xml, node, id, std::move(shares));
}

std::string SumoTypes::names_hint(std::string_view unknown) const {
    std::vector<std::string> names;
    for (const auto& [name, shares] : types_by_name_) {
        if (!name.empty()) names.push_back(name);
    }
    return known_ids_hint(unknown, std::move(names));
}

const SumoType& SumoTypes::pick(const SumoXml& xml, pugi::xml_node node, const std::string& name,
                                double random_number) const {
    const auto found = types_by_name_.find(name);
    if (found == types_by_name_.end())
        xml.refuse(node, fmt::format("there is no vType '{}'{}", name, names_hint(name)));
    return types_[pick_by_share(found->second, random_number, [](const Share& share) { return share.upper; }).type];
}

}  // namespace stopline
