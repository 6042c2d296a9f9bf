#include "common/intersection_text.h"

#include <fmt/format.h>
#include <cmath>

#include "common/text_table.h"

namespace stopline {

std::string intersection_text(const IntersectionReport& report) {
    const Scenario& scenario = report.scenario;
    TextTable table;
    std::vector<std::string> head{"", "veh/h", "gain %"};
    for (const double radius_m : scenario.measure.zone_radius_m) head.push_back(fmt::format("s in {:g} m", radius_m));
    for (const char* const column : {"density %", "present", "veh/green", "saturation veh/h", "lost s", "queue veh"}) {
        head.emplace_back(column);
    }
    table.row(head);
    std::int64_t violations = 0;
    for (const IntersectionFigures& f : report.populations) {
        const double gain = report.improvement_percent(f);
        std::vector<std::string> row{f.population, fmt::format("{:.0f}", f.throughput_veh_h),
                                     gain == gain ? fmt::format("{:.0f}", gain) : "-"};
        for (const ZoneFigures& zone : f.zones) row.push_back(fmt::format("{:.1f}", zone.travel_time_s));
        const bool known = !std::isnan(f.discharge.lost_time_s);  // greens of more than four vehicles
        for (const std::string& cell :
             {fmt::format("{:.1f}", 100.0 * f.occupied), fmt::format("{:.0f}", f.vehicles_present),
              fmt::format("{:.2f}", f.discharge.vehicles_per_green),
              known ? fmt::format("{:.0f}", f.discharge.saturation_flow_veh_h) : "-",
              known ? fmt::format("{:.1f}", f.discharge.lost_time_s) : "-", fmt::format("{:.1f}", f.queue_veh)}) {
            row.push_back(cell);
        }
        table.row(row);
        violations += f.violations.none() ? 0 : 1;
    }
    const TimeWindow window = measured_window(scenario);
    const std::string notes = fmt::format(
        "veh/h: fronts that leave the intersection; s in R m: mean time from R before to R behind its centre; density: share\n"
        "of all road metres; veh/green: a lane and green, those on yellow included; saturation: from the fifth vehicle on;\n"
        "queue: standing when green begins, mean of the lanes. Measured from {:.0f} to {:.0f} s, {} cycles.\n",
        window.from_s, window.to_s, report.populations.empty() ? 0 : report.populations[0].discharge.greens);
    const std::string verdict =
        violations == 0
            ? "No overlaps on lanes or in conflict areas, no entries on red, no deadlock, no vehicle lost.\n"
            : fmt::format("VIOLATIONS in {} runs: see summary.csv.\n", violations);
    return table.text() + "\n" + notes + "\n" + verdict;
}

}  // namespace stopline
