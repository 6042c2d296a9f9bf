#include "common/network_text.h"

#include <fmt/format.h>

#include "common/starvation_text.h"
#include "common/text_table.h"
#include "measure/steady_state.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

// Returns the share of one cause in the delay of all causes, in percent.
std::string share_text(const DelayLog& log, DelayCause cause) {
    double total_s = 0.0;
    for (std::size_t k = 1; k < kDelayCauseNames.size(); ++k) total_s += log.delay_s[k];  // cause 0 is DelayCause::none
    const double delay_s = log.delay_s[static_cast<std::size_t>(cause)];
    return number_cell(total_s > 0.0 ? 100.0 * delay_s / total_s : 0.0, 1);
}

std::string trips_text(const NetworkReport& report) {
    TextTable table;
    table.add_row({"trips", "entered", "arrived", "en route", "backlog", "missed turns"});
    for (const NetworkResult& f : report.populations) {
        table.add_row({f.population, std::to_string(f.entered), std::to_string(f.exited),
                       std::to_string(f.entered - f.exited), std::to_string(f.backlog),
                       std::to_string(f.missed_turns)});
    }
    return "\n" + table.text() +
           "backlog: vehicles that found no room to enter before the run ended.\n"
           "missed turns: vehicles that reached the stop line in a wrong lane and were teleported.\n";
}

std::string backlog_text(const NetworkReport& report) {
    std::string text;
    for (const NetworkResult& f : report.populations) {
        if (f.backlog == 0) continue;
        text += fmt::format("{}: a backlog of {} vehicles found no room to enter before the run ended.\n", f.population,
                            f.backlog);
    }
    return text;
}

std::string breakdown_text(const NetworkResult& f) {
    const double since_s = f.collapse_s.value_or(0.0);
    switch (f.unstable_by) {
        case InstabilityCause::none:
            return "";
        case InstabilityCause::throughput_drop:
            return fmt::format(", throughput drops at {:.0f} s", since_s);
        case InstabilityCause::teleported:
            return fmt::format(", 1 % teleported by {:.0f} s", since_s);
        case InstabilityCause::gridlock:
            return fmt::format(", gridlock since {:.0f} s", since_s);
        case InstabilityCause::starvation:
            return fmt::format(", a movement starves since {:.0f} s", since_s);
    }
    return "";
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

std::string first_violation_text(const NetworkResult& f, const std::vector<std::string>& lanes) {
    const Violation& first = f.violations.first;
    if (first.time_s < 0.0) return "";
    const std::string lane = first.lane < 0 ? "" : fmt::format(" on {}", lanes[static_cast<std::size_t>(first.lane)]);
    std::string what = fmt::format("vehicle {} enters on red{}", first.vehicle, lane);
    if (first.kind == Violation::Kind::overlap)
        what = fmt::format("vehicle {}{} overlaps vehicle {}", first.vehicle, lane, first.other);
    if (first.kind == Violation::Kind::conflict)
        what = fmt::format("vehicle {}{} is in the same conflict area as vehicle {}", first.vehicle, lane, first.other);
    return fmt::format(
        "First violation of {}: at {:.1f} s {}.\n"
        "To see it: run again with --record FILE, make a page with stopline-replay, open PAGE#t={:.0f}&vehicle={}\n",
        f.population, first.time_s, what, first.time_s, first.vehicle);
}

// Returns the table of throughput, travel time, density and stability.
std::string traffic_text(const NetworkReport& report) {
    TextTable table;
    table.add_row({"", "throughput", "gain", "travel time", "time saved", "density", "vehicles", "stability"});
    table.add_row({"population", "veh/h", "%", "s", "%", "%", "veh", ""});
    for (const NetworkResult& f : report.populations) {
        const bool measured = f.measured.window.length_s() > 0.0;
        table.add_row({f.population, number_cell(f.measured.throughput_veh_h(), 0),
                       number_cell(report.improvement_percent(f), 1), number_cell(f.measured.travel_time_s, 1),
                       number_cell(report.time_saved_percent(f), 1),
                       measured ? number_cell(100.0 * f.measured.occupied, 1) : "-",
                       measured ? number_cell(f.vehicles_present, 0) : "-",
                       kStabilityNames[static_cast<std::size_t>(f.stability)] + breakdown_text(f)});
    }
    return table.text();
}

// Returns the table of delay causes, gridlocks, teleported vehicles and passed blockers. A vehicle that is
// stopped inside an intersection is a passed blocker if crossing vehicles no longer wait for it (rule
// pass_blocker_greens).
std::string congestion_text(const NetworkReport& report) {
    TextTable table;
    table.add_row({"", "junction", "turn", "", "", "wrong", "|", "", "", "passed"});
    table.add_row({"population", "blocking", "blocking", "spillback", "gridlock", "lane", "|", "gridlocks",
                   "teleported", "blockers"});
    for (const NetworkResult& f : report.populations) {
        const DelayLog& log = f.delays;
        table.add_row({f.population, share_text(log, DelayCause::junction_blocking),
                       share_text(log, DelayCause::turn_blocking), share_text(log, DelayCause::spillback),
                       share_text(log, DelayCause::gridlock), share_text(log, DelayCause::wrong_lane), "|",
                       std::to_string(log.gridlocks.size()), std::to_string(log.teleported),
                       std::to_string(log.passed_blockers)});
    }
    return "Share of the delay by cause [%] | gridlocks and uses of the rules\n" + table.text();
}

}  // namespace

std::string network_text(const NetworkReport& report) {
    const bool has_trips = network_kind(report.scenario.network).has_trips;
    const std::string area = has_trips ? "whole network"
                                       : fmt::format("up to {:g} m upstream and downstream of the outer stop lines",
                                                     report.scenario.measure.area_margin_m);
    const std::string traffic_notes = fmt::format(
        "Measured area: {}.\n"
        "throughput: vehicles that leave the area; gain, time saved: compared with the baseline;\n"
        "travel time: mean of the vehicles that leave the area; density: share of its lane length that\n"
        "vehicles occupy; vehicles: mean number in the whole network, queues upstream of the area included;\n"
        "stability: of the whole run.\n{}{}\n",
        area, window_text(report), warnings_text(report));
    const std::string congestion_notes =
        "Both cover the whole run and the whole network. Delay is the time that vehicles are stopped.\n"
        "The rest of it is due to signals, yielding and queue discharge (summary.csv).\n"
        "wrong lane: the first vehicle of the queue waits for a gap to change lanes;\n"
        "passed blockers: vehicles that passed one that blocked the intersection, by rules.pass_blocker_greens.\n";
    std::int64_t runs_with_violations = 0;
    std::string first_violations;
    for (const NetworkResult& f : report.populations) {
        runs_with_violations += f.violations.none() ? 0 : 1;
        first_violations += first_violation_text(f, report.lanes);
    }
    const std::string verdict =
        runs_with_violations == 0
            ? "No overlaps on lanes or in conflict areas (passed blockers excepted), no entries on red, "
              "no lost vehicles.\n"
            : fmt::format("VIOLATIONS in {} runs: summary.csv has the counts of each.\n{}", runs_with_violations,
                          first_violations);
    return traffic_text(report) + "\n" + traffic_notes + "\n" + congestion_text(report) + "\n" + congestion_notes +
           (has_trips ? trips_text(report) : backlog_text(report)) + "\n" + verdict +
           starvation_text(report.scenario, report.starvations(), report.lanes);
}

}  // namespace stopline
