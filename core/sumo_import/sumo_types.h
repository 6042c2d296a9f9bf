// Vehicle types of SUMO's route files. The import uses only the length and the vehicle class of a type.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "sumo_import/sumo_net.h"
#include "sumo_import/sumo_xml.h"

namespace stopline {

struct SumoType {
    double length_m = 5.0;
    bool uses_car_lanes = true;  // the vehicle class may use lanes for passenger cars
};

// All vehicle types and all distributions of vehicle types, by name.
class SumoTypes {
public:
    SumoTypes();

    // Reads a vType or vTypeDistribution element. Throws InputError with file and line if the element is invalid.
    void read(const SumoXml& xml, pugi::xml_node node, SumoWarnings& warnings);
    // Returns the type with this name. If the name belongs to a distribution, `random_number` in [0, 1) selects one of
    // its types. Throws InputError if neither a type nor a distribution has this name.
    const SumoType& pick(const SumoXml& xml, pugi::xml_node node, const std::string& name, double random_number) const;

private:
    struct Share {
        std::size_t type;
        double share;
    };
    std::size_t read_type(const SumoXml& xml, pugi::xml_node node, SumoWarnings& warnings);
    void add(const SumoXml& xml, pugi::xml_node node, const std::string& name, std::vector<Share> shares);

    std::vector<SumoType> types_;
    std::unordered_map<std::string, std::vector<Share>> types_by_name_;
};

// Returns the index of the share that a random number in [0, 1) selects. The shares need not sum to 1.
std::size_t pick_by_share(const std::vector<double>& shares, double random_number);

}  // namespace stopline
