// The tables of the report by the Highway Capacity Manual (measure/hcm.h).
#pragma once

#include <string>
#include <vector>

#include "measure/hcm.h"

namespace stopline {

struct PopulationHcm {
    std::string population;
    std::vector<HcmRow> rows;
};

std::string hcm_csv(const std::vector<PopulationHcm>& populations);
std::string hcm_headways_csv(const std::vector<PopulationHcm>& populations);

// Returns the parts of a report that the tables need. `Result` has the members `population` and `hcm`.
template <class Result>
std::vector<PopulationHcm> hcm_of(const std::vector<Result>& results) {
    std::vector<PopulationHcm> all;
    for (const Result& result : results) all.push_back({result.population, result.hcm});
    return all;
}

const char* hcm_scope_name(HcmRow::Scope scope);
// Returns the level as text; empty if there is none.
std::string hcm_level_text(char level);

// Returns the intersection with the longest control delay; null if there are no rows.
const HcmRow* worst_intersection(const std::vector<HcmRow>& rows);
// Returns the approach with the longest control delay; null if there are no rows.
const HcmRow* worst_approach(const std::vector<HcmRow>& rows);
// Returns the highest degree of saturation of the lanes; NaN if no lane has one.
double highest_saturation(const std::vector<HcmRow>& rows);

}  // namespace stopline
