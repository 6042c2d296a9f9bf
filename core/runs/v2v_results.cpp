#include "runs/v2v_results.h"

#include <algorithm>
#include <numeric>

#include "base/containers/index.h"
#include "base/io/csv.h"
#include "base/nan.h"
#include "v2v/fallback.h"

namespace stopline {

static_assert(kV2vModeNames.size() == kV2vModes);

bool V2vResult::exists() const {
    return std::any_of(steps.begin(), steps.end(), [](std::int64_t count) { return count > 0; });
}

double V2vResult::share_percent(std::size_t mode) const {
    if (mode == static_cast<std::size_t>(V2vMode::platoon_leader) && !has_platoon_leaders) return kNan;
    const std::int64_t all = std::accumulate(steps.begin(), steps.end(), std::int64_t{0});
    return all == 0 ? kNan : 100.0 * static_cast<double>(steps[mode]) / static_cast<double>(all);
}

V2vResult v2v_result(const RunRecords& records, const V2vPlan& plan) {
    return {records.v2v_mode_changes, records.v2v_mode_steps, plan.uses_platoon_leader};
}

std::string v2v_modes_csv(const std::vector<PopulationV2v>& populations) {
    if (std::none_of(populations.begin(), populations.end(), [](const PopulationV2v& p) { return p.v2v.exists(); }))
        return {};
    CsvWriter csv(
        {"population", "time_s", "vehicle", "leader", "from", "to", "message_age_s", "net_gap_m", "speed_mps"});
    for (const PopulationV2v& p : populations) {
        for (const V2vModeChange& change : p.v2v.changes) {
            csv.row({p.population, fixed(change.time_s, 2), p.vehicle_names.of(change.vehicle),
                     p.vehicle_names.of(change.leader), kV2vModeNames[at(change.from_mode)],
                     kV2vModeNames[at(change.to_mode)],
                     change.age_s < 0.0F ? "" : fixed(static_cast<double>(change.age_s), 2),
                     fixed(static_cast<double>(change.gap_m), 2), fixed(static_cast<double>(change.speed_mps), 2)});
        }
    }
    return csv.text();
}

}  // namespace stopline
