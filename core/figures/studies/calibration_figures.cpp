#include "figures/studies/calibration_figures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/io/csv.h"
#include "runs/metrics/metric_groups.h"

namespace stopline {

namespace {

// Quotes text for a legend. It needs no escapes, because the legends here are not in gnuplot's enhanced mode.
std::string legend_text(const std::string& text) { return "'" + text + "'"; }

// Highest number of detectors in a figure of cumulative vehicle counts. Each detector has its own colour, and a reader
// cannot distinguish more colours.
constexpr std::size_t kMaxLines = 8;

// Returns the kMaxLines detectors with the most passages.
std::vector<int> busiest_detectors(const PairedTimes& pairs) {
    std::map<int, int> count;
    for (const PassagePair& pair : pairs.pairs) ++count[pair.detector];
    std::vector<int> detectors;
    for (const auto& [detector, passages] : count) detectors.push_back(detector);
    std::stable_sort(detectors.begin(), detectors.end(), [&](int a, int b) { return count[a] > count[b]; });
    detectors.resize(std::min(detectors.size(), kMaxLines));
    std::sort(detectors.begin(), detectors.end());
    return detectors;
}

Figure counters(const std::string& name, const std::string& what, const PairedTimes& pairs, const CalibrationCase& c) {
    Figure figure;
    figure.name = name;
    figure.width_px = 1100;
    figure.height_px = 620;
    figure.body = fmt::format(
        "set title {}\nset xlabel 'time [s]'\nset ylabel 'vehicles passed'\nset key outside right\nplot \\\n",
        gnuplot_text(fmt::format("{} permutation: {}", what, c.permutation)));
    const std::vector<int> detectors = busiest_detectors(pairs);
    for (std::size_t k = 0; k < detectors.size(); ++k) {
        CsvWriter csv({"passage", "full_s", "meso_s"});
        for (const PassagePair& pair : pairs.pairs) {
            if (pair.detector != detectors[k]) continue;
            csv.row({fmt::format("{}", pair.k + 1), fixed(pair.reference_s, 3), fixed(pair.other_s, 3)});
        }
        const std::string file = fmt::format("{}_{}.csv", name, k + 1);
        figure.data.emplace_back(file, csv.text());
        const std::string colour = line_style(k).colour;
        figure.body += fmt::format(
            "  '{0}' using 2:1 with steps dt {4} lw 2 lc rgb '{1}' title {2}, \\\n"
            "  '{0}' using 3:1 with points pt 6 ps 0.6 lc rgb '{1}' notitle{3}\n",
            file, colour, legend_text(detector_name(c.fit.model, at(detectors[k]))),
            k + 1 < detectors.size() ? ", \\" : "", line_style(k).dash);
    }
    figure.body = "set datafile separator ','\nset datafile columnheaders\n" + figure.body;
    return figure;
}

// Draws a histogram of the differences between passage times, in bins of 0.1 s. The first bin also contains all smaller
// differences, and the last bin all larger differences.
Figure histogram(const std::vector<TimingResult>& results) {
    constexpr int kZeroBin = 20;
    constexpr int kBins = 2 * kZeroBin + 1;
    constexpr double kBin_s = 0.1;
    Figure figure;
    figure.name = "differences";
    figure.body =
        "set datafile separator ','\nset datafile columnheaders\nset xlabel 'passage time, mesoscale mode minus "
        "full dynamics [s]; the outer bins hold all larger differences'\nset ylabel 'share of the passages [%]'\nset xrange "
        "[-2.1:2.1]\nset yrange [0:*]\nset key top left\nplot \\\n";
    for (std::size_t r = 0; r < results.size(); ++r) {
        std::vector<double> count(kBins, 0.0);
        double all = 0.0;
        for (const PairedTimes& times : results[r].pairs) {
            for (const PassagePair& pair : times.pairs) {
                const int bin = static_cast<int>(std::lround(pair.difference_s() / kBin_s)) + kZeroBin;
                count[at(std::clamp(bin, 0, kBins - 1))] += 1.0;
                all += 1.0;
            }
        }
        CsvWriter csv({"difference_s", "share_percent"});
        for (int bin = 0; bin < kBins; ++bin) {
            csv.row({fixed((bin - kZeroBin) * kBin_s, 1), fixed(100.0 * count[at(bin)] / std::max(all, 1.0), 3)});
        }
        const std::string file = fmt::format("differences_{}.csv", results[r].name);
        figure.data.emplace_back(file, csv.text());
        figure.body += fmt::format("  '{}' using 1:2 with histeps dt {} lw 2 lc rgb '{}' title {}{}\n", file, r + 1,
                                   line_style(r == 0 ? 6 : 0).colour, legend_text(results[r].name),
                                   r + 1 < results.size() ? ", \\" : "");
    }
    return figure;
}

Figure fit_history(const std::vector<FitEvaluation>& history) {
    Figure figure;
    figure.name = "fit_history";
    figure.body =
        "set datafile separator ','\nset datafile columnheaders\nset xlabel 'evaluation'\n"
        "set ylabel 'loss (0: all passages agree, 1: all differ widely)'\nset yrange [0:*]\nset key top right\nplot \\\n";
    std::vector<std::string> stages;
    for (const FitEvaluation& e : history) {
        if (stages.empty() || stages.back() != e.stage) stages.push_back(e.stage);
    }
    for (std::size_t s = 0; s < stages.size(); ++s) {
        CsvWriter csv({"evaluation", "loss", "best"});
        double best = 1e9;
        for (std::size_t k = 0; k < history.size(); ++k) {
            if (history[k].stage != stages[s]) continue;
            best = std::min(best, history[k].loss);
            csv.row({fmt::format("{}", k + 1), fixed(history[k].loss, 5), fixed(best, 5)});
        }
        const std::string file = fmt::format("fit_history_{}.csv", s + 1);
        figure.data.emplace_back(file, csv.text());
        figure.body += fmt::format(
            "  '{0}' using 1:2 with points pt 7 ps 0.15 lc rgb '{1}' notitle, \\\n  '{0}' using 1:3 with steps dt 1 lw 2 lc rgb '{1}' title "
            "{2}{3}\n",
            file, line_style(s).colour, legend_text(stages[s]), s + 1 < stages.size() ? ", \\" : "");
    }
    return figure;
}

}  // namespace

std::vector<Figure> timing_figures(const std::vector<TimingResult>& results, const std::vector<CalibrationCase>& cases,
                                   const std::vector<FitEvaluation>& history) {
    std::vector<Figure> figures;
    const TimingResult& last = results.back();
    std::vector<std::size_t> order(cases.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto share_within = [&](std::size_t k) {
        const PermutationPairs own{&last.pairs[k], cases[k].cycle_s};
        return agreement({&own, 1}, kTimingLimit_s).within_share;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return share_within(a) < share_within(b); });
    const std::size_t middle = order[order.size() / 2];
    figures.push_back(counters("counters_median", "Median", last.pairs[middle], cases[middle]));
    figures.push_back(counters("counters_worst", "Worst", last.pairs[order.front()], cases[order.front()]));
    figures.push_back(histogram(results));
    if (!history.empty()) figures.push_back(fit_history(history));
    return figures;
}

std::vector<Figure> band_figures(const BandCheck& check) {
    std::vector<Figure> figures;
    for (const MetricBands& metric : check.metrics) {
        Figure figure;
        figure.name = "bands_" + metric.metric;
        figure.width_px = 1400;
        std::vector<const BandPoint*> points;
        for (const BandPoint& point : metric.points) points.push_back(&point);
        std::stable_sort(points.begin(), points.end(),
                         [](const BandPoint* a, const BandPoint* b) { return a->full_mean < b->full_mean; });
        CsvWriter csv({"rank", "full_mean", "meso_mean", "paper_low", "paper_high", "student_low", "student_high"});
        for (std::size_t k = 0; k < points.size(); ++k) {
            const BandPoint& p = *points[k];
            csv.row({fmt::format("{}", k + 1), fixed(p.full_mean, 4), fixed(p.meso_mean, 4), fixed(p.paper.low, 4),
                     fixed(p.paper.high, 4), fixed(p.student.low, 4), fixed(p.student.high, 4)});
        }
        const std::string file = figure.name + ".csv";
        figure.data.emplace_back(file, csv.text());
        figure.height_px = 900;
        figure.body = fmt::format(
            "set datafile separator ','\nset datafile columnheaders\nset multiplot layout 2,1\nset rmargin 4\nset ylabel {1}\nset key top left\n"
            "plot '{0}' using 1:4:5 with filledcurves lc rgb '#c6dbef' title '95 % band of full dynamics, equation (2)', \\\n"
            "  '{0}' using 1:6:7 with filledcurves lc rgb '#6baed6' dt 1 title '95 % band of full dynamics, Student', \\\n"
            "  '{0}' using 1:3 with points pt 7 ps 0.4 lc rgb '#d55e00' title 'mean of the mesoscale mode'\n"
            "set xlabel 'permutations, ordered by the mean of full dynamics'\nunset key\n"
            "set ylabel 'difference from the mean of full dynamics [%]'\n"
            "plot '{0}' using 1:(100*$4/$2-100):(100*$5/$2-100) with filledcurves lc rgb '#c6dbef', \\\n"
            "  '{0}' using 1:(100*$6/$2-100):(100*$7/$2-100) with filledcurves lc rgb '#6baed6', \\\n"
            "  '{0}' using 1:(100*$3/$2-100) with points pt 7 ps 0.4 lc rgb '#d55e00'\nunset multiplot\n",
            file, gnuplot_text(axis_title(metric.metric)));
        figures.push_back(std::move(figure));
    }
    return figures;
}

}  // namespace stopline
