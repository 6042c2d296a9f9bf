// Accelerations that a program asks for while it steps the simulation, for instance a controller of the user's own.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace stopline {

// The acceleration of a program replaces the gap law of an automated vehicle in full dynamics. It is an upper limit:
// the vehicle keeps a gap of at least about 1 m, never accelerates more than in free driving, stops at lines, yields,
// keeps speed limits and brakes in an emergency. A human driver also keeps the own distance.
class ExternalRequests {
public:
    bool empty() const { return request_mps2_.empty(); }
    // Sets the acceleration of a vehicle for all later steps. NaN gives the vehicle back to its gap law.
    void set(int vehicle, double acceleration_mps2) {
        const auto id = static_cast<std::size_t>(vehicle);
        if (id >= request_mps2_.size()) request_mps2_.resize(id + 1, std::numeric_limits<float>::quiet_NaN());
        request_mps2_[id] = static_cast<float>(acceleration_mps2);
    }
    void clear() { request_mps2_.clear(); }
    // Returns the acceleration of a vehicle, or NaN if there is none.
    float of(int vehicle) const {
        const auto id = static_cast<std::size_t>(vehicle);
        return id < request_mps2_.size() ? request_mps2_[id] : std::numeric_limits<float>::quiet_NaN();
    }

private:
    std::vector<float> request_mps2_;  // [vehicle id]
};

}  // namespace stopline
