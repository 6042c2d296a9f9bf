#include "common/intersection_text.h"

#include <fmt/format.h>

#include "common/starvation_text.h"
#include "common/text_table.h"
#include "common/violation_text.h"
#include "runs/intersection/intersection_metrics.h"
#include "runs/metrics/metric_tables.h"

namespace stopline {

std::string intersection_text(const IntersectionReport& report) {
    const Scenario& scenario = report.scenario;
    const std::vector<MeasuredIntersection> runs = measured_runs(report);
    std::int64_t runs_with_violations = 0;
    std::string first_violations;
    std::string unsaturated;  // populations without a saturated green
    for (const IntersectionResult& f : report.populations) {
        if (f.discharge.saturated_greens == 0) unsaturated += (unsaturated.empty() ? "" : ", ") + f.population;
        runs_with_violations += f.violations.none() ? 0 : 1;
        first_violations += first_violation_text(f.population, f.violations, f.vehicle_names, report.lanes);
        if (f.deadlock)
            first_violations +=
                fmt::format("Deadlock of {}: {}", f.population, deadlock_text(*f.deadlock, report.lanes));
    }
    const TimeWindow window = measured_window(scenario);
    const std::string notes = paragraphs_text(console_notes(intersection_metrics(), scenario)) +
                              fmt::format("Measured from {:.0f} to {:.0f} s ({} cycles).\n", window.from_s, window.to_s,
                                          report.populations.empty() ? 0 : report.populations[0].discharge.greens);
    if (!unsaturated.empty())
        unsaturated = "No saturated cycles: in no green did five vehicles of a queue pass (" + unsaturated + ").\n";
    const std::string verdict =
        runs_with_violations == 0
            ? "No overlaps on lanes or in conflict areas, no entries on red, no deadlocks, no lost vehicles.\n"
            : fmt::format("VIOLATIONS in {} runs: summary.csv has the counts of each.\n{}", runs_with_violations,
                          first_violations);
    return table_text(console_rows(intersection_metrics(), scenario, runs)) + "\n" + notes + unsaturated + "\n" +
           verdict + starvation_text(scenario, report.starvations(), report.lanes);
}

}  // namespace stopline
