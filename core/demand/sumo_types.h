// Vehicle types of SUMO's route files, as far as they are used: length and class.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "network/sumo_net.h"
#include "network/sumo_xml.h"

namespace stopline {

struct SumoType {
    double length_m = 5.0;
    bool drives = true;  // on lanes for passenger cars, by its class
};

// Types and distributions by name.
class SumoTypes {
public:
    SumoTypes();

    // A vType or vTypeDistribution.
    void read(const SumoXml& xml, pugi::xml_node node, SumoWarnings& warnings);
    // `drawn`: in [0, 1). Refused where there is no such type.
    const SumoType& of(const SumoXml& xml, pugi::xml_node node, const std::string& name, double drawn) const;

private:
    struct Share {
        std::size_t type;
        double share;
    };
    std::size_t read_type(const SumoXml& xml, pugi::xml_node node, SumoWarnings& warnings);
    void add(const SumoXml& xml, pugi::xml_node node, const std::string& name, std::vector<Share> shares);

    std::vector<SumoType> types_;
    std::unordered_map<std::string, std::vector<Share>> named_;
};

// The component that a number in [0, 1) falls into; shares need not sum to 1.
std::size_t sumo_pick(const std::vector<double>& shares, double drawn);

}  // namespace stopline
