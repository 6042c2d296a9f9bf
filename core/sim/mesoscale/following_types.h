// The registration of the car-following models of the mesoscale mode (driver/following_model.h).
#pragma once

#include <type_traits>

#include "driver/human.h"
#include "driver/idm.h"
#include "driver/krauss.h"

namespace stopline {

template <class... Models>
struct FollowingList {
    static constexpr int kCount = static_cast<int>(sizeof...(Models));
};

// Appends the models at `place` and all later places to a list.
template <int place, class... Models>
constexpr auto with_models_from(FollowingList<Models...> list) {
    if constexpr (place == kFollowingPlaces) {
        return list;
    } else {
        using Trait = typename FollowingAt<place>::Trait;
        using Longer =
            std::conditional_t<std::is_void_v<Trait>, FollowingList<Models...>, FollowingList<Models..., Trait>>;
        return with_models_from<place + 1>(Longer());
    }
}

// The trait structs of all models that this file includes. To add a model, include its file above.
using FollowingTypes = decltype(with_models_from<0>(FollowingList<>()));

}  // namespace stopline
