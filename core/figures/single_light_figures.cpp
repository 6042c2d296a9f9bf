// Figures over the green time: counters and improvement. The figures of trajectories are in platoon_figures.cpp.
#include "figures/single_light_figures.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "figures/population_style.h"

namespace stopline {

namespace {

// Returns the time at which the curves end: 5 s after the longest reported green time (measure.green), but not after
// the end of green.
double curves_end_s(const SingleLightReport& result) {
    const std::vector<double>& green_s = result.scenario.measure.green_s;
    const double signal_s = result.scenario.signal.green_s;
    if (green_s.empty()) return signal_s;
    return std::min(signal_s, *std::max_element(green_s.begin(), green_s.end()) + 5.0);
}

// Returns the commands for a tick and a vertical line at each reported green time.
std::string green_lines(const SingleLightReport& result) {
    std::string ticks = "set xtics (0";
    std::string lines;
    for (const double green_s : result.scenario.measure.green_s) {
        ticks += fmt::format(", {:.6g}", green_s);
        lines += fmt::format(
            "set arrow from first {0:.6g}, graph 0 to first {0:.6g}, graph 1 nohead back lc rgb '#a0a0a0' lw 1 dt 2\n",
            green_s);
    }
    return "set grid noxtics ytics\n" + ticks + ")\n" + lines;
}

// Returns the populations from the highest curve to the lowest. The legend has the same order.
std::vector<std::size_t> by_count(const SingleLightReport& result) {
    std::vector<std::size_t> order(result.populations.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const double end_s = curves_end_s(result);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return result.populations[a].counter.interpolated(end_s) > result.populations[b].counter.interpolated(end_s);
    });
    return order;
}

// A value of the paper for a population at a green time.
struct PaperPoint {
    std::size_t population;
    double green_s;
    double value;
};

std::vector<PaperPoint> paper_points(const SingleLightReport& result, const std::vector<Target>& targets,
                                     const std::string& quantity) {
    std::vector<PaperPoint> points;
    for (const Target& target : targets) {
        if (target.scenario != result.scenario.name || target.quantity != quantity) continue;
        const std::optional<GreenCondition> condition = parse_green_condition(target.condition);
        const std::optional<double> value = parse_number(target.value);
        const PopulationSummary* const summary = condition ? result.find(condition->population) : nullptr;
        if (summary == nullptr || !value) continue;
        const auto population = static_cast<std::size_t>(summary - result.populations.data());
        points.push_back({population, condition->green_s, *value});
    }
    return points;
}

std::string paper_data(const std::vector<PaperPoint>& points) {
    std::string text = "# green_s value, one block for each point\n";
    for (const PaperPoint& point : points) text += fmt::format("{:.6g} {:.6g}\n\n\n", point.green_s, point.value);
    return text;
}

// Returns the commands that plot points of the paper in the colours of their curves, with one common legend entry.
std::string plot_paper(const SingleLightReport& result, const std::vector<PaperPoint>& points, const std::string& file,
                       const std::string& legend) {
    std::string text;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const LineStyle style = line_style(style_index(result, points[k].population));
        text += fmt::format(", \\\n '{}' index {} using 1:2 with points pt {} ps 1.1 lw 2 lc rgb '{}' notitle", file, k,
                            style.hollow_point, style.colour);
    }
    if (!points.empty())
        text += ", \\\n NaN with points pt 6 ps 1.1 lw 2 lc rgb '#404040' title " + gnuplot_text(legend);
    return text;
}

std::string counter_data(const SingleLightReport& result, const std::vector<std::size_t>& order, double end_s) {
    std::string text = "# time_s passed_veh, one block for each population\n";
    for (const std::size_t k : order) {
        const Counter& counter = result.populations[k].counter;
        text += fmt::format("# {}\n0 0\n", result.populations[k].name);
        for (const double time_s : counter.times_s()) {
            if (time_s <= end_s) text += fmt::format("{:.4f} {}\n", time_s, counter.passed(time_s));
        }
        text += fmt::format("{:.4f} {}\n\n\n", end_s, counter.passed(end_s));
    }
    return text;
}

// Returns the time at which the improvement curves begin: when the second vehicle of the baseline passes the stop line,
// or the end of green if fewer than two vehicles pass. Earlier counts are too small for a meaningful ratio.
double first_ratio_s(const SingleLightReport& result) {
    const Counter& baseline = result.populations[*result.baseline].counter;
    return baseline.total() < 2 ? result.scenario.signal.green_s : baseline.times_s()[1];
}

double last_ratio_s(const SingleLightReport& result, const PopulationSummary& summary) {
    const double end_s = curves_end_s(result);
    return std::isnan(summary.emptied_s) ? end_s : std::min(end_s, summary.emptied_s);
}

bool has_improvement(const SingleLightReport& result) {
    if (!result.baseline || result.populations.size() < 2) return false;
    return std::any_of(result.populations.begin(), result.populations.end(), [&](const PopulationSummary& summary) {
        return last_ratio_s(result, summary) > first_ratio_s(result) + 0.2;
    });
}

