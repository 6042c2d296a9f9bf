#include "figures/population_style.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace stopline {

LineStyle style_of(const Scenario& scenario, const std::string& name) {
    std::vector<std::string> names;
    const auto add = [&](const std::string& new_name) {
        if (std::find(names.begin(), names.end(), new_name) == names.end()) names.push_back(new_name);
    };
    for (const PopulationSettings& population : scenario.populations) add(population.name);
    for (const PopulationSettings& population : scenario.populations) {
        for (const auto& component : population.components) add(component.policy);
    }
    return line_style(static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin()));
}

}  // namespace stopline
