#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "experiment/interval_points.h"
#include "experiment/network.h"
#include "experiment/population_style.h"

namespace stopline {

namespace {

constexpr std::array<const char*, 4> kPanels{"throughput [veh/h]", "travel time [s]", "density [%]", "moved on [veh]"};

// One point of the series.
struct SeriesPoint {
    double hours = 0.0;
    std::array<double, kPanels.size()> values{};  // NaN: nobody left
};

std::vector<SeriesPoint> points_of(const std::vector<NetworkInterval>& series) {
    const std::size_t together = intervals_of_a_point(series.size());
    std::vector<SeriesPoint> points;
    for (std::size_t i = 0; i + together <= series.size(); i += together) {
        double left = 0.0;
        double travel_s = 0.0;
        double occupied = 0.0;
        double moved_on = 0.0;
        for (std::size_t j = i; j < i + together; ++j) {
            left += series[j].area.left;
            travel_s += series[j].area.left > 0 ? series[j].area.left * series[j].area.travel_time_s : 0.0;
            occupied += series[j].area.occupied / static_cast<double>(together);
            moved_on += static_cast<double>(series[j].taken_out);
        }
        const double from_s = series[i].area.window.from_s;
        const double length_s = static_cast<double>(together) * series[i].area.window.length_s();
        points.push_back(
            {(from_s + 0.5 * length_s) / 3600.0,
             {left * 3600.0 / length_s, left > 0.0 ? travel_s / left : std::numeric_limits<double>::quiet_NaN(),
              100.0 * occupied, moved_on}});
    }
    return points;
}

std::string number_or_nan(double value, int decimals) {
    return std::isnan(value) ? "NaN" : fmt::format("{:.{}f}", value, decimals);
}

std::string data_of(const std::vector<SeriesPoint>& points) {
    std::string text = "# hours throughput travel_time density moved_on\n";
    for (const SeriesPoint& point : points) {
        const auto& [throughput, travel_time, density, moved_on] = point.values;
        text += fmt::format("{:.4f} {:.1f} {} {:.3f} {:.0f}\n", point.hours, throughput, number_or_nan(travel_time, 2),
                            density, moved_on);
    }
    return text;
}

// gnuplot finds no range where no value is a number.
std::string range_of(const std::vector<std::vector<SeriesPoint>>& all, std::size_t panel) {
    for (const std::vector<SeriesPoint>& points : all) {
        const auto known = [&](const SeriesPoint& point) { return !std::isnan(point.values[panel]); };
        if (std::any_of(points.begin(), points.end(), known)) return "[0:*]";
    }
    return "[0:1]";
}

// Whose window is grey, where there are others.
std::string window_of(const NetworkReport& report) {
    const auto& all = report.populations;
    const auto other = [&](const NetworkFigures& f) {
        return f.steady.window.from_s != all.front().steady.window.from_s ||
               f.steady.window.to_s != all.front().steady.window.to_s;
    };
    return std::any_of(all.begin(), all.end(), other) ? " with " + all.front().population : "";
}

// The measured window, and when runs break down.
std::string marks_of(const NetworkReport& report) {
    std::string text;
    if (report.populations.empty()) return text;
    const TimeWindow& window = report.populations[0].steady.window;
    if (window.length_s() > 0.0) {
        text += fmt::format(
            "set object 1 rectangle from first {:.4f},graph 0 to first {:.4f},graph 1 behind fc rgb '#f2f2f2' fs solid "
            "noborder\n",
            window.from_s / 3600.0, window.to_s / 3600.0);
    }
    for (const NetworkFigures& f : report.populations) {
        if (!f.collapse_s) continue;
        text += fmt::format(
            "set arrow from first {0:.4f},graph 0 to first {0:.4f},graph 1 nohead lw 1.5 lc rgb '{1}' dt 3\n",
            *f.collapse_s / 3600.0, style_of(report.scenario, f.population).colour);
    }
    return text;
}

}  // namespace

Figure network_series_figure(const NetworkReport& report) {
    constexpr std::size_t kNamedBeside = 9;  // a panel: the others beside the next ones
    Figure figure;
    figure.name = "series";
    figure.width_px = 900;
    figure.height_px = 900;
    std::string body = "set multiplot layout 4,1 margins 0.11,0.83,0.07,0.96 spacing 0.03\nset key outside right top\n";
    const double interval_s = report.scenario.measure.interval_s;
    std::size_t intervals = 0;
    std::size_t drawn = 0;
    std::vector<std::vector<SeriesPoint>> all;  // [population]
    for (const NetworkFigures& f : report.populations) {
        all.push_back(points_of(f.series));
        figure.data.emplace_back(fmt::format("series_{}.dat", all.size() - 1), data_of(all.back()));
        intervals = std::max(intervals, f.series.size());
        drawn = std::max(drawn, all.back().size());
    }
    if (drawn == 0) figure.nothing = no_interval_text(report.scenario);
    body += fmt::format("set xrange [0:{:g}]\n", report.scenario.duration_s / 3600.0) + marks_of(report);
    for (std::size_t panel = 0; panel < kPanels.size(); ++panel) {
        const bool last = panel + 1 == kPanels.size();
        const std::string label = fmt::format("time [h]; grey: measured{}; dotted: breaks down; points: {}{}",
                                              window_of(report), points_text(intervals, interval_s),
                                              intervals_of_a_point(intervals) > 1 ? " (moved on: their sum)" : "");
        body += last ? fmt::format("set xlabel {}\nset format x '%g'\n", gnuplot_text(label))
                     : "unset xlabel\nset format x ''\n";
        body += fmt::format("set ylabel '{}'\nset yrange {}\nplot ", kPanels[panel], range_of(all, panel));
        for (std::size_t k = 0; k < report.populations.size(); ++k) {
            const LineStyle style = style_of(report.scenario, report.populations[k].population);
            const bool named_here = std::min(k / kNamedBeside, kPanels.size() - 1) == panel;
            body += fmt::format("{}'series_{}.dat' using 1:{} with {} lw 2 lc rgb '{}' dt {} {}", k == 0 ? "" : ", ", k,
                                panel + 2, line_of(drawn), style.colour, style.dash,
                                named_here ? "title " + gnuplot_text(report.populations[k].population) : "notitle");
        }
        body += "\n";
    }
    figure.body = body + "unset multiplot\n";
    return figure;
}

namespace {

std::pair<std::vector<std::string>, std::vector<StreetTrace>> streets_of(const NetworkReport& report) {
    std::vector<std::string> names;
    std::vector<StreetTrace> traces;
    for (const NetworkFigures& f : report.populations) {
        names.push_back(f.population);
        traces.push_back(f.street);
    }
    return {names, traces};
}

}  // namespace

Figure street_figure(const NetworkReport& report) {
    const auto [names, traces] = streets_of(report);
    return time_space_figure(report.scenario, names, traces);
}

std::string street_csv(const NetworkReport& report) {
    const auto [names, traces] = streets_of(report);
    return time_space_csv(names, traces);
}

Figure hindrance_figure(const NetworkReport& report) {
    Figure figure;
    figure.name = "hindrance";
    std::string text = "# population, share of vehicle time that is lost by cause\n";
    std::array<bool, kCauseNames.size()> any{};  // [cause] whether it holds up anybody
    for (const NetworkFigures& f : report.populations) {
        double all_s = 0.0;
        for (std::size_t cause = 1; cause < kCauseNames.size(); ++cause) {
            all_s += f.hindrance.lost_s[cause];
            any[cause] = any[cause] || f.hindrance.lost_s[cause] > 0.0;
        }
        text += fmt::format("\"{}\"", f.population);
        for (std::size_t cause = 1; cause < kCauseNames.size(); ++cause) {
            text += fmt::format(" {:.3f}", all_s > 0.0 ? 100.0 * f.hindrance.lost_s[cause] / all_s : 0.0);
        }
        text += "\n";
    }
    figure.data.emplace_back("hindrance.dat", text);
    if (std::none_of(any.begin(), any.end(), [](bool lost) { return lost; })) figure.nothing = "no vehicle stands";
    figure.body =
        "set title 'What standing vehicles wait for'\nset style data histograms\nset style histogram rowstacked\nset style fill "
        "solid 0.9 noborder\nset boxwidth 0.6\nset ylabel 'share of the time that vehicles stand [%]'\nset yrange [0:100]\nset key "
        "outside right\nset xtics scale 0\nplot ";
    std::string before;
    for (std::size_t cause = 1; cause < kCauseNames.size(); ++cause) {
        if (!any[cause]) continue;
        const bool is_start = static_cast<Cause>(cause) == Cause::start;
        const std::string colour = cause == 1 ? "#bbbbbb" : is_start ? "#777777" : line_style(cause - 2).colour;
        std::string label = kCauseNames[cause];
        std::replace(label.begin(), label.end(), '_', ' ');
        figure.body +=
            fmt::format("{}'hindrance.dat' using {}:xtic(1) lc rgb '{}' title '{}'", before, cause + 1, colour, label);
        before = ", ";
    }
    figure.body += "\n";
    return figure;
}

}  // namespace stopline