std::string improvement_data(const SingleLightReport& result, const std::vector<std::size_t>& order) {
    constexpr double kStep_s = 0.1;
    const Counter& baseline = result.populations[*result.baseline].counter;
    const double begin_s = first_ratio_s(result);
    std::string text = "# time_s improvement_percent, one block for each population\n";
    for (const std::size_t k : order) {
        const PopulationSummary& summary = result.populations[k];
        text += fmt::format("# {}\n", summary.name);
        for (int i = 0; begin_s + i * kStep_s <= last_ratio_s(result, summary); ++i) {
            const double time_s = begin_s + i * kStep_s;
            const double percent =
                improvement_percent(summary.counter.interpolated(time_s), baseline.interpolated(time_s));
            text += fmt::format("{:.3f} {}\n", time_s, fixed(percent, 2));
        }
        text += "\n\n";
    }
    return text;
}

// Returns the improvements computed from whole vehicle counts, one value for each reported green time. A value is NaN
// if the whole queue of the population passes the stop line within a shorter time, or if the improvement is not a
// finite number.
std::string whole_count_data(const SingleLightReport& result, const std::vector<std::size_t>& order) {
    std::string text = "# green_s improvement_percent, one block for each population\n";
    for (const std::size_t k : order) {
        const PopulationSummary& summary = result.populations[k];
        for (std::size_t i = 0; i < summary.improvement_percent.size(); ++i) {
            const double green_s = result.scenario.measure.green_s[i];
            const bool shown =
                green_s <= last_ratio_s(result, summary) && std::isfinite(summary.improvement_percent[i]);
            text += fmt::format("{:.6g} {}\n", green_s, shown ? fixed(summary.improvement_percent[i], 2) : "NaN");
        }
        text += "\n\n";
    }
    return text;
}

std::string plot_whole_counts(const SingleLightReport& result, const std::vector<std::size_t>& order,
                              const std::string& file) {
    constexpr int kFilledCircle = 7;
    std::string text;
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (order[k] == *result.baseline) continue;
        text += fmt::format(", \\\n '{}' index {} using 1:2 with points pt {} ps 0.7 lc rgb '{}' notitle", file, k,
                            kFilledCircle, line_style(style_index(result, order[k])).colour);
    }
    return text + fmt::format(", \\\n NaN with points pt {} ps 0.7 lc rgb '#404040' title 'from whole vehicles'",
                              kFilledCircle);
}

std::string plot_curves(const SingleLightReport& result, const std::vector<std::size_t>& order, const std::string& file,
                        const std::string& how) {
    std::string text = "plot";
    for (std::size_t k = 0; k < order.size(); ++k) {
        text += fmt::format("{} '{}' index {} using 1:2 with {} lt {} lw {} title {}", k == 0 ? "" : ", \\\n", file, k,
                            how, style_index(result, order[k]) + 1, order[k] == result.baseline ? "2.6" : "1.8",
                            gnuplot_text(result.populations[order[k]].name));
    }
    return text;
}

}  // namespace

Figure counters_figure(const SingleLightReport& result, const std::vector<Target>& targets) {
    const double end_s = curves_end_s(result);
    const std::vector<std::size_t> order = by_count(result);
    const std::vector<PaperPoint> paper = paper_points(result, targets, "vehicles_passed");
    Figure figure;
    figure.name = "counters";
    figure.data = {{"counters.dat", counter_data(result, order, end_s)}, {"counters_paper.dat", paper_data(paper)}};
    figure.body =
        "set title 'Vehicles past the stop line' font ',15'\nset xlabel 'time since the start of green [s]; vertical lines: reported green times'\n"
        "set ylabel 'vehicles past the stop line'\nset key outside right top\n" +
        green_lines(result) + fmt::format("set xrange [0:{:.6g}]\nset yrange [0:*]\n", end_s) +
        plot_curves(result, order, "counters.dat", "steps") +
        plot_paper(result, paper, "counters_paper.dat", "paper (Fig. 5)") + "\n";
    return figure;
}

Figure improvement_figure(const SingleLightReport& result, const std::vector<Target>& targets) {
    const double end_s = curves_end_s(result);
    const std::vector<std::size_t> order = by_count(result);
    const std::vector<PaperPoint> paper = paper_points(result, targets, "improvement_over_ctg_ref");
    const std::string& baseline = result.populations[*result.baseline].name;
    Figure figure;
    figure.name = "improvement";
    figure.data = {{"improvement.dat", improvement_data(result, order)},
                   {"improvement_counts.dat", whole_count_data(result, order)},
                   {"improvement_paper.dat", paper_data(paper)}};
    figure.body = fmt::format("set title {} font ',15'\n", gnuplot_text("Throughput gain over " + baseline)) +
                  "set xlabel 'green time [s]; curves: counters interpolated between vehicles'\n" +
                  fmt::format("set ylabel {}\n", gnuplot_text("throughput gain over " + baseline + " [%]")) +
                  "set key outside right top\n" + green_lines(result) +
                  fmt::format("set xrange [0:{:.6g}]\nset yrange [*:*]\n", end_s) +
                  plot_curves(result, order, "improvement.dat", "lines") +
                  plot_whole_counts(result, order, "improvement_counts.dat") +
                  plot_paper(result, paper, "improvement_paper.dat", "paper (Fig. 6)") + "\n";
    return figure;
}

std::size_t style_index(const SingleLightReport& result, std::size_t population) {
    return style_index(styled_names(result.scenario), result.populations[population].name);
}

std::vector<Figure> single_light_figures(const SingleLightReport& result, const std::vector<Target>& targets) {
    std::vector<Figure> figures{counters_figure(result, targets)};
    if (has_improvement(result)) figures.push_back(improvement_figure(result, targets));
    figures.push_back(time_space_figure(result));
    figures.push_back(platoon_figure(result));
    return figures;
}

}  // namespace stopline
