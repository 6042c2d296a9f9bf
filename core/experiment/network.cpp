#include "experiment/network.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "experiment/csv.h"
#include "experiment/side_by_side.h"

namespace stopline {

namespace {

constexpr double kHour_s = 3600.0;

const NetworkFigures* baseline_of(const NetworkReport& report) {
    for (const NetworkFigures& one : report.populations) {
        if (one.population == report.scenario.measure.baseline) return &one;
    }
    return nullptr;
}

const std::string& lane_name(const NetworkReport& report, int lane) {
    static const std::string kNone;
    return lane < 0 ? kNone : report.lanes.at(static_cast<std::size_t>(lane));
}

// "" where nothing is measured.
std::string window_end(const NetworkFigures& figures, double time_s) {
    return figures.steady.window.length_s() > 0.0 ? fixed(time_s, 0) : "";
}

std::string number_or_none(int number) { return number < 0 ? "" : std::to_string(number); }

}  // namespace

bool leaves_few(const NetworkFigures& figures) {
    constexpr double kMuchLonger = 1.5;
    const AreaFigures& steady = figures.steady;
    return steady.vehicles * kHour_s > kMuchLonger * steady.throughput_veh_h() * steady.travel_time_s;
}

double NetworkReport::improvement_percent(const NetworkFigures& figures) const {
    const NetworkFigures* const base = baseline_of(*this);
    if (base == nullptr) return std::numeric_limits<double>::quiet_NaN();
    return 100.0 * (figures.steady.throughput_veh_h() / base->steady.throughput_veh_h() - 1.0);
}

double NetworkReport::time_saved_percent(const NetworkFigures& figures) const {
    const NetworkFigures* const base = baseline_of(*this);
    if (base == nullptr) return std::numeric_limits<double>::quiet_NaN();
    if (leaves_few(figures) || leaves_few(*base)) return std::numeric_limits<double>::quiet_NaN();
    return 100.0 * (1.0 - figures.steady.travel_time_s / base->steady.travel_time_s);
}

bool NetworkReport::no_violations() const {
    return std::all_of(populations.begin(), populations.end(),
                       [](const NetworkFigures& f) { return f.violations.none(); });
}

NetworkReport run_networks(const Scenario& scenario, const NetworkOptions& options) {
    constexpr std::int64_t kTell = 200;  // steps
    NetworkReport report{scenario, std::vector<NetworkFigures>(scenario.populations.size()), {}};
    for (const Lane& lane : make_network(scenario.network).lanes) {
        report.lanes.push_back(lane.name);
    }
    // One run alone is shared by all threads. Several have one each: teams within a team would be formed anew in every step.
    const int threads_each = report.populations.size() == 1 ? options.threads : 1;
    run_side_by_side(report.populations.size(), options.threads, options.on_progress,
                     [&](std::size_t k, const std::function<bool(double)>& tell) {
                         const auto on_step = [&](const Simulation& simulation) {
                             return simulation.state().tick % kTell != 0 ||
                                    tell(simulation.time_s() / scenario.duration_s);
                         };
                         report.populations[k] = run_network(scenario, k, on_step, threads_each, options.observation);
                     });
    return report;
}

std::string window_text(const NetworkReport& report) {
    const MeasureSettings& measure = report.scenario.measure;
    const double end_s = report.scenario.duration_s;
    const double asked_s = end_s - measure.steady_s;
    if (report.populations.empty()) return "";
    const TimeWindow& first = report.populations[0].steady.window;
    if (!(first.length_s() > 0.0)) {
        return fmt::format(
            "Nothing is measured: no whole interval of {:g} s (measure.interval) lies in the last {:g} s of the run.",
            measure.interval_s, std::min(measure.steady_s, end_s));
    }
    std::string text = fmt::format("Measured from {:.0f} to {:.0f} s.", first.from_s, first.to_s);
    if (asked_s <= 0.0) {
        text += fmt::format(
            " measure.steady asks for {:g} s, the run has {:g} s: of each population all but its warm-up is measured",
            measure.steady_s, end_s);
        const auto same = [&](const NetworkFigures& f) { return f.steady.window.from_s == first.from_s; };
        if (!std::all_of(report.populations.begin(), report.populations.end(), same)) {
            text += fmt::format(", here that of {} (others: window_from_s in summary.csv)",
                                report.populations[0].population);
        }
        text += ".";
    } else if (first.from_s != asked_s || first.to_s != end_s) {
        text += fmt::format(
            " measure.steady asks for {:g} to {:g} s; whole intervals of {:g} s (measure.interval) are measured.",
            asked_s, end_s, measure.interval_s);
    }
    std::string late;
    for (const NetworkFigures& f : report.populations) {
        if (f.steady.window.from_s >= f.warm_up_s) continue;
        late += fmt::format("{}{} at {:.0f} s", late.empty() ? "" : ", ", f.population, f.warm_up_s);
    }
    if (!late.empty())
        text += "\nThat is before the number of vehicles settles: " + late + " (warm_up_s in summary.csv).";
    return text;
}

std::string network_csv(const NetworkReport& report) {
    std::vector<std::string> columns{"population",
                                     "throughput_veh_h",
                                     "improvement_percent",
                                     "travel_time_s",
                                     "travel_time_saved_percent",
                                     "density_percent",
                                     "vehicles_in_area",
                                     "vehicles_present",
                                     "most_present",
                                     "window_from_s",
                                     "window_to_s",
                                     "warm_up_s",
                                     "stability",
                                     "unstable_by",
                                     "collapse_s",
                                     "gridlocks",
                                     "first_gridlock_s",
                                     "moved_on",
                                     "passed_blockers"};
    for (std::size_t cause = 1; cause < kCauseNames.size(); ++cause) {
        columns.push_back(fmt::format("lost_{}_h", kCauseNames[cause]));
    }
    for (const char* const column : {"lost_outside_h", "longest_stand_s", "longest_inside_s", "entered", "left",
                                     "overlaps", "conflicts", "red_entries", "forced_red_entries", "lost_vehicles"}) {
        columns.emplace_back(column);
    }
    const bool trips = report.scenario.network.is_sumo();
    if (trips) columns.emplace_back("strayed");
    columns.emplace_back("waiting");
    CsvWriter csv(columns);
    for (const NetworkFigures& f : report.populations) {
        const HindranceLog& log = f.hindrance;
        std::vector<std::string> row{f.population,
                                     fixed(f.steady.throughput_veh_h(), 2),
                                     fixed(report.improvement_percent(f), 2),
                                     fixed(f.steady.travel_time_s, 3),
                                     fixed(report.time_saved_percent(f), 2),
                                     fixed(100.0 * f.steady.occupied, 3),
                                     fixed(f.steady.vehicles, 2),
                                     fixed(f.vehicles_present, 2),
                                     std::to_string(f.most_present),
                                     window_end(f, f.steady.window.from_s),
                                     window_end(f, f.steady.window.to_s),
                                     fixed(f.warm_up_s, 0),
                                     kStabilityNames[static_cast<std::size_t>(f.stability)],
                                     kBreakdownNames[static_cast<std::size_t>(f.breakdown)],
                                     f.collapse_s ? fixed(*f.collapse_s, 0) : "",
                                     std::to_string(log.gridlocks.size()),
                                     log.gridlocks.empty() ? "" : fixed(log.gridlocks[0].from_s, 0),
                                     std::to_string(log.taken_out),
                                     std::to_string(log.passed_blockers)};
        for (std::size_t cause = 1; cause < kCauseNames.size(); ++cause) {
            row.push_back(fixed(log.lost_s[cause] / kHour_s, 3));
        }
        const Violations& v = f.violations;
        for (const std::string& cell :
             {fixed(log.lost_outside_s / kHour_s, 3), fixed(log.longest_stand_s, 0), fixed(f.longest_inside_s, 1),
              std::to_string(f.entered), std::to_string(f.left_network), std::to_string(v.overlaps),
              std::to_string(v.conflicts), std::to_string(v.red_entries), std::to_string(v.forced_red_entries),
              std::to_string(v.lost_vehicles)}) {
            row.push_back(cell);
        }
        if (trips) row.push_back(std::to_string(f.strayed));
        row.push_back(std::to_string(f.waiting));
        csv.row(row);
    }
    return csv.text();
}

std::string network_series_csv(const NetworkReport& report) {
    std::vector<std::string> columns{"population",      "from_s",           "throughput_veh_h", "travel_time_s",
                                     "density_percent", "vehicles_in_area", "moved_on"};
    for (std::size_t cause = 1; cause < kCauseNames.size(); ++cause) {
        columns.push_back(fmt::format("lost_{}_h", kCauseNames[cause]));
    }
    CsvWriter csv(columns);
    for (const NetworkFigures& f : report.populations) {
        for (const NetworkInterval& each : f.series) {
            std::vector<std::string> row{f.population,
                                         fixed(each.area.window.from_s, 0),
                                         fixed(each.area.throughput_veh_h(), 1),
                                         fixed(each.area.travel_time_s, 3),
                                         fixed(100.0 * each.area.occupied, 3),
                                         fixed(each.area.vehicles, 2),
                                         std::to_string(each.taken_out)};
            for (std::size_t cause = 1; cause < kCauseNames.size(); ++cause) {
                row.push_back(fixed(each.lost_s[cause] / kHour_s, 4));
            }
            csv.row(row);
        }
    }
    return csv.text();
}

std::string network_ways_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "from", "to", "throughput_veh_h", "travel_time_s"});
    for (const NetworkFigures& f : report.populations) {
        for (const WayFigures& way : f.ways) {
            if (way.left == 0) continue;
            csv.row({f.population, kSideNames[static_cast<std::size_t>(way.from)],
                     kSideNames[static_cast<std::size_t>(way.to)],
                     fixed(way.left * kHour_s / f.steady.window.length_s(), 2), fixed(way.travel_time_s, 3)});
        }
    }
    return csv.text();
}

