#include "common/single_light_text.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "common/text_table.h"
#include "runs/metrics/metric_tables.h"
#include "runs/single_light/single_light_metrics.h"

namespace stopline {

namespace {

// Returns a table cell like number_cell(), but with a sign before positive numbers too.
std::string signed_number_cell(double value, int decimals) {
    return std::isnan(value) ? "-" : fmt::format("{:+.{}f}", value, decimals);
}

// Returns a text that names the populations in which some vehicles keep far larger gaps than their policies demand.
// Returns "" if there are no such vehicles.
std::string open_gaps_text(const SingleLightReport& result) {
    std::string names;
    for (const PopulationSummary& summary : result.populations) {
        if (summary.steady.not_closed_up == 0) continue;
        names += fmt::format("{}{} ({} at {:.1f} m)", names.empty() ? "" : ", ", summary.name,
                             summary.steady.not_closed_up, summary.steady.open_gap_m);
    }
    if (names.empty()) return "";
    return "Vehicles that have not closed up beyond the stop line (mean net gap); they are not in steady state:\n  " +
           names + "\n";
}

}  // namespace

std::string counts_text(const SingleLightReport& result) {
    const std::vector<double>& green_s = result.scenario.measure.green_s;
    if (green_s.empty()) return "";
    const std::vector<MeasuredGreen> runs = measured_greens(result);
    std::string title;
    std::string notes;
    std::vector<std::string> head{"population"};
    std::vector<std::vector<std::string>> rows;
    for (const PopulationSummary& summary : result.populations) rows.push_back({summary.name});
    for (const auto& column : console_columns(green_metrics(), result.scenario, ConsoleTable::results)) {
        const std::string heading = column.console_heading();
        if (heading.find(kTheBaseline) != std::string::npos && !result.baseline) continue;
        if (!title.empty()) {
            title += " | ";
            head.emplace_back("|");
            for (std::vector<std::string>& row : rows) row.emplace_back("|");
        }
        title += result.baseline ? with_key(heading, kTheBaseline, result.populations[*result.baseline].name) : heading;
        for (const double green : green_s) head.push_back(fmt::format("{:.4g} s", green));
        bool has_mark = false;
        for (std::size_t k = 0; k < runs.size(); ++k) {
            rows[k / green_s.size()].push_back(column.console_cell(runs[k]));
            has_mark = has_mark || rows[k / green_s.size()].back().ends_with('*');
        }
        if (has_mark && !column.console_note().empty()) notes += "  " + column.console_note() + "\n";
    }
    TextTable table;
    table.add_row(head);
    for (const std::vector<std::string>& row : rows) table.add_row(row);
    return title + "\n" + table.text() + notes + "\n";
}

std::string ideal_text(const SingleLightReport& result) {
    constexpr double kSaturated_s = 20.0;  // for longer green times, the curves of Fig. 6 are level (Section III.E)
    const std::vector<double>& green_s = result.scenario.measure.green_s;
    if (green_s.empty()) return "";
    const bool compares = result.baseline && kSaturated_s < result.scenario.signal.green_s;
    TextTable table;
    std::vector<std::string> head{"population"};
    for (const double green : green_s) head.push_back(fmt::format("{:.4g} s", green));
    if (compares) head.insert(head.end(), {"|", "simulated", "ideal"});
    table.add_row(head);
    for (const PopulationSummary& summary : result.populations) {
        std::vector<std::string> cells{summary.name};
        for (const double green : green_s) cells.push_back(std::to_string(summary.ideal.passed(green)));
        if (compares) {
            cells.emplace_back("|");
            cells.push_back(signed_number_cell(result.mean_improvement_percent(summary, kSaturated_s), 1));
            cells.push_back(signed_number_cell(result.ideal_improvement_percent(summary, kSaturated_s), 1));
        }
        table.add_row(cells);
    }
    std::string text =
        "Vehicles passed in ideal platoons: same platoon leaders, followers keep the gap of their policy exactly";
    if (!compares) return text + "\n" + table.text() + "\n";
    const std::string notes = fmt::format(
        "  mean improvement: over all green times from {0:.4g} s to {1:.4g} s, at most until one of the two queues\n"
        "  has emptied; counts with a * in the first table do not enter. '-': a queue empties before {0:.4g} s\n",
        kSaturated_s, result.scenario.signal.green_s);
    return text + fmt::format(" | mean improvement for green times from {:.4g} s [%]\n", kSaturated_s) + table.text() +
           notes + "\n";
}

std::string headways_text(const SingleLightReport& result) {
    const std::string table = table_text(console_rows(single_light_metrics(), result.scenario, measured_runs(result)));
    const double limit_mps = result.scenario.network.approach.speed_limit_mps;
    const double cruise_mps = cruise_speed_mps(result.scenario);
    return fmt::format(
               "Steady state at {} {:.4g} km/h, measured and by the policy | "
               "last {} vehicles per lane at the stop line\n",
               cruise_mps == limit_mps ? "the speed limit of" : "the speed of vehicles without leader,",
               cruise_mps * kKmhPerMps, kLastPositions) +
           table + open_gaps_text(result);
}

std::string queue_text(const SingleLightReport& result) {
    std::string names;
    for (const PopulationSummary& summary : result.populations) {
        if (std::isnan(summary.queue.largest_open_m)) continue;
        names += fmt::format("{}{} ({:.1f} m)", names.empty() ? "" : ", ", summary.name, summary.queue.largest_open_m);
    }
    if (names.empty()) return "";
    return "The end of the queue has not closed up when the green starts (largest net gap):\n  " + names +
           "\n  This matters only if vehicles behind the open gap pass within the green. "
           "Then set a later signal.first_green.\n\n";
}

std::string violations_text(const SingleLightReport& result) {
    if (result.no_violations()) return "No overlaps, no entries on red, no lost vehicles.\n";
    TextTable table;
    table.add_row({"population", "overlaps", "entries on red", "lost vehicles"});
    for (const RunResult& run : result.runs) {
        table.add_row({run.population, std::to_string(run.violations.overlaps),
                       std::to_string(run.violations.red_entries), std::to_string(run.violations.lost_vehicles)});
    }
    return "VIOLATIONS: each of these counts must be 0\n" + table.text();
}

}  // namespace stopline
