#include "common/network_text.h"

#include <fmt/format.h>
#include <cmath>

#include "common/text_table.h"
#include "measure/steady_state.h"

namespace stopline {

namespace {

std::string number(double value, int decimals) {
    return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string share_text(const HindranceLog& log, Cause cause) {
    double all_s = 0.0;
    for (std::size_t k = 1; k < kCauseNames.size(); ++k) all_s += log.lost_s[k];
    const double lost_s = log.lost_s[static_cast<std::size_t>(cause)];
    return number(all_s > 0.0 ? 100.0 * lost_s / all_s : 0.0, 1);
}

std::string trips_text(const NetworkReport& report) {
    TextTable table;
    table.row({"trips", "entered", "arrived", "on the way", "no room to enter", "strayed"});
    for (const NetworkFigures& f : report.populations) {
        table.row({f.population, std::to_string(f.entered), std::to_string(f.left_network),
                   std::to_string(f.entered - f.left_network), std::to_string(f.waiting), std::to_string(f.strayed)});
    }
    return "\n" + table.text() + "\nstrayed: at the end of a lane that does not serve their way, and moved on.\n";
}

std::string waiting_text(const NetworkReport& report) {
    std::string text;
    for (const NetworkFigures& f : report.populations) {
        if (f.waiting == 0) continue;
        text += fmt::format("{}: {} vehicles have come for which there was no room to enter until the end.\n",
                            f.population, f.waiting);
    }
    return text;
}

std::string breakdown_text(const NetworkFigures& f) {
    const double since_s = f.collapse_s.value_or(0.0);
    switch (f.breakdown) {
        case Breakdown::none:
            return "";
        case Breakdown::fall:
            return fmt::format(", less from {:.0f} s on", since_s);
        case Breakdown::moved_on:
            return fmt::format(", 1 % moved on by {:.0f} s", since_s);
        case Breakdown::gridlock:
            return fmt::format(", gridlock since {:.0f} s", since_s);
    }
    return "";
}

// What to mind about figures that are there.
std::string warnings_text(const NetworkReport& report) {
    constexpr int kFewest = static_cast<int>(kCollapseNeeds);
    std::string text;
    std::string too_short;
    for (const NetworkFigures& f : report.populations) {
        if (leaves_few(f)) {
            text += fmt::format(
                "\n{}: travel time is of those that got out; {:.0f} vehicles, of which {:.0f} leave an hour, are in the "
                "area for {:.0f} s.",
                f.population, f.steady.vehicles, f.steady.throughput_veh_h(),
                f.steady.vehicles * 3600.0 / f.steady.throughput_veh_h());
        }
        const bool open = f.stability != Stability::unstable && f.full_cycles < kFewest;
        if (open) too_short += (too_short.empty() ? "" : ", ") + f.population;
    }
    if (!too_short.empty()) {
        text += fmt::format("\nToo short to see whether throughput falls, less than {} cycles since it has filled: {}.",
                            kFewest, too_short);
    }
    return text;
}

std::string sighting_text(const NetworkFigures& f, const std::vector<std::string>& lanes) {
    const Sighting& seen = f.violations.first;
    if (seen.time_s < 0.0) return "";
    const std::string lane = seen.lane < 0 ? "" : fmt::format(" on {}", lanes[static_cast<std::size_t>(seen.lane)]);
    std::string what = fmt::format("vehicle {} enters on red{}", seen.vehicle, lane);
    if (seen.kind == Sighting::Kind::overlap)
        what = fmt::format("vehicle {}{} reaches into vehicle {}", seen.vehicle, lane, seen.other);
    if (seen.kind == Sighting::Kind::conflict)
        what = fmt::format("vehicle {}{} is in a conflict area with vehicle {}", seen.vehicle, lane, seen.other);
    return fmt::format(
        "First of {}: at {:.1f} s {}. Look at it: --record FILE, stopline-replay, PAGE#t={:.0f}&vehicle={}\n",
        f.population, seen.time_s, what, seen.time_s, seen.vehicle);
}

}  // namespace

std::string network_text(const NetworkReport& report) {
    TextTable table;
    table.row({"", "veh/h", "gain %", "s", "saved %", "density %", "present", "junction %", "turn %", "spillback %",
               "gridlock %", "lane %", "gridlocks", "moved on", "passed", "stability"});
    std::int64_t violations = 0;
    std::string sightings;
    for (const NetworkFigures& f : report.populations) {
        const HindranceLog& log = f.hindrance;
        std::string stability = kStabilityNames[static_cast<std::size_t>(f.stability)];
        const bool measured = f.steady.window.length_s() > 0.0;
        stability += breakdown_text(f);
        table.row({f.population, number(f.steady.throughput_veh_h(), 0), number(report.improvement_percent(f), 1),
                   number(f.steady.travel_time_s, 1), number(report.time_saved_percent(f), 1),
                   measured ? number(100.0 * f.steady.occupied, 1) : "-",
                   measured ? number(f.vehicles_present, 0) : "-", share_text(log, Cause::junction_blocking),
                   share_text(log, Cause::turn_blocking), share_text(log, Cause::spillback),
                   share_text(log, Cause::gridlock), share_text(log, Cause::wrong_lane),
                   std::to_string(log.gridlocks.size()), std::to_string(log.taken_out),
                   std::to_string(log.passed_blockers), stability});
        violations += f.violations.none() ? 0 : 1;
        sightings += sighting_text(f, report.lanes);
    }
    const bool sumo = report.scenario.network.is_sumo();
    const std::string area =
        sumo ? "Area: the whole network."
             : fmt::format("Area: up to {:g} m outside the outer stop lines.", report.scenario.measure.outside_m);
    const std::string notes = fmt::format(
        "{} veh/h: vehicles that leave it; s: their mean time in it; density: share of\n"
        "its lanes' metres; junction, turn, spillback, gridlock, lane: share of the time that vehicles stand, by what holds up\n"
        "their queue (lane: one that waits to change lanes); moved on, passed: uses of the rules. These, gridlocks and\n"
        "stability are of the whole run, queues outside included.\n{}{}\n",
        area, window_text(report), warnings_text(report));
    const std::string verdict =
        violations == 0
            ? "No overlaps on lanes or in conflict areas but by the rule for blockers, no entries on red, no vehicle "
              "lost.\n"
            : fmt::format("VIOLATIONS in {} runs: see summary.csv.\n{}", violations, sightings);
    return table.text() + "\n" + notes + (sumo ? trips_text(report) : waiting_text(report)) + "\n" + verdict;
}

}  // namespace stopline
