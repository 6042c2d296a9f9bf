#include "figures/network_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "figures/interval_points.h"
#include "figures/population_style.h"
#include "runs/metrics/metric_groups.h"

namespace stopline {

namespace {

// The metrics of the panels.
constexpr std::array kPanels{"throughput_veh_h", "travel_time_s", "density_percent", "teleported"};

// One point of the curves of a population.
struct SeriesPoint {
    double minutes = 0.0;
    std::array<double, kPanels.size()> values{};  // [panel] the travel time is NaN if no vehicle left the area
};

std::vector<SeriesPoint> points_of(const std::vector<NetworkInterval>& series) {
    const std::size_t group = intervals_per_point(series.size());
    std::vector<SeriesPoint> points;
    for (std::size_t i = 0; i + group <= series.size(); i += group) {
        double exited = 0.0;
        double travel_s = 0.0;
        double occupied = 0.0;
        double teleported = 0.0;
        for (std::size_t j = i; j < i + group; ++j) {
            exited += series[j].area.exited;
            travel_s += series[j].area.exited > 0 ? series[j].area.exited * series[j].area.travel_time_s : 0.0;
            occupied += series[j].area.occupied / static_cast<double>(group);
            teleported += static_cast<double>(series[j].teleported);
        }
        const double from_s = series[i].area.window.from_s;
        const double length_s = static_cast<double>(group) * series[i].area.window.length_s();
        points.push_back(
            {(from_s + 0.5 * length_s) / 60.0,
             {exited * 3600.0 / length_s, exited > 0.0 ? travel_s / exited : std::numeric_limits<double>::quiet_NaN(),
              100.0 * occupied, teleported}});
    }
    return points;
}

std::string number_or_nan(double value, int decimals) {
    return std::isnan(value) ? "NaN" : fmt::format("{:.{}f}", value, decimals);
}

std::string data_of(const std::vector<SeriesPoint>& points) {
    std::string text = "# minutes throughput travel_time density teleported\n";
    for (const SeriesPoint& point : points) {
        const auto& [throughput, travel_time, density, teleported] = point.values;
        text += fmt::format("{:.3f} {:.1f} {} {:.3f} {:.0f}\n", point.minutes, throughput,
                            number_or_nan(travel_time, 2), density, teleported);
    }
    return text;
}

// Returns the y range of a panel. gnuplot needs an explicit range if no value is a number.
std::string range_of(const std::vector<std::vector<SeriesPoint>>& all, std::size_t panel) {
    for (const std::vector<SeriesPoint>& points : all) {
        const auto has_value = [&](const SeriesPoint& point) { return !std::isnan(point.values[panel]); };
        if (std::any_of(points.begin(), points.end(), has_value)) return "[0:*]";
    }
    return "[0:1]";
}

// Returns " of NAME", where NAME is the population whose measured window is shaded. Returns "" if all populations have
// the same window.
std::string window_owner(const NetworkReport& report) {
    const auto& all = report.populations;
    const auto other = [&](const NetworkResult& f) {
        return f.measured.window.from_s != all.front().measured.window.from_s ||
               f.measured.window.to_s != all.front().measured.window.to_s;
    };
    return std::any_of(all.begin(), all.end(), other) ? " of " + all.front().population : "";
}

// Returns the commands that shade the measured window and mark the breakdowns, which are the times at which runs become
// unstable.
std::string marks_of(const NetworkReport& report) {
    std::string text;
    if (report.populations.empty()) return text;
    const TimeWindow& window = report.populations[0].measured.window;
    if (window.length_s() > 0.0) {
        text += fmt::format(
            "set object 1 rectangle from first {:.4f},graph 0 to first {:.4f},graph 1 behind fc rgb '#f2f2f2' fs solid "
            "noborder\n",
            window.from_s / 60.0, window.to_s / 60.0);
    }
    for (const NetworkResult& f : report.populations) {
        if (!f.collapse_s) continue;
        text += fmt::format(
            "set arrow from first {0:.4f},graph 0 to first {0:.4f},graph 1 nohead lw 1.5 lc rgb '{1}' dt 3\n",
            *f.collapse_s / 60.0, style_of(report.scenario, f.population).colour);
    }
    return text;
}

}  // namespace

Figure network_series_figure(const NetworkReport& report) {
    // Number of populations that the legend beside one panel names. The legends of the next panels name the others.
    constexpr std::size_t kNamesPerPanel = 9;
    Figure figure;
    figure.name = "series";
    figure.width_px = 900;
    figure.height_px = 900;
    std::string body = "set multiplot layout 4,1 margins 0.11,0.83,0.09,0.98 spacing 0.03\nset key outside right top\n";
    const double interval_s = report.scenario.measure.interval_s;
    std::size_t intervals = 0;
    std::size_t drawn = 0;
    std::vector<std::vector<SeriesPoint>> all;  // [population]
    for (const NetworkResult& f : report.populations) {
        all.push_back(points_of(f.series));
        figure.data.emplace_back(fmt::format("series_{}.dat", all.size() - 1), data_of(all.back()));
        intervals = std::max(intervals, f.series.size());
        drawn = std::max(drawn, all.back().size());
    }
    if (drawn == 0) figure.nothing = no_interval_text(report.scenario);
    body += fmt::format("set xrange [0:{:g}]\n", report.scenario.duration_s / 60.0) + marks_of(report);
    for (std::size_t panel = 0; panel < kPanels.size(); ++panel) {
        const bool last = panel + 1 == kPanels.size();
        const std::string note = fmt::format("Shaded: measured window{}. Dotted: breakdown. Points: {}{}.",
                                             window_owner(report), points_text(intervals, interval_s),
                                             intervals_per_point(intervals) > 1 ? " (teleported: sums)" : "");
        body += last ? fmt::format(
                           "set xlabel 'time [min]'\nset format x '%g'\n"
                           "set label {} at screen 0.47,0.015 center font ',11' tc rgb '#404040'\n",
                           gnuplot_text(note))
                     : "unset xlabel\nset format x ''\n";
        body += fmt::format("set ylabel {}\nset yrange {}\nplot ", gnuplot_text(axis_title(kPanels[panel])),
                            range_of(all, panel));
        for (std::size_t k = 0; k < report.populations.size(); ++k) {
            const LineStyle style = style_of(report.scenario, report.populations[k].population);
            const bool named_here = std::min(k / kNamesPerPanel, kPanels.size() - 1) == panel;
            body += fmt::format("{}'series_{}.dat' using 1:{} with {} lw 2 lc rgb '{}' dt {} {}", k == 0 ? "" : ", ", k,
                                panel + 2, curve_style(drawn), style.colour, style.dash,
                                named_here ? "title " + gnuplot_text(report.populations[k].population) : "notitle");
        }
        body += "\n";
    }
    figure.body = body + "unset multiplot\n";
    return figure;
}

Figure delay_causes_figure(const NetworkReport& report) {
    Figure figure;
    figure.name = "delay_causes";
    std::string text = "# population, share of each cause in the stopped time, percent\n";
    std::array<bool, kDelayCauseNames.size()> any{};  // [cause] true if this cause stops a vehicle
    for (const NetworkResult& f : report.populations) {
        double all_s = 0.0;
        for (std::size_t cause = 1; cause < kDelayCauseNames.size(); ++cause) {
            all_s += f.delays.delay_s[cause];
            any[cause] = any[cause] || f.delays.delay_s[cause] > 0.0;
        }
        text += fmt::format("\"{}\"", f.population);
        for (std::size_t cause = 1; cause < kDelayCauseNames.size(); ++cause) {
            text += fmt::format(" {:.3f}", all_s > 0.0 ? 100.0 * f.delays.delay_s[cause] / all_s : 0.0);
        }
        text += "\n";
    }
    figure.data.emplace_back("delay_causes.dat", text);
    if (std::none_of(any.begin(), any.end(), [](bool lost) { return lost; })) figure.nothing = "no vehicle stops";
    figure.body =
        "set title 'Causes of the delay of stopped vehicles'\nset style data histograms\nset style histogram rowstacked\nset style fill "
        "solid 0.9 noborder\nset boxwidth 0.6\nset ylabel 'share of the stopped time [%]'\nset yrange [0:100]\nset key "
        "outside right\nset xtics scale 0\nplot ";
    std::string before;
    for (std::size_t cause = 1; cause < kDelayCauseNames.size(); ++cause) {
        if (!any[cause]) continue;
        const bool is_start = static_cast<DelayCause>(cause) == DelayCause::queue_discharge;
        const std::string colour = cause == 1 ? "#bbbbbb" : is_start ? "#777777" : line_style(cause - 2).colour;
        std::string label = kDelayCauseNames[cause];
        std::replace(label.begin(), label.end(), '_', ' ');
        figure.body += fmt::format("{}'delay_causes.dat' using {}:xtic(1) lc rgb '{}' title '{}'", before, cause + 1,
                                   colour, label);
        before = ", ";
    }
    figure.body += "\n";
    return figure;
}

}  // namespace stopline
