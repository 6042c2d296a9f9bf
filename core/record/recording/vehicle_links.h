// Links between vehicles that coordinate: which vehicle asks or waits for which other vehicle or lane. A recording
// contains the links of each frame. A new kind of link is a function and a line in vehicle_links.cpp.
#pragma once

#include <span>
#include <vector>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

struct VehicleLink {
    int kind = 0;  // index in link_kinds_of()
    int vehicle = -1;
    int other = -1;  // vehicle at the other end; -1: none
    int lane = -1;   // lane at the other end; -1: none

    bool operator==(const VehicleLink&) const = default;
};

struct LinkKind {
    const char* name;
    bool (*occurs)(const Model& model);  // returns true if runs of the model can have such links
    // Adds the links between two steps. `kind`: VehicleLink::kind of the new links.
    void (*add)(const State& state, int kind, std::vector<VehicleLink>& links);
};

// Returns the kinds of links that can occur in runs of a model.
std::vector<const LinkKind*> link_kinds_of(const Model& model);

}  // namespace stopline
