// The list of spacing laws.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/defined_elsewhere.h"
#include "base/input_error.h"
#include "spacing_laws/gap_policy.h"

namespace stopline {

// Returns the laws. The order is the order in lists for the user.
static std::vector<const GapLaw*>& laws() {
    static std::vector<const GapLaw*> all{
        // NOLINTBEGIN(readability-identifier-naming): the macro declares constants of the namespace inside a function.
        STOPLINE_DEFINED_ELSEWHERE(GapLaw, kConstantDistanceLaw),
        STOPLINE_DEFINED_ELSEWHERE(GapLaw, kConstantTimeLaw),
        STOPLINE_DEFINED_ELSEWHERE(GapLaw, kSwitchTimeGapLaw),
        STOPLINE_DEFINED_ELSEWHERE(GapLaw, kSwitchDistanceLaw),
        STOPLINE_DEFINED_ELSEWHERE(GapLaw, kFormulaLaw),
        STOPLINE_DEFINED_ELSEWHERE(GapLaw, kTableLaw),
        STOPLINE_DEFINED_ELSEWHERE(GapLaw, kHumanLaw),
        // NOLINTEND(readability-identifier-naming)
    };
    return all;
}

std::span<const GapLaw* const> gap_laws() { return laws(); }

void register_gap_law(const GapLaw& law) { laws().push_back(&law); }

const GapLaw& find_gap_law(const std::string& name) {
    for (const GapLaw* law : laws()) {
        if (name == law->name) return *law;
    }
    throw InputError(
        fmt::format("there is no spacing law '{}'; the laws are: {}", name, fmt::join(gap_law_names(), ", ")));
}

std::vector<std::string> gap_law_names() {
    std::vector<std::string> names;
    for (const GapLaw* law : laws()) names.emplace_back(law->name);
    return names;
}

}  // namespace stopline
