#include "common/single_light_text.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "common/text_table.h"

namespace stopline {

namespace {

std::string number(double value, int decimals) {
    return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string signed_number(double value, int decimals) {
    return std::isnan(value) ? "-" : fmt::format("{:+.{}f}", value, decimals);
}

// Whether a queue is used up before a green time ends: then the count says what was there, not what could pass.
bool used_up(const PopulationSummary& summary, double green_s) { return summary.emptied_s < green_s; }

void append_improvements(const SingleLight& result, const PopulationSummary& summary, std::vector<std::string>& cells) {
    const PopulationSummary& baseline = result.populations[*result.baseline];
    cells.emplace_back("|");
    for (std::size_t k = 0; k < summary.improvement_percent.size(); ++k) {
        const double green_s = result.scenario.measure.green_s[k];
        const bool starred = used_up(summary, green_s) || used_up(baseline, green_s);
        cells.push_back(signed_number(summary.improvement_percent[k], 0) + (starred ? "*" : ""));
    }
}

}  // namespace

std::string counts_text(const SingleLight& result) {
    const std::vector<double>& green_s = result.scenario.measure.green_s;
    if (green_s.empty()) return "";
    TextTable table;
    std::vector<std::string> head{"population"};
    for (const double green : green_s) head.push_back(fmt::format("{:.4g} s", green));
    if (result.baseline) {
        head.emplace_back("|");
        for (const double green : green_s) head.push_back(fmt::format("{:.4g} s", green));
    }
    table.row(head);
    bool starred = false;
    for (const PopulationSummary& summary : result.populations) {
        std::vector<std::string> cells{summary.name};
        for (std::size_t k = 0; k < green_s.size(); ++k) {
            const bool star = used_up(summary, green_s[k]);
            cells.push_back(std::to_string(summary.passed[k]) + (star ? "*" : ""));
            starred = starred || star;
        }
        if (result.baseline) append_improvements(result, summary, cells);
        table.row(cells);
    }
    std::string text = "Vehicles passed within the green time";
    if (result.baseline) text += fmt::format(" | improvement over {} [%]", result.populations[*result.baseline].name);
    text += "\n" + table.text();
    if (starred) text += "  *: a queue is used up before; with a longer one (demand.vehicles) more would pass\n";
    return text + "\n";
}

std::string ideal_text(const SingleLight& result) {
    constexpr double kSaturated_s = 20.0;  // from here on Fig. 6 is level (Section III.E)
    const std::vector<double>& green_s = result.scenario.measure.green_s;
    if (green_s.empty()) return "";
    const bool compares = result.baseline && kSaturated_s < result.scenario.signal.green_s;
    TextTable table;
    std::vector<std::string> head{"population"};
    for (const double green : green_s) head.push_back(fmt::format("{:.4g} s", green));
    if (compares) head.insert(head.end(), {"|", "simulated", "ideal"});
    table.row(head);
    for (const PopulationSummary& summary : result.populations) {
        std::vector<std::string> cells{summary.name};
        for (const double green : green_s) cells.push_back(std::to_string(summary.ideal.passed(green)));
        if (compares) {
            cells.emplace_back("|");
            cells.push_back(signed_number(result.mean_improvement_percent(summary, kSaturated_s), 1));
            cells.push_back(signed_number(result.ideal_improvement_percent(summary, kSaturated_s), 1));
        }
        table.row(cells);
    }
    std::string text = "Ideal platoons behind the same leaders, whose gaps are those of the policy at every moment";
    if (compares) text += fmt::format(" | mean improvement from {:.4g} s on [%]", kSaturated_s);
    return text + "\n" + table.text() + "\n";
}

std::string headways_text(const SingleLight& result) {
    TextTable table;
    std::vector<std::string> head{"population", "vehicles", "gap [m]", "policy",  "headway [s]",
                                  "policy",     "off [%]",  "|",       "headway", "at [km/h]"};
    if (result.baseline) head.insert(head.begin() + 7, "gain [%]");
    table.row(head);
    for (const PopulationSummary& summary : result.populations) {
        const SettledFlow& settled = summary.settled;
        std::vector<std::string> cells{summary.name,
                                       std::to_string(settled.vehicles),
                                       number(settled.net_gap_m, 2),
                                       number(settled.policy_gap_m, 2),
                                       number(settled.headway_s, 3),
                                       number(settled.policy_headway_s, 3),
                                       signed_number(settled.deviation_percent, 2),
                                       "|",
                                       number(summary.late.headway_s, 3),
                                       number(summary.late.speed_mps * kKmhPerMps, 1)};
        if (result.baseline) {
            cells.insert(cells.begin() + 7, signed_number(summary.asymptotic_improvement_percent, 0));
        }
        table.row(cells);
    }
    return fmt::format(
               "Settled behind each other at the limit of {:.4g} km/h, beside the policy's own | last {} vehicles at the "
               "line\n",
               result.scenario.network.approach.speed_limit_mps * kKmhPerMps, kLatePositions) +
           table.text();
}

std::string queue_text(const SingleLight& result) {
    constexpr double kClosedUp_m = 1.0;  // more than the smallest gap
    std::string names;
    for (const PopulationSummary& summary : result.populations) {
        if (!(summary.queue.largest_m > summary.queue.smallest_m + kClosedUp_m)) continue;
        names += fmt::format("{}{} ({:.1f} m)", names.empty() ? "" : ", ", summary.name, summary.queue.largest_m);
    }
    if (names.empty()) return "";
    return "At the start of green the end of the queue has not closed up (largest net gap) in:\n  " + names +
           "\n  It matters where those vehicles pass within the green; signal.first_green gives them more time.\n\n";
}

std::string violations_text(const SingleLight& result) {
    if (result.no_violations()) return "No overlaps, no entries on red, no vehicle lost.\n";
    TextTable table;
    table.row({"population", "overlaps", "entries on red", "lost vehicles"});
    for (const RunResult& run : result.runs) {
        table.row({run.population, std::to_string(run.violations.overlaps), std::to_string(run.violations.red_entries),
                   std::to_string(run.violations.lost_vehicles)});
    }
    return "VIOLATIONS of what must never happen\n" + table.text();
}

}  // namespace stopline
