// The registration of the car-following models of the mesoscale mode (driver/following_model.h).
#pragma once

#include "driver/human.h"
#include "driver/idm.h"
#include "driver/krauss.h"

namespace stopline {

template <class... Models>
struct FollowingList {
    static constexpr int kCount = static_cast<int>(sizeof...(Models));
};

// The trait structs of all models. To add a model, include its header above and name its struct here.
using FollowingTypes = FollowingList<Krauss, Idm, Human>;

}  // namespace stopline
