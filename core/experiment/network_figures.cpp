#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "experiment/network.h"

namespace stopline {

Figure network_series_figure(const NetworkReport& report) {
    Figure figure;
    figure.name = "series";
    figure.width_px = 900;
    figure.height_px = 900;
    std::string body = "set multiplot layout 4,1 margins 0.11,0.83,0.07,0.96 spacing 0.03\nset key outside right top\n";
    const std::array<const char*, 4> labels{"throughput [veh/h]", "travel time [s]", "density [%]", "moved on"};
    for (std::size_t k = 0; k < report.populations.size(); ++k) {
        std::string text = "# hours throughput travel_time density moved_on, means of five intervals\n";
        const std::vector<NetworkInterval>& series = report.populations[k].series;
        constexpr std::size_t kTogether = 5;
        for (std::size_t i = 0; i + kTogether <= series.size(); i += kTogether) {
            double left = 0.0;
            double travel_s = 0.0;
            double occupied = 0.0;
            double moved_on = 0.0;
            for (std::size_t j = i; j < i + kTogether; ++j) {
                left += series[j].area.left;
                travel_s += series[j].area.left > 0 ? series[j].area.left * series[j].area.travel_time_s : 0.0;
                occupied += series[j].area.occupied / kTogether;
                moved_on += static_cast<double>(series[j].taken_out);
            }
            const double from_s = series[i].area.window.from_s;
            const double length_s = kTogether * series[i].area.window.length_s();
            text += fmt::format("{:.4f} {:.1f} {} {:.3f} {:.0f}\n", (from_s + 0.5 * length_s) / 3600.0,
                                left * 3600.0 / length_s, left > 0.0 ? fmt::format("{:.2f}", travel_s / left) : "NaN",
                                100.0 * occupied, moved_on);
        }
        if (series.size() < kTogether) text += "NaN NaN NaN NaN NaN\n";
        figure.data.emplace_back(fmt::format("series_{}.dat", k), text);
    }
    for (std::size_t panel = 0; panel < labels.size(); ++panel) {
        const bool last = panel + 1 == labels.size();
        body += last ? "set xlabel 'hours'\nset format x '%g'\n" : "unset xlabel\nset format x ''\n";
        body +=
            fmt::format("set ylabel '{}'\nset yrange [0:*]\n{}plot ", labels[panel], panel == 0 ? "" : "unset key\n");
        for (std::size_t k = 0; k < report.populations.size(); ++k) {
            const LineStyle style = line_style(k);
            body += fmt::format("{}'series_{}.dat' using 1:{} with lines lw 2 lc rgb '{}' dt {} title {}",
                                k == 0 ? "" : ", ", k, panel + 2, style.colour, style.dash,
                                gnuplot_text(report.populations[k].population));
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
    return time_space_figure(names, traces);
}

std::string street_csv(const NetworkReport& report) {
    const auto [names, traces] = streets_of(report);
    return time_space_csv(names, traces);
}

Figure hindrance_figure(const NetworkReport& report) {
    Figure figure;
    figure.name = "hindrance";
    std::string text = "# population, share of vehicle time that is lost by cause\n";
    for (const NetworkFigures& f : report.populations) {
        double all_s = 0.0;
        for (std::size_t cause = 1; cause < kCauseNames.size(); ++cause) all_s += f.hindrance.lost_s[cause];
        text += fmt::format("\"{}\"", f.population);
        for (std::size_t cause = 1; cause < kCauseNames.size(); ++cause) {
            text += fmt::format(" {:.3f}", all_s > 0.0 ? 100.0 * f.hindrance.lost_s[cause] / all_s : 0.0);
        }
        text += "\n";
    }
    figure.data.emplace_back("hindrance.dat", text);
    figure.body =
        "set title 'What standing vehicles wait for'\nset style data histograms\nset style histogram rowstacked\nset style fill "
        "solid 0.9\nset boxwidth 0.6\nset ylabel 'share of the time that vehicles stand [%]'\nset yrange [0:100]\nset key "
        "outside right\nset xtics scale 0\nplot ";
    for (std::size_t cause = 1; cause < kCauseNames.size(); ++cause) {
        std::string label = kCauseNames[cause];
        std::replace(label.begin(), label.end(), '_', ' ');
        figure.body += fmt::format("{}'hindrance.dat' using {}:xtic(1) lc rgb '{}' title '{}'", cause == 1 ? "" : ", ",
                                   cause + 1, cause == 1 ? "#bbbbbb" : line_style(cause - 2).colour, label);
    }
    figure.body += "\n";
    return figure;
}

}  // namespace stopline
