#include "figures/population_style.h"
#include "scenario/fleets.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace stopline {

namespace {

// The index of a name in this list is the index of its style.
constexpr std::array<std::string_view, 9> kFixedNames{"CDG",     "CDG-6m",  "SWITCH-1", "SWITCH-2",   "MIX",
                                                      "CTG-Ref", "CTG-HCM", "CTG-HBS",  "SWITCH-1-6m"};

template <class Names>
std::size_t position_of(const Names& names, std::string_view name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace

std::size_t style_index(const std::vector<std::string>& names, const std::string& name) {
    const std::size_t fixed = position_of(kFixedNames, name);
    if (fixed < kFixedNames.size()) return fixed;
    const auto is_free = [&](std::size_t index) {
        return index >= kFixedNames.size() || position_of(names, kFixedNames[index]) == names.size();
    };
    std::size_t index = 0;
    for (const std::string& other : names) {
        if (position_of(kFixedNames, other) < kFixedNames.size()) continue;
        while (!is_free(index)) ++index;
        if (other == name) break;
        ++index;
    }
    return index;
}

std::vector<std::string> styled_names(const Scenario& scenario) {
    std::vector<std::string> names;
    const auto add = [&](const std::string& new_name) {
        if (std::find(names.begin(), names.end(), new_name) == names.end()) names.push_back(new_name);
    };
    for (const PopulationSettings& population : scenario.populations) add(population.name);
    for (const PopulationSettings& population : scenario.populations) {
        for (const auto& component : population.components) add(component_name(component));
    }
    return names;
}

LineStyle style_of(const Scenario& scenario, const std::string& name) {
    return line_style(style_index(styled_names(scenario), name));
}

}  // namespace stopline
