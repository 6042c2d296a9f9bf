#include "run/hcm_text.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/text_table.h"

namespace stopline {

namespace {

constexpr std::size_t kMaxRows = 40;  // of a population; with more, the lanes are left out

// Returns a measured value and the one of the formula.
std::string hcm_pair(double measured, double formula, int decimals) {
    return number_cell(measured, decimals) + " / " + number_cell(formula, decimals);
}

std::vector<std::string> hcm_line(const HcmRow& row) {
    const std::string level = hcm_level_text(row.level);
    const bool is_lane = row.scope == HcmRow::Scope::lane;
    return {is_lane ? row.name : fmt::format("{} {}", hcm_scope_name(row.scope), row.name),
            is_lane ? number_cell(row.saturation_flow_veh_h, 0) : "",
            is_lane ? number_cell(row.startup_lost_time_s, 1) : "",
            is_lane ? number_cell(row.effective_green_s, 1) : "",
            number_cell(row.capacity_veh_h, 0),
            number_cell(row.saturation, 2),
            hcm_pair(row.control_delay_s, row.formula_delay_s(), 1),
            number_cell(row.stops, 2),
            is_lane ? hcm_pair(row.back_95_veh, row.formula_back_95_veh, 0) : "",
            level.empty() ? "-" : level};
}

std::string population_text(const PopulationHcm& one) {
    if (one.rows.empty()) {
        return fmt::format("HCM, {}: no signal has a whole cycle in the measured window.\n\n", one.population);
    }
    const bool with_lanes = one.rows.size() <= kMaxRows;
    TextTable table("lr");
    table.add_row({"HCM, " + one.population, "sat. flow", "lost", "eff. green", "capacity", "X", "delay", "stops",
                   "queue 95 %", "LOS"});
    table.add_row({"", "veh/h", "s", "s", "veh/h", "", "s", "", "veh", ""});
    int saturated = 0;
    int oversaturated = 0;
    for (const HcmRow& row : one.rows) {
        if (row.scope == HcmRow::Scope::lane) {
            saturated += row.state == HcmState::saturated ? 1 : 0;
            oversaturated += row.state == HcmState::oversaturated ? 1 : 0;
            if (!with_lanes) continue;
        }
        table.add_row(hcm_line(row));
    }
    std::string text = table.text("");
    if (!with_lanes) text += "hcm.csv lists the lanes, too.\n";
    if (oversaturated > 0) {
        text += fmt::format(
            "OVERSATURATED: demand exceeds the capacity of {} lanes. Their queues grow up to the length of the lane.\n"
            "Their delays depend on the length of the run.\n",
            oversaturated);
    }
    if (saturated > 0) {
        text += fmt::format("SATURATED: {} lanes do not clear their queue in half of the cycles or more.\n", saturated);
    }
    return text + "\n";
}

}  // namespace

std::string hcm_text(const std::vector<PopulationHcm>& populations) {
    std::string text;
    for (const PopulationHcm& one : populations) text += population_text(one);
    return text + paragraphs_text(
                      {"Pairs are measured / HCM formula. X: degree of saturation. queue 95 %: back of queue that 95 % "
                       "of the cycles do not exceed. LOS: level of service of the measured delay."});
}

}  // namespace stopline
