// The car-following models of the mesoscale mode by name.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "driver/following_model.h"

namespace stopline {

// Returns the families of all registered models (following_types.h).
std::span<const FollowingFamily> following_families();

// Makes the car-following model of a spacing policy. `gap.family` must be the name of a family. Throws InputError with
// the known names if it is not.
FollowingModel make_following_model(const FollowingSettings& settings, const MesoGap& gap);

}  // namespace stopline
