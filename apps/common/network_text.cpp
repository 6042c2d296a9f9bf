#include "common/network_text.h"

#include <fmt/format.h>

#include "common/starvation_text.h"
#include "common/text_table.h"
#include "common/violation_text.h"
#include "measure/steady_state.h"
#include "runs/metrics/metric_tables.h"
#include "runs/network/network_metrics.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

std::string backlog_text(const NetworkReport& report) {
    std::string text;
    for (const NetworkResult& f : report.populations) {
        if (f.backlog == 0) continue;
        text += fmt::format("{}: a backlog of {} vehicles found no room to enter before the run ended.\n", f.population,
                            f.backlog);
    }
    return text;
}

// Returns warnings about biased travel times, and about runs too short to detect a drop of throughput.
std::string warnings_text(const NetworkReport& report) {
    constexpr int kMinCycles = static_cast<int>(kMinCollapseValues);
    std::string text;
    std::string too_short;
    for (const NetworkResult& f : report.populations) {
        if (is_travel_time_biased(f)) {
            text += fmt::format(
                "\n{}: the travel time covers only vehicles that left the area. {:.0f} vehicles are in it and {:.0f}\n"
                "leave per hour, so a vehicle stays {:.0f} s on average.",
                f.population, f.measured.vehicles, f.measured.throughput_veh_h(),
                f.measured.vehicles * 3600.0 / f.measured.throughput_veh_h());
        }
        const bool undecided = f.stability != Stability::unstable && f.full_cycles < kMinCycles;
        if (undecided) too_short += (too_short.empty() ? "" : ", ") + f.population;
    }
    if (!too_short.empty()) {
        text += fmt::format(
            "\nThe run is too short to detect a drop of throughput: fewer than {} signal cycles after the\n"
            "network filled ({}). Increase 'duration'.",
            kMinCycles, too_short);
    }
    return text;
}

// Names the causes of delay that the table of shares leaves out.
std::string other_causes_text(const Scenario& scenario) {
    if (scenario.rules.clearing == "cooperative") {
        return "The rest of the delay is due to signals, yielding, queue discharge and "
               "refusals by cooperative clearing\n"
               "(summary.csv).\n";
    }
    return "The rest of the delay is due to signals, yielding and queue discharge (summary.csv).\n";
}

// Returns one console table of the metrics and its notes.
struct TableWithNotes {
    std::string table;
    std::string notes;
};
TableWithNotes metrics_text(const NetworkReport& report, ConsoleTable table) {
    const MetricList<MeasuredNetwork>& metrics = network_metrics();
    return {table_text(console_rows(metrics, report.scenario, measured_runs(report), table)),
            paragraphs_text(console_notes(metrics, report.scenario, table))};
}

}  // namespace

std::string network_text(const NetworkReport& report) {
    const bool has_trips = network_kind(report.scenario.network).has_trips;
    const std::string area = has_trips ? "whole network"
                                       : fmt::format("up to {:g} m upstream and downstream of the outer stop lines",
                                                     report.scenario.measure.area_margin_m);
    const auto [results, result_notes] = metrics_text(report, ConsoleTable::results);
    const auto [congestion, congestion_notes] = metrics_text(report, ConsoleTable::congestion);
    const auto [trips, trip_notes] = metrics_text(report, ConsoleTable::trips);
    std::int64_t runs_with_violations = 0;
    std::string first_violations;
    for (const NetworkResult& f : report.populations) {
        runs_with_violations += f.violations.none() ? 0 : 1;
        first_violations += first_violation_text(f.population, f.violations, f.vehicle_names, report.lanes);
    }
    const std::string verdict =
        runs_with_violations == 0
            ? "No overlaps on lanes or in conflict areas (passed blockers excepted), no entries on red, "
              "no lost vehicles.\n"
            : fmt::format("VIOLATIONS in {} runs: summary.csv has the counts of each.\n{}", runs_with_violations,
                          first_violations);
    return results + fmt::format("\nMeasured area: {}.\n", area) + result_notes + window_text(report) +
           warnings_text(report) + "\n\nShare of the delay by cause | gridlocks and uses of the rules\n" + congestion +
           "\nBoth cover the whole run and the whole network. Delay is the time that vehicles are stopped.\n" +
           other_causes_text(report.scenario) + congestion_notes +
           (has_trips ? "\nTrips\n" + trips + trip_notes : backlog_text(report)) + "\n" + verdict +
           starvation_text(report.scenario, report.starvations(), report.lanes);
}

}  // namespace stopline
