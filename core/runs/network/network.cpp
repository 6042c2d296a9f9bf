#include "runs/network/network.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "base/nan.h"
#include "base/units.h"
#include "measure/steady_state.h"
#include "runs/metrics/metric_tables.h"
#include "runs/network/network_metrics.h"
#include "runs/parallel_runs.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/make_network.h"

namespace stopline {

namespace {

const NetworkResult* baseline_of(const NetworkReport& report) {
    for (const NetworkResult& result : report.populations) {
        if (result.population == report.scenario.measure.baseline) return &result;
    }
    return nullptr;
}

const std::string& lane_name(const NetworkReport& report, int lane) {
    static const std::string kNoName;
    return lane < 0 ? kNoName : report.lanes.at(static_cast<std::size_t>(lane));
}

// Returns the name of a vehicle as a table cell; an empty cell for -1, which means no vehicle.
std::string vehicle_cell(const NetworkResult& f, int vehicle) { return vehicle < 0 ? "" : f.vehicle_names.of(vehicle); }

}  // namespace

bool is_travel_time_biased(const NetworkResult& result) {
    constexpr double kMaxRatio = 1.5;
    const AreaResult& measured = result.measured;
    return measured.vehicles * kSecondsPerHour > kMaxRatio * measured.throughput_veh_h() * measured.travel_time_s;
}

double NetworkReport::improvement_percent(const NetworkResult& result) const {
    const NetworkResult* const base = baseline_of(*this);
    if (base == nullptr) return kNan;
    return 100.0 * (result.measured.throughput_veh_h() / base->measured.throughput_veh_h() - 1.0);
}

double NetworkReport::time_saved_percent(const NetworkResult& result) const {
    const NetworkResult* const base = baseline_of(*this);
    if (base == nullptr) return kNan;
    if (is_travel_time_biased(result) || is_travel_time_biased(*base)) return kNan;
    return 100.0 * (1.0 - result.measured.travel_time_s / base->measured.travel_time_s);
}

bool NetworkReport::no_starvation() const {
    return std::all_of(populations.begin(), populations.end(),
                       [](const NetworkResult& f) { return f.delays.starvations.empty(); });
}

bool NetworkReport::no_violations() const {
    return std::all_of(populations.begin(), populations.end(),
                       [](const NetworkResult& f) { return f.violations.none(); });
}

NetworkReport run_networks(const Scenario& scenario, const NetworkOptions& options) {
    constexpr std::int64_t kProgressSteps = 200;
    NetworkReport report{scenario, std::vector<NetworkResult>(scenario.populations.size()), {}};
    for (const Lane& lane : make_network(scenario.network).lanes) {
        report.lanes.push_back(lane.name);
    }
    // If there is only one run, all threads share it. If there are several runs, each run gets one thread, because
    // OpenMP would otherwise create nested teams of threads in every step.
    const int threads_per_run = report.populations.size() == 1 ? options.threads : 1;
    run_side_by_side(report.populations.size(), options.threads, options.on_progress,
                     [&](std::size_t k, const std::function<bool(double)>& report_progress) {
                         const auto on_step = [&](const Simulation& simulation) {
                             return simulation.state().tick % kProgressSteps != 0 ||
                                    report_progress(simulation.time_s() / scenario.duration_s);
                         };
                         report.populations[k] =
                             run_network(scenario, k, on_step, threads_per_run, options.observation);
                     });
    return report;
}

namespace {

// Returns why the measured window begins where it does, for runs that are not longer than measure.window. `first`: the
// measured window of the first population.
std::string warm_up_text(const NetworkReport& report, const TimeWindow& first) {
    const MeasureSettings& measure = report.scenario.measure;
    std::string text = fmt::format(" measure.window is {:g} s, but the run lasts {:g} s: ", measure.window_s,
                                   report.scenario.duration_s);
    if (report.populations[0].series.size() < kMinWarmUpValues) {
        return text + fmt::format(
                          "the run is measured from its start, because it is too short to find the end of its "
                          "warm-up. That takes at least {:g} min ({} times measure.interval). Increase 'duration', or "
                          "set a measure.window shorter than the run.",
                          static_cast<double>(kMinWarmUpValues) * measure.interval_s / 60.0, kMinWarmUpValues);
    }
    text += "each population is measured from the end of its warm-up";
    const auto same = [&](const NetworkResult& f) { return f.measured.window.from_s == first.from_s; };
    if (!std::all_of(report.populations.begin(), report.populations.end(), same)) {
        text += fmt::format("; the printed times are those of {}, the others are in summary.csv (window_from_s)",
                            report.populations[0].population);
    }
    return text + ".";
}

}  // namespace

std::string window_text(const NetworkReport& report) {
    const MeasureSettings& measure = report.scenario.measure;
    const double end_s = report.scenario.duration_s;
    const double target_from_s = end_s - measure.window_s;
    if (report.populations.empty()) return "";
    const TimeWindow& first = report.populations[0].measured.window;
    if (!(first.length_s() > 0.0)) {
        return fmt::format(
            "Nothing is measured: the last {:g} s of the run contain no whole interval of {:g} s (measure.interval).",
            std::min(measure.window_s, end_s), measure.interval_s);
    }
    std::string text = fmt::format("Measured from {:.0f} to {:.0f} s.", first.from_s, first.to_s);
    if (target_from_s <= 0.0) {
        text += warm_up_text(report, first);
    } else if (first.from_s != target_from_s || first.to_s != end_s) {
        text += fmt::format(
            " measure.window gives {:g} to {:g} s; only whole intervals of {:g} s (measure.interval) are measured.",
            target_from_s, end_s, measure.interval_s);
    }
    std::string late;
    for (const NetworkResult& f : report.populations) {
        if (f.measured.window.from_s >= f.warm_up_s) continue;
        late += fmt::format("{}{} at {:.0f} s", late.empty() ? "" : ", ", f.population, f.warm_up_s);
    }
    if (!late.empty())
        text += "\nThe measured window begins before the warm-up ends: " + late + " (warm_up_s in summary.csv).";
    return text;
}

std::string network_csv(const NetworkReport& report) {
    return metrics_csv(network_metrics(), report.scenario, measured_runs(report));
}

std::string network_series_csv(const NetworkReport& report) {
    std::vector<std::string> columns{"population",      "from_s",           "throughput_veh_h", "travel_time_s",
                                     "density_percent", "vehicles_in_area", "teleported"};
    for (std::size_t cause = 1; cause < kDelayCauseNames.size(); ++cause) {
        columns.push_back(fmt::format("delay_{}_h", kDelayCauseNames[cause]));
    }
    CsvWriter csv(columns);
    for (const NetworkResult& f : report.populations) {
        for (const NetworkInterval& interval : f.series) {
            std::vector<std::string> row{f.population,
                                         fixed(interval.area.window.from_s, 0),
                                         fixed(interval.area.throughput_veh_h(), 1),
                                         fixed(interval.area.travel_time_s, 3),
                                         fixed(100.0 * interval.area.occupied, 3),
                                         fixed(interval.area.vehicles, 2),
                                         std::to_string(interval.teleported)};
            for (std::size_t cause = 1; cause < kDelayCauseNames.size(); ++cause) {
                row.push_back(fixed(interval.delay_s[cause] / kSecondsPerHour, 4));
            }
            csv.row(row);
        }
    }
    return csv.text();
}

std::string origin_destination_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "from", "to", "throughput_veh_h", "travel_time_s"});
    for (const NetworkResult& f : report.populations) {
        for (const OriginDestinationResult& pair : f.origin_destination) {
            if (pair.exited == 0) continue;
            csv.row({f.population, kSideNames[static_cast<std::size_t>(pair.from)],
                     kSideNames[static_cast<std::size_t>(pair.to)],
                     fixed(pair.exited * kSecondsPerHour / f.measured.window.length_s(), 2),
                     fixed(pair.travel_time_s, 3)});
        }
    }
    return csv.text();
}

