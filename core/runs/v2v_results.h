// How often vehicles drive without recent V2V messages (v2v/fallback.h).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/state/queries/vehicle_names.h"
#include "sim/state/run_records.h"
#include "v2v/plan.h"

namespace stopline {

struct V2vResult {
    std::vector<V2vModeChange> changes;
    std::array<std::int64_t, kV2vModes> steps{};  // [mode] vehicles behind a leader, summed over all steps
    bool has_platoon_leaders = false;             // vehicles use the messages of their platoon leaders

    // Returns true if the run has an active V2V channel and vehicles that use it.
    bool exists() const;
    // Returns the share of the time that vehicles behind a leader drive in a mode; NaN if there are no such vehicles,
    // or if the topology does not have the mode.
    double share_percent(std::size_t mode) const;
};

V2vResult v2v_result(const RunRecords& records, const V2vPlan& plan);

struct PopulationV2v {
    std::string population;
    V2vResult v2v;
    VehicleNames vehicle_names = {};
};

// Returns v2v_modes.csv as CSV text, or an empty text if no run has an active channel.
std::string v2v_modes_csv(const std::vector<PopulationV2v>& populations);

// Returns the parts of a report that v2v_modes_csv() needs. `Result` has the members `population`, `v2v` and
// `vehicle_names`.
template <class Result>
std::vector<PopulationV2v> v2v_of(const std::vector<Result>& results) {
    std::vector<PopulationV2v> all;
    for (const Result& result : results) all.push_back({result.population, result.v2v, result.vehicle_names});
    return all;
}

}  // namespace stopline
