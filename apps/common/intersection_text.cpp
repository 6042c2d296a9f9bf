#include "common/intersection_text.h"

#include <fmt/format.h>

#include "common/starvation_text.h"
#include "common/text_table.h"

namespace stopline {

std::string intersection_text(const IntersectionReport& report) {
    const Scenario& scenario = report.scenario;
    TextTable table;
    std::vector<std::string> head{"", "throughput", "gain"};
    std::vector<std::string> units{"population", "veh/h", "%"};
    for (const double radius_m : scenario.measure.zone_radius_m) {
        head.push_back(fmt::format("time in {:g} m", radius_m));
        units.emplace_back("s");
    }
    head.insert(head.end(), {"density", "vehicles", "per green", "saturation", "lost time", "queue"});
    units.insert(units.end(), {"%", "veh", "veh", "veh/h", "s", "veh"});
    table.add_row(head);
    table.add_row(units);
    std::int64_t runs_with_violations = 0;
    std::string unsaturated;  // populations without a saturated green
    for (const IntersectionResult& f : report.populations) {
        const double gain = report.improvement_percent(f);
        std::vector<std::string> row{f.population, fmt::format("{:.0f}", f.throughput_veh_h),
                                     gain == gain ? fmt::format("{:.0f}", gain) : "-"};
        for (const ZoneResult& zone : f.zones) row.push_back(fmt::format("{:.1f}", zone.travel_time_s));
        const bool has_saturation = f.discharge.saturated_greens > 0;
        if (!has_saturation) unsaturated += (unsaturated.empty() ? "" : ", ") + f.population;
        for (const std::string& cell :
             {fmt::format("{:.1f}", 100.0 * f.occupied), fmt::format("{:.0f}", f.vehicles_present),
              fmt::format("{:.2f}", f.discharge.vehicles_per_green),
              has_saturation ? fmt::format("{:.0f}", f.discharge.saturation_flow_veh_h) : "-",
              has_saturation ? fmt::format("{:.1f}", f.discharge.startup_lost_time_s) : "-",
              fmt::format("{:.1f}", f.queue_veh)}) {
            row.push_back(cell);
        }
        table.add_row(row);
        runs_with_violations += f.violations.none() ? 0 : 1;
    }
    const TimeWindow window = measured_window(scenario);
    const std::string notes = fmt::format(
        "throughput: vehicles that leave the intersection; time in R m: mean travel time from R before its\n"
        "centre to R behind it; density: share of the lane length that vehicles occupy; vehicles: mean number\n"
        "on all lanes; per green: vehicles that pass a stop line per lane in one green and its yellow;\n"
        "saturation: flow from the fifth vehicle of a queue on; lost time: start-up lost time of the first four\n"
        "(vehicles that stood in the queue only);\n"
        "queue: stopped vehicles per lane when its green starts.\n"
        "Measured from {:.0f} to {:.0f} s ({} cycles).\n",
        window.from_s, window.to_s, report.populations.empty() ? 0 : report.populations[0].discharge.greens);
    if (!unsaturated.empty())
        unsaturated = "No saturated cycles: in no green did five vehicles of a queue pass (" + unsaturated + ").\n";
    const std::string verdict =
        runs_with_violations == 0
            ? "No overlaps on lanes or in conflict areas, no entries on red, no deadlocks, no lost vehicles.\n"
            : fmt::format("VIOLATIONS in {} runs: summary.csv has the counts of each.\n", runs_with_violations);
    return table.text() + "\n" + notes + unsaturated + "\n" + verdict +
           starvation_text(scenario, report.starvations(), report.lanes);
}

}  // namespace stopline
