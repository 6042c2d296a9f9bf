// Types of vehicles for SUMO.
#pragma once

#include <cstddef>
#include <string>

#include "record/xml_file.h"
#include "sim/model.h"

namespace stopline {

struct VehicleTypeText {
    std::string id;  // escaped
    double length_m = 0.0;
    bool changes_lanes = true;  // false: not for speed either
};

// A vType with the parameters of a policy's mesoscale model.
void add_vehicle_type(XmlFile& xml, const Model& model, std::size_t policy, const VehicleTypeText& type);

}  // namespace stopline
