#include "calibrate/calibration_text.h"

#include <utility>

#include <fmt/format.h>

#include "common/text_table.h"

namespace stopline {

namespace {

std::string percent(double share) { return fmt::format("{:.1f} %", 100.0 * share); }

}  // namespace

std::string timing_text(const std::vector<TimingResult>& results, const std::vector<CalibrationCase>& cases,
                        const AcceptedFile& accepted) {
    TextTable table("llr");
    table.add_row({"parameters", "permutations", "pairs", "within 1 s", "or accepted", "median", "95th percentile",
                   "other green", "unpaired"});
    for (const TimingResult& result : results) {
        const std::vector<TimingMiss> misses = timing_misses(result, cases, accepted);
        for (const auto& [chosen, name] :
             {std::pair{CaseSubset::fitted, "in the fit"}, {CaseSubset::held_out, "held out"}}) {
            const Agreement a = timing_agreement(result, cases, chosen);
            table.add_row({result.name, name, fmt::format("{}", a.pairs), percent(a.within_share),
                           percent(valid_share(result, cases, misses, chosen)), fmt::format("{:.2f} s", a.median_s),
                           fmt::format("{:.2f} s", a.p95_s), fmt::format("{}", a.other_green),
                           fmt::format("{}", a.unpaired)});
        }
    }
    return fmt::format(
        "\nStep I: time difference of the k-th passage at a detector between the two fidelities (limit {} s)\n{}",
        kTimingLimit_s, table.text());
}

std::string parameters_text(const std::vector<TimingResult>& results) {
    TextTable table("lr");
    std::vector<std::string> head{"parameter"};
    for (const TimingResult& result : results) head.push_back(result.name);
    table.add_row(head);
    for (const FitParameter& p : fit_parameters()) {
        std::vector<std::string> row{fmt::format("{} {}", p.name, p.unit)};
        for (const TimingResult& result : results) {
            MesoSettings settings = result.settings;
            row.push_back(fmt::format("{:.3f}", p.value(settings)));
        }
        table.add_row(row);
    }
    return fmt::format("\n{}", table.text());
}

std::string bands_text(const std::string& name, const BandCheck& check) {
    TextTable table("lr");
    table.add_row(
        {name, "in paper band", "in Student band", "mean |difference|", "mean difference", "band half width"});
    for (const MetricBands& metric : check.metrics) {
        table.add_row({metric.metric, percent(metric.share_inside(Band::paper)),
                       percent(metric.share_inside(Band::student)), percent(metric.mean_relative_difference()),
                       percent(metric.mean_relative_bias()), percent(metric.median_relative_half_width())});
    }
    table.add_row({"all metrics", percent(check.share_inside(Band::paper)), percent(check.share_inside(Band::student)),
                   "", "", ""});
    return fmt::format("\n{}", table.text());
}

}  // namespace stopline
