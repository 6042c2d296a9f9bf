#include "sim/state/queries/vehicle_names.h"

#include "base/containers/index.h"

namespace stopline {

namespace {

std::string name_of(const std::vector<std::string>* trip_names, int trip, int vehicle) {
    return trip_names != nullptr && trip >= 0 ? (*trip_names)[at(trip)] : std::to_string(vehicle);
}

}  // namespace

std::string vehicle_name(const Model& model, int trip, int vehicle) {
    return name_of(model.demand.trip_names.get(), trip, vehicle);
}

VehicleNames::VehicleNames(const Model& model, const State& state) : trip_names_(model.demand.trip_names) {
    if (trip_names_) trips_ = std::make_shared<const std::vector<int>>(state.insertion.vehicle_trips);
}

std::string VehicleNames::of(int vehicle) const {
    const bool has_trip = trips_ && vehicle >= 0 && at(vehicle) < trips_->size();
    return name_of(trip_names_.get(), has_trip ? (*trips_)[at(vehicle)] : -1, vehicle);
}

}  // namespace stopline
