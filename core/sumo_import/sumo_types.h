// Vehicle types of SUMO's route files. The import always uses the length and the vehicle class of a type. It uses the
// driving behaviour of a type if the scenario asks for it (NetworkSettings::vehicles).
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "sumo_import/sumo_net.h"
#include "sumo_import/sumo_xml.h"

namespace stopline {

// The driving behaviour of a vehicle type. The defaults are those of SUMO 1.28 for passenger cars.
struct SumoDriving {
    double acceleration_mps2 = 2.6;          // accel
    double deceleration_mps2 = 4.5;          // decel
    double maximum_speed_mps = 200.0 / 3.6;  // maxSpeed
    double time_gap_s = 1.0;                 // tau
    double standstill_gap_m = 2.5;           // minGap
    double dawdling = 0.5;                   // sigma

    bool operator==(const SumoDriving&) const = default;
};

struct SumoType {
    double length_m = 5.0;
    bool uses_car_lanes = true;  // the vehicle class may use lanes for passenger cars
    SumoDriving driving = {};
    std::string where = {};  // file and line; empty: a default type of SUMO

    // Returns true if both types have the same length and driving behaviour.
    bool is_like(const SumoType& other) const { return length_m == other.length_m && driving == other.driving; }
};

// All vehicle types and all distributions of vehicle types, by name.
class SumoTypes {
public:
    // `uses_driving`: true if the import uses the driving behaviour of the types. If it is false, the attributes of the
    // driving behaviour are ignored, and some of them cause a warning.
    explicit SumoTypes(bool uses_driving);

    // Reads a vType or vTypeDistribution element. Throws InputError with file and line if the element is invalid.
    void read(const SumoXml& xml, pugi::xml_node node, SumoWarnings& warnings);
    // Returns the type with this name. If the name belongs to a distribution, `random_number` in [0, 1) selects one of
    // its types. Throws InputError if neither a type nor a distribution has this name.
    const SumoType& pick(const SumoXml& xml, pugi::xml_node node, const std::string& name, double random_number) const;

private:
    struct Share {
        std::size_t type;
        double upper;  // sum of the shares up to this one
    };
    std::size_t read_type(const SumoXml& xml, pugi::xml_node node, SumoWarnings& warnings);
    void add(const SumoXml& xml, pugi::xml_node node, const std::string& name, std::vector<Share> shares);

    // Returns the end of a message about an unknown type: the most similar name, and the known names.
    std::string names_hint(std::string_view unknown) const;

    bool uses_driving_;
    std::vector<SumoType> types_;
    std::unordered_map<std::string, std::vector<Share>> types_by_name_;
};

// Returns the index of a vehicle type in the list of different types. Adds the type if it is new. Throws InputError
// with the place of `node` if there are too many types: the simulation computes each type in a pass of its own.
int index_of(const SumoXml& xml, pugi::xml_node node, const SumoType& type, std::vector<SumoType>& types);

// Returns the element that a random number in [0, 1) selects from a list of shares. `upper_of` returns the sum of the
// shares up to an element. The shares need not sum to 1.
template <class Share, class UpperOf>
const Share& pick_by_share(const std::vector<Share>& shares, double random_number, const UpperOf& upper_of) {
    const double place = random_number * upper_of(shares.back());
    const auto found = std::partition_point(shares.begin(), shares.end(),
                                            [&](const Share& share) { return place >= upper_of(share); });
    return found == shares.end() ? shares.back() : *found;
}

}  // namespace stopline
