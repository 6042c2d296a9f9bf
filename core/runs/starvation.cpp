#include "runs/starvation.h"

#include "base/containers/index.h"
#include "base/io/csv.h"

namespace stopline {

std::string starvations_csv(const std::vector<PopulationStarvations>& populations,
                            const std::vector<std::string>& lanes) {
    CsvWriter csv({"population", "lane", "vehicle", "cause", "from_s", "to_s"});
    for (const PopulationStarvations& p : populations) {
        for (const Starvation& s : p.starvations) {
            csv.row({p.population, lanes.at(at(s.lane)), p.vehicle_names.of(s.vehicle),
                     kDelayCauseNames[static_cast<std::size_t>(s.cause)], fixed(s.from_s, 1), fixed(s.to_s, 1)});
        }
    }
    return csv.text();
}

}  // namespace stopline
