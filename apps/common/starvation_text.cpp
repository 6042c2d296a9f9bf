#include "common/starvation_text.h"

#include <fmt/format.h>

#include "base/io/printable.h"

namespace stopline {

std::string starvation_text(const Scenario& scenario, const std::vector<PopulationStarvations>& populations,
                            const std::vector<std::string>& lanes) {
    constexpr std::size_t kListed = 3;  // largest number of movements listed for each population
    if (scenario.measure.starvation_s == 0.0) return "";
    std::string text;
    for (const PopulationStarvations& p : populations) {
        for (std::size_t k = 0; k < p.starvations.size(); ++k) {
            const Starvation& s = p.starvations[k];
            if (k == kListed) {
                text += fmt::format("  {}: {} more (starvations.csv)\n", p.population, p.starvations.size() - kListed);
                break;
            }
            text += fmt::format("  {}: vehicle {} on {} is stopped from {:.0f} to {:.0f} s ({})\n", p.population,
                                printable_text(p.vehicle_names.of(s.vehicle)),
                                printable_text(lanes.at(static_cast<std::size_t>(s.lane))), s.from_s, s.to_s,
                                kDelayCauseNames[static_cast<std::size_t>(s.cause)]);
        }
    }
    const std::string limit =
        fmt::format("{:g} s (measure.starvation) and two signal cycles", scenario.measure.starvation_s);
    if (text.empty()) return "No movement starves: no queue with a free way ahead is stopped for " + limit + ".\n";
    return "STARVATION: the first vehicle of a queue is stopped for " + limit + ", although nothing blocks its way.\n" +
           text;
}

}  // namespace stopline
