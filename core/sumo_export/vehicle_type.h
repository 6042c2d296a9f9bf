// Vehicle types of SUMO's route files.
#pragma once

#include <cstddef>
#include <string>

#include "record/xml_file.h"
#include "sim/state/model.h"

namespace stopline {

struct VehicleTypeText {
    std::string id;  // escaped for XML
    double length_m = 0.0;
    bool changes_lanes = true;  // false: vehicles in SUMO change lanes only if their route requires it
};

// Writes a vType element with the parameters of the car-following model that the mesoscale mode uses for the policy.
void add_vehicle_type(XmlFile& xml, const Model& model, std::size_t policy, const VehicleTypeText& type);

}  // namespace stopline
