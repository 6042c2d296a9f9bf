#include "record/vehicle_name.h"

#include "base/io/escape.h"

namespace stopline {

std::string vehicle_name(const Model& model, int trip, int vehicle) {
    const auto& names = model.demand.trip_names;
    return trip >= 0 && names ? escape_xml((*names)[static_cast<std::size_t>(trip)]) : std::to_string(vehicle);
}

}  // namespace stopline
