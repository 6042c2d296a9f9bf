#include "sim/mesoscale/following_families.h"

#include <array>
#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "sim/mesoscale/following_types.h"
#include "sim/mesoscale/meso_kernels.h"

namespace stopline {

namespace {

template <CarFollowing... Models>
std::vector<FollowingFamily> families_of(FollowingList<Models...> /*unused*/) {
    std::vector<FollowingFamily> families;
    const auto add = [&]<int kType, class M>(std::integral_constant<int, kType> /*unused*/, const M* /*unused*/) {
        for (const FollowingName& name : M::kNames) {
            families.push_back(following_family<M>(
                name, [](bool scalar) -> const MesoKernels& { return meso_kernels(kType, scalar); }));
        }
    };
    const auto add_all = [&]<int... kTypes>(std::integer_sequence<int, kTypes...> /*unused*/) {
        (add(std::integral_constant<int, kTypes>(), static_cast<const Models*>(nullptr)), ...);
    };
    add_all(std::make_integer_sequence<int, sizeof...(Models)>());
    return families;
}

}  // namespace

std::span<const FollowingFamily> following_families() {
    static const std::vector<FollowingFamily> kFamilies = families_of(FollowingTypes());
    return kFamilies;
}

FollowingModel make_following_model(const FollowingSettings& settings, const MesoGap& gap) {
    std::vector<std::string_view> names;
    for (const FollowingFamily& family : following_families()) {
        if (gap.family == family.text.name) return family.make(family, settings, gap);
        names.emplace_back(family.text.name);
    }
    throw InputError(fmt::format("there is no car-following model '{}' of the mesoscale mode; the models are: {}",
                                 gap.family, fmt::join(names, ", ")));
}

}  // namespace stopline