std::string hindrance_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "cause", "lane", "vehicle", "blocker", "blocker_lane", "from_s", "to_s",
                   "most_vehicles", "lost_s"});
    for (const NetworkFigures& f : report.populations) {
        for (const HindranceEpisode& e : f.hindrance.episodes) {
            csv.row({f.population, kCauseNames[static_cast<std::size_t>(e.cause)], lane_name(report, e.lane),
                     std::to_string(e.vehicle), number_or_none(e.blocker), lane_name(report, e.blocker_lane),
                     fixed(e.from_s, 1), fixed(e.to_s, 1), std::to_string(e.most), fixed(e.lost_s, 1)});
        }
    }
    return csv.text();
}

std::string gridlocks_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "gridlock", "from_s", "to_s", "vehicle", "lane"});
    for (const NetworkFigures& f : report.populations) {
        for (std::size_t k = 0; k < f.hindrance.gridlocks.size(); ++k) {
            const Gridlock& g = f.hindrance.gridlocks[k];
            for (std::size_t member = 0; member < g.vehicles.size(); ++member) {
                csv.row({f.population, std::to_string(k + 1), fixed(g.from_s, 1), fixed(g.to_s, 1),
                         std::to_string(g.vehicles[member]), lane_name(report, g.lanes[member])});
            }
        }
    }
    return csv.text();
}

std::string rules_csv(const NetworkReport& report) {
    static constexpr std::array<const char*, 4> kKinds{"moved_on", "put_back", "passed_blocker", "kept_out"};
    CsvWriter csv({"population", "time_s", "rule", "vehicle", "lane", "blocker", "stood_s"});
    for (const NetworkFigures& f : report.populations) {
        for (const RuleUse& use : f.hindrance.rules) {
            csv.row({f.population, fixed(use.time_s, 1), kKinds[static_cast<std::size_t>(use.kind)],
                     std::to_string(use.vehicle), lane_name(report, use.lane), number_or_none(use.blocker),
                     fixed(use.stood_s, 1)});
        }
    }
    return csv.text();
}

}  // namespace stopline
