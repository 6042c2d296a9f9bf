#include "runs/hcm/hcm_tables.h"

#include <array>
#include <cmath>

#include "base/io/csv.h"
#include "base/nan.h"

namespace stopline {

namespace {

const HcmRow* worst(const std::vector<HcmRow>& rows, HcmRow::Scope scope) {
    const HcmRow* found = nullptr;
    for (const HcmRow& row : rows) {
        if (row.scope != scope || std::isnan(row.control_delay_s)) continue;
        if (found == nullptr || row.control_delay_s > found->control_delay_s) found = &row;
    }
    return found;
}

std::vector<std::string> hcm_cells(const std::string& population, const HcmRow& row) {
    const bool is_lane = row.scope == HcmRow::Scope::lane;
    return {population,
            hcm_scope_name(row.scope),
            row.name,
            std::to_string(row.cycles),
            fixed(row.cycle_s, 2),
            fixed(row.green_s, 2),
            is_lane ? std::to_string(row.discharge.saturated_greens) : "",
            fixed(row.saturation_flow_veh_h, 1),
            fixed(row.startup_lost_time_s, 3),
            fixed(row.end_gain_s, 3),
            fixed(row.effective_green_s, 3),
            fixed(row.capacity_veh_h, 1),
            fixed(row.volume_veh_h, 1),
            fixed(row.passed_veh_h, 1),
            fixed(row.saturation, 4),
            fixed(row.control_delay_s, 2),
            fixed(row.formula_delay_s(), 2),
            fixed(row.uniform_delay_s, 2),
            fixed(row.incremental_delay_s, 2),
            fixed(row.initial_queue_delay_s, 2),
            fixed(row.stops, 3),
            fixed(row.back_50_veh, 1),
            fixed(row.back_95_veh, 1),
            fixed(row.formula_back_50_veh, 1),
            fixed(row.formula_back_95_veh, 1),
            fixed(row.back_50_m, 1),
            fixed(row.back_95_m, 1),
            fixed(100.0 * row.residual_share, 1),
            hcm_state_name(row.state),
            hcm_level_text(row.level),
            hcm_level_text(row.formula_level)};
}

}  // namespace

const char* hcm_scope_name(HcmRow::Scope scope) {
    constexpr std::array<const char*, 3> kNames{"lane", "approach", "intersection"};
    return kNames[static_cast<std::size_t>(scope)];
}

std::string hcm_level_text(char level) { return level == '-' ? std::string() : std::string(1, level); }

std::string hcm_csv(const std::vector<PopulationHcm>& populations) {
    CsvWriter csv({"population",
                   "scope",
                   "name",
                   "cycles",
                   "cycle_s",
                   "green_s",
                   "saturated_greens",
                   "saturation_flow_veh_h",
                   "startup_lost_time_s",
                   "end_gain_s",
                   "effective_green_s",
                   "capacity_veh_h",
                   "volume_veh_h",
                   "passed_veh_h",
                   "degree_of_saturation",
                   "control_delay_s",
                   "formula_delay_s",
                   "uniform_delay_s",
                   "incremental_delay_s",
                   "initial_queue_delay_s",
                   "stops_per_vehicle",
                   "queue_50_veh",
                   "queue_95_veh",
                   "formula_queue_50_veh",
                   "formula_queue_95_veh",
                   "queue_50_m",
                   "queue_95_m",
                   "residual_queue_percent",
                   "state",
                   "level_of_service",
                   "formula_level_of_service"});
    for (const PopulationHcm& one : populations) {
        for (const HcmRow& row : one.rows) csv.row(hcm_cells(one.population, row));
    }
    return csv.text();
}

std::string hcm_headways_csv(const std::vector<PopulationHcm>& populations) {
    CsvWriter csv({"population", "lane", "position", "headway_s", "samples"});
    for (const PopulationHcm& one : populations) {
        for (const HcmRow& row : one.rows) {
            for (std::size_t k = 0; k < row.discharge.headway_s.size(); ++k) {
                csv.row({one.population, row.name, std::to_string(k + 1), fixed(row.discharge.headway_s[k], 4),
                         std::to_string(row.discharge.samples[k])});
            }
        }
    }
    return csv.text();
}

const HcmRow* worst_intersection(const std::vector<HcmRow>& rows) { return worst(rows, HcmRow::Scope::intersection); }
const HcmRow* worst_approach(const std::vector<HcmRow>& rows) { return worst(rows, HcmRow::Scope::approach); }

double highest_saturation(const std::vector<HcmRow>& rows) {
    double highest = kNan;
    for (const HcmRow& row : rows) {
        if (row.scope == HcmRow::Scope::lane) highest = std::fmax(highest, row.saturation);  // ignores NaN
    }
    return highest;
}

}  // namespace stopline
