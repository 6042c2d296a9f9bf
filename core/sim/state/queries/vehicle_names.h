// The names of vehicles in result files and messages.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns the name of the vehicle's trip, such as SUMO's id in an imported network. Returns the number of the vehicle
// if `trip` is -1 or if trips have no names.
std::string vehicle_name(const Model& model, int trip, int vehicle);

// Names all vehicles of a run as vehicle_name() does, including vehicles that have left the network. It can outlive the
// model and the state.
class VehicleNames {
public:
    VehicleNames() = default;  // each vehicle is named by its number
    VehicleNames(const Model& model, const State& state);

    // Returns the name of a vehicle that entered before this object was made. Returns the number of any other vehicle.
    std::string of(int vehicle) const;

private:
    std::shared_ptr<const std::vector<std::string>> trip_names_;  // [trip] null: trips have no names
    std::shared_ptr<const std::vector<int>> trips_;               // [vehicle] its trip; null: trips have no names
};

}  // namespace stopline
