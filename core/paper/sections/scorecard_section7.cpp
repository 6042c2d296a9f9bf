// Section VII of the paper: Berlin (rows B01 to B09 of data/paper/targets.csv). The values come from one sweep with six
// seeds. Only those runs of the sweep are used in which the major road has three lanes per direction.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "measure/confidence.h"
#include "paper/sections/scorecard_sections.h"
#include "paper/sections/scorecard_sweeps.h"
#include "runs/run_metrics.h"

namespace stopline {

namespace {

constexpr const char* kBerlin = "berlin";
constexpr double kMinute_s = 60.0;

// Columns of the sweep results that the row functions read.
constexpr std::array<const char*, 15> kColumns{"throughput_early_veh_h",
                                               "throughput_late_veh_h",
                                               "travel_time_early_s",
                                               "travel_time_late_s",
                                               "congested_from_suarezstr_east_s",
                                               "congested_from_kaiser_friedrich_str_east_s",
                                               "congested_from_wilmersdorfer_str_east_s",
                                               "congested_from_krumme_str_east_s",
                                               "congested_from_pedestrian_lights_east_s",
                                               "congested_from_leibnizstr_east_s",
                                               "congested_from_am_schillertheater_east_s",
                                               "congested_from_suarezstr_west_s",
                                               "congested_from_witzlebenplatz_west_s",
                                               "congested_from_sophie_charlotte_str_west_s",
                                               "congested_from_koenigin_elisabeth_str_west_s"};
// Columns with the times from which successive approaches are congested. East and west name the side from which the
// traffic comes. The order is upstream: from the approach where a queue may start to the entry of the network.
using Columns = std::span<const char* const>;
constexpr Columns kFromSuarezEast{kColumns.data() + 4, 7};
constexpr Columns kFromKrummeEast{kColumns.data() + 7, 4};
constexpr Columns kFromSuarezWest{kColumns.data() + 11, 4};

std::string value_name(const std::string& column, const std::string& population, std::size_t run) {
    return fmt::format("{} {} {}", column, population, run);
}

Measurements measure_berlin(const Scenario& /*scenario*/, const ScorecardOptions& options) {
    const SweepRuns runs = run_sweep(options, "berlin.yaml", {}, kBerlin, run_metrics, {0.0, 1.0});
    Measurements measured;
    std::map<std::string, std::size_t> seeds;  // [population]
    runs.store.for_each_run([&](std::size_t point, const std::string& text) {
        const Scenario scenario = runs.sweep.scenario(runs.sweep.combination(point));
        if (scenario.network.streets.name != "three_lanes") return;
        const std::string population = runs.sweep.population(point);
        const std::size_t run = seeds[population]++;
        for (const char* const column : kColumns) {
            measured.set(value_name(column, population, run),
                         parse_number(value_in(text, column)).value_or(std::numeric_limits<double>::quiet_NaN()));
        }
    });
    measured.set("violations", static_cast<double>(runs.totals.runs_with_violations));
    return measured;
}

// Returns the values of a result column for one population, one value for each seed.
std::vector<double> values(const Measurements& m, const char* column, const char* population) {
    std::vector<double> all;
    for (std::size_t run = 0;; ++run) {
        const std::optional<double> value = m.find(value_name(column, population, run));
        if (!value) return all;
        all.push_back(*value);
    }
}

double mean(const Measurements& m, const char* column, const char* population) {
    const std::vector<double> all = values(m, column, population);
    return all.empty() ? std::numeric_limits<double>::quiet_NaN() : mean_of(all);
}

// Returns the mean throughput over minutes 15 to 60 and 65 to 120, veh/min. The two periods are weighted with their
// lengths of 45 and 55 minutes.
double flow(const Measurements& m, const char* population) {
    return (0.45 * mean(m, "throughput_early_veh_h", population) +
            0.55 * mean(m, "throughput_late_veh_h", population)) /
           kMinute_s;
}

using MaybeAnswer = std::optional<Answer>;

MaybeAnswer ctg_flow(const Target&, const Measurements& m) { return number_answer(flow(m, "CTG-Ref")); }
MaybeAnswer cdg_before(const Target&, const Measurements& m) {
    return number_answer(mean(m, "throughput_early_veh_h", "CDG") / kMinute_s);
}
MaybeAnswer cdg_after(const Target&, const Measurements& m) {
    return number_answer(mean(m, "throughput_late_veh_h", "CDG") / kMinute_s);
}
MaybeAnswer cdg_gain(const Target&, const Measurements& m) {
    return number_answer(100.0 *
                         (mean(m, "throughput_late_veh_h", "CDG") / mean(m, "throughput_late_veh_h", "CTG-Ref") - 1.0));
}
MaybeAnswer mix_gain(const Target&, const Measurements& m) {
    return number_answer(100.0 * (flow(m, "MIX") / flow(m, "CTG-Ref") - 1.0));
}

// Returns a text about the times at which queues filled an approach or several approaches: median, earliest and latest,
// such as "minute 12 (3 to 20) in 5 of 6 runs". `filled_s` holds one time for each seed, NaN for never.
std::string filled_text(const std::vector<double>& filled_s) {
    std::vector<double> minutes;
    for (const double s : filled_s) {
        if (!std::isnan(s)) minutes.push_back(s / kMinute_s);
    }
    if (minutes.empty()) return fmt::format("never in {} runs", filled_s.size());
    std::sort(minutes.begin(), minutes.end());
    return fmt::format("minute {:.0f} ({:.0f} to {:.0f}) in {} of {} runs", minutes[minutes.size() / 2],
                       minutes.front(), minutes.back(), minutes.size(), filled_s.size());
}

// Returns for each seed the time from which all approaches in `columns` are congested, s, or NaN if one of them never
// is. Congestion only on the approach at the entry of the network does not show a backlog, because the signal of this
// approach also causes a queue.
std::vector<double> connected_s(const Measurements& m, Columns columns, const char* population) {
    std::vector<double> since_s = values(m, columns.front(), population);
    for (const char* const column : columns) {
        const std::vector<double> filled_s = values(m, column, population);
        for (std::size_t k = 0; k < since_s.size(); ++k) {
            const bool both = !std::isnan(since_s[k]) && !std::isnan(filled_s[k]);
            since_s[k] = both ? std::max(since_s[k], filled_s[k]) : std::numeric_limits<double>::quiet_NaN();
        }
    }
    return since_s;
}

bool never(const std::vector<double>& filled_s) {
    return std::all_of(filled_s.begin(), filled_s.end(), [](double s) { return std::isnan(s); });
}

// Compares the throughput of the populations SWITCH-1 and CDG for each seed, over both periods of flow() together. The
// claim holds if the 95 % confidence interval of the difference contains 0 and SWITCH-1 never has a backlog at
// Suarezstr.
MaybeAnswer switch_equals_cdg(const Target&, const Measurements& m) {
    std::vector<double> differences;
    const auto add_differences = [&](const char* column, double weight) {
        const std::vector<double> switch_1 = values(m, column, "SWITCH-1");
        const std::vector<double> cdg = values(m, column, "CDG");
        differences.resize(std::min(switch_1.size(), cdg.size()));
        for (std::size_t k = 0; k < differences.size(); ++k)
            differences[k] += weight * (switch_1[k] - cdg[k]) / kMinute_s;
    };
    add_differences("throughput_early_veh_h", 0.45);
    add_differences("throughput_late_veh_h", 0.55);
    const Interval interval = confidence_interval(differences, Band::student);
    const std::vector<double> filled = values(m, "congested_from_suarezstr_east_s", "SWITCH-1");
    const std::vector<double> west = values(m, "congested_from_suarezstr_west_s", "SWITCH-1");
    return claim_answer(
        interval.contains(0.0) && never(filled) && never(west),
        fmt::format("SWITCH-1 minus CDG: {:.1f} veh/min (95 % interval {:.1f} to {:.1f}); backlog at Suarezstr "
                    "from the east: {}, from the west: {}",
                    mean_of(differences), interval.low, interval.high, filled_text(filled), filled_text(west)));
}

MaybeAnswer backlog(const Target&, const Measurements& m) {
    constexpr double kWithin_min = 10.0;
    const auto since = [&](Columns columns, const char* population) {
        return filled_text(connected_s(m, columns, population));
    };
    const std::vector<double> paper_s = connected_s(m, kFromSuarezEast, "CDG");
    const bool holds = !paper_s.empty() && std::all_of(paper_s.begin(), paper_s.end(), [&](double s) {
        return std::abs(s / kMinute_s - 54.0) < kWithin_min;
    });
    return claim_answer(
        holds,
        fmt::format(
            "continuous queue of traffic from the east, Suarezstr to Am Schillertheater: {}; Krumme Str to Am "
            "Schillertheater: {} (CTG-Ref: {}); of traffic from the west, Suarezstr to the inflow: {} (CTG-Ref: {})",
            filled_text(paper_s), since(kFromKrummeEast, "CDG"), since(kFromKrummeEast, "CTG-Ref"),
            since(kFromSuarezWest, "CDG"), since(kFromSuarezWest, "CTG-Ref")));
}

MaybeAnswer times_equal(const Target&, const Measurements& m) {
    constexpr double kAlmost_percent = 15.0;
    double low_s = std::numeric_limits<double>::max();
    double high_s = 0.0;
    std::string text;
    for (const char* const population : {"CTG-Ref", "CDG", "MIX", "SWITCH-1", "SWITCH-2"}) {
        const double time_s = mean(m, "travel_time_early_s", population);
        low_s = std::min(low_s, time_s);
        high_s = std::max(high_s, time_s);
        text += fmt::format("{}{} {:.0f} s", text.empty() ? "" : ", ", population, time_s);
    }
    return claim_answer(100.0 * (high_s / low_s - 1.0) < kAlmost_percent, text);
}

MaybeAnswer time_increase(const Target&, const Measurements& m) {
    return number_answer(100.0 * (mean(m, "travel_time_late_s", "CDG") / mean(m, "travel_time_early_s", "CDG") - 1.0));
}

}  // namespace

std::span<const Experiment> section7_experiments() {
    static const std::array kExperiments{Experiment{kBerlin, "berlin", false, measure_berlin}};
    return kExperiments;
}

std::span<const RowJudge> section7_rows() {
    static const std::array kRows{RowJudge{"B01", kBerlin, ctg_flow},     RowJudge{"B02", kBerlin, cdg_before},
                                  RowJudge{"B03", kBerlin, cdg_after},    RowJudge{"B04", kBerlin, cdg_gain},
                                  RowJudge{"B05", kBerlin, mix_gain},     RowJudge{"B06", kBerlin, switch_equals_cdg},
                                  RowJudge{"B07", kBerlin, backlog},      RowJudge{"B08", kBerlin, times_equal},
                                  RowJudge{"B09", kBerlin, time_increase}};
    return kRows;
}

}  // namespace stopline