std::string delays_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "cause", "lane", "vehicle", "blocker", "blocker_lane", "from_s", "to_s",
                   "max_vehicles", "delay_s"});
    for (const NetworkResult& f : report.populations) {
        for (const DelayEpisode& e : f.delays.episodes) {
            csv.row({f.population, kDelayCauseNames[static_cast<std::size_t>(e.cause)], lane_name(report, e.lane),
                     vehicle_cell(f, e.vehicle), vehicle_cell(f, e.blocker), lane_name(report, e.blocker_lane),
                     fixed(e.from_s, 1), fixed(e.to_s, 1), std::to_string(e.max_vehicles), fixed(e.delay_s, 1)});
        }
    }
    return csv.text();
}

std::string lane_delays_csv(const NetworkReport& report) {
    struct Sum {
        int episodes = 0;
        double delay_s = 0.0;
    };
    CsvWriter csv({"population", "lane", "cause", "episodes", "delay_s"});
    for (const NetworkResult& f : report.populations) {
        std::map<std::pair<int, DelayCause>, Sum> sums;  // [lane, cause]
        for (const DelayEpisode& e : f.delays.episodes) {
            Sum& sum = sums[{e.lane, e.cause}];
            ++sum.episodes;
            sum.delay_s += e.delay_s;
        }
        for (const auto& [key, sum] : sums) {
            csv.row({f.population, lane_name(report, key.first), kDelayCauseNames[static_cast<std::size_t>(key.second)],
                     std::to_string(sum.episodes), fixed(sum.delay_s, 1)});
        }
    }
    return csv.text();
}

std::string gridlocks_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "gridlock", "from_s", "to_s", "vehicle", "lane"});
    for (const NetworkResult& f : report.populations) {
        for (std::size_t k = 0; k < f.delays.gridlocks.size(); ++k) {
            const Gridlock& g = f.delays.gridlocks[k];
            for (std::size_t member = 0; member < g.vehicles.size(); ++member) {
                csv.row({f.population, std::to_string(k + 1), fixed(g.from_s, 1), fixed(g.to_s, 1),
                         vehicle_cell(f, g.vehicles[member]), lane_name(report, g.lanes[member])});
            }
        }
    }
    return csv.text();
}

std::vector<PopulationStarvations> NetworkReport::starvations() const {
    std::vector<PopulationStarvations> all;
    for (const NetworkResult& f : populations) all.push_back({f.population, f.delays.starvations, f.vehicle_names});
    return all;
}

std::string rules_csv(const NetworkReport& report) {
    static constexpr std::array<const char*, 5> kRuleNames{"teleported", "reinserted", "passed_blocker", "keep_clear",
                                                           "refused"};
    CsvWriter csv({"population", "time_s", "rule", "vehicle", "lane", "blocker", "stopped_s"});
    for (const NetworkResult& f : report.populations) {
        for (const RuleUse& use : f.delays.rule_uses) {
            csv.row({f.population, fixed(use.time_s, 1), kRuleNames[static_cast<std::size_t>(use.kind)],
                     vehicle_cell(f, use.vehicle), lane_name(report, use.lane), vehicle_cell(f, use.blocker),
                     fixed(use.stopped_s, 1)});
        }
    }
    return csv.text();
}

std::string street_time_space_csv(const NetworkReport& report) {
    std::vector<std::string> names;
    std::vector<StreetTrace> traces;
    for (const NetworkResult& f : report.populations) {
        names.push_back(f.population);
        traces.push_back(f.street_trace);
    }
    return time_space_csv(names, traces);
}

}  // namespace stopline
