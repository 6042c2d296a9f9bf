#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/io/csv.h"
#include "measure/signal_equations.h"
#include "signal_timing/signal_timing.h"

namespace stopline {

namespace {

std::string level_cell(const PopulationTiming& timing, double delay_s, double saturation) {
    return timing.is_oversaturated() ? "" : std::string(1, level_of_service(delay_s, saturation));
}

bool has_offset(const Scenario& scenario) {
    const GridSettings& grid = scenario.network.grid;
    return scenario.network.kind == "grid" && grid.columns * grid.rows > 1;
}

}  // namespace

std::string oversaturation_text(const PopulationTiming& timing) {
    std::string text = fmt::format(
        "{}: the demand is too high for any cycle.\n  The critical flow ratios sum to {:.2f}; Webster's cycle needs less "
        "than {}.\n",
        timing.saturation.population, timing.flow_ratio_sum, kMaxFlowRatioSum);
    for (const LaneTiming& lane : timing.lanes) {
        if (!lane.is_critical) continue;
        text += fmt::format("  {}: flow ratio {:.2f} on lane {}, {:.0f} of {:.0f} veh/h\n",
                            kTimingStreets[lane.demand.stage], lane.flow_ratio, lane.demand.lane,
                            lane.demand.flow_veh_h, lane.saturation_flow_veh_h);
    }
    return text;
}

std::vector<std::string> timing_overrides(const Scenario& scenario, const SignalTimes& times) {
    std::vector<std::string> overrides{fmt::format("signal.green={:g} s", times.green_s[0]),
                                       fmt::format("signal.cross_green={:g} s", times.green_s[1])};
    if (has_offset(scenario)) overrides.push_back(fmt::format("signal.offset={:g} s", times.offset_s));
    return overrides;
}

std::string timing_yaml(const Scenario& scenario, const SignalTimes& times) {
    std::string yaml = "signal:\n";
    const auto add = [&](const char* field, double time_s) { yaml += fmt::format("  {}: {:g} s\n", field, time_s); };
    add("first_green", scenario.signal.first_green_s);
    add("green", times.green_s[0]);
    add("cross_green", times.green_s[1]);
    add("yellow", scenario.signal.yellow_s);
    add("all_red", scenario.signal.all_red_s);
    if (has_offset(scenario)) add("offset", times.offset_s);
    return yaml;
}

std::string timing_csv(const Scenario& scenario, const std::vector<PopulationTiming>& timings) {
    CsvWriter csv({"population", "flow_ratio_sum", "lost_time_s", "webster_cycle_s", "cycle_s", "green_s",
                   "cross_green_s", "offset_s", "saturation_degree", "delay_s", "level_of_service"});
    for (const PopulationTiming& one : timings) {
        csv.row({one.saturation.population, fixed(one.flow_ratio_sum, 4),
                 fixed(one.lost_time_s[0] + one.lost_time_s[1], 3), fixed(one.webster_cycle_s, 2),
                 fixed(one.cycle_s, 2), fixed(one.times.green_s[0], 2), fixed(one.times.green_s[1], 2),
                 has_offset(scenario) ? fixed(one.times.offset_s, 2) : "",
                 one.is_oversaturated() ? "" : fixed(one.highest_saturation(), 4), fixed(one.delay_s, 2),
                 level_cell(one, one.delay_s, one.highest_saturation())});
    }
    return csv.text();
}

std::string timing_lanes_csv(const std::vector<PopulationTiming>& timings) {
    CsvWriter csv({"population",
                   "street",
                   "lane",
                   "busiest_lane",
                   "demand_veh_h",
                   "left_percent",
                   "right_percent",
                   "saturation_flow_veh_h",
                   "flow_ratio",
                   "critical",
                   "startup_lost_time_s",
                   "lost_time_s",
                   "green_s",
                   "effective_green_s",
                   "capacity_veh_h",
                   "capacity_variance_ratio",
                   "saturation_degree",
                   "uniform_delay_s",
                   "incremental_delay_s",
                   "delay_s",
                   "level_of_service"});
    for (const PopulationTiming& one : timings) {
        for (const LaneTiming& lane : one.lanes) {
            const std::size_t stage = at(lane.demand.stage);
            const double green_s = one.times.green_s[stage];
            csv.row({one.saturation.population,
                     kTimingStreets[stage],
                     fmt::format("{}", lane.demand.index),
                     lane.demand.lane,
                     fixed(lane.demand.flow_veh_h, 1),
                     fixed(100.0 * lane.demand.left_share, 2),
                     fixed(100.0 * lane.demand.right_share, 2),
                     fixed(lane.saturation_flow_veh_h, 1),
                     fixed(lane.flow_ratio, 4),
                     lane.is_critical ? "1" : "0",
                     fixed(one.saturation.lost[stage].startup_s, 3),
                     fixed(one.lost_time_s[stage], 3),
                     fixed(green_s, 2),
                     fixed(one.saturation.lost[stage].effective_green_s(green_s), 3),
                     fixed(lane.capacity_veh_h, 1),
                     fixed(lane.capacity_variance_ratio, 3),
                     fixed(lane.saturation, 4),
                     fixed(lane.uniform_delay_s, 2),
                     fixed(lane.incremental_delay_s, 2),
                     fixed(lane.delay_s(), 2),
                     level_cell(one, lane.delay_s(), lane.saturation)});
        }
    }
    return csv.text();
}

}  // namespace stopline
