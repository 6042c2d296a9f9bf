#include "spacing_laws/gap_policy.h"

#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"

namespace stopline {

extern const GapLaw kConstantDistanceLaw;
extern const GapLaw kConstantTimeLaw;
extern const GapLaw kSwitchTimeGapLaw;
extern const GapLaw kSwitchDistanceLaw;

std::span<const GapLaw> gap_laws() {
    static const std::array kLaws{kConstantDistanceLaw, kConstantTimeLaw, kSwitchTimeGapLaw, kSwitchDistanceLaw};
    return kLaws;
}

const GapLaw& find_gap_law(const std::string& name) {
    for (const GapLaw& law : gap_laws()) {
        if (name == law.name) return law;
    }
    throw InputError(
        fmt::format("there is no spacing law '{}'; the laws are: {}", name, fmt::join(gap_law_names(), ", ")));
}

std::vector<std::string> gap_law_names() {
    std::vector<std::string> names;
    for (const GapLaw& law : gap_laws()) names.emplace_back(law.name);
    return names;
}

double equilibrium_gap_m(const GapPolicySettings& settings, double speed_mps) {
    double gap_m = 0.0;
    double slope_s = 0.0;
    find_gap_law(settings.law).evaluate(settings, {&speed_mps, 1}, {&gap_m, 1}, {&slope_s, 1});
    return gap_m;
}

}  // namespace stopline
