#include "figures/string_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "figures/population_style.h"

namespace stopline {

namespace {

constexpr double kMillisecondsPerSecond = 1e3;

std::string gain_data(const StringReport& report) {
    std::string text = "# frequency_radps gain gain_linear, one block for each population\n";
    for (const StringResult& result : report.populations) {
        for (const SwingResult& swing : result.swings) {
            text +=
                fmt::format("{:.5f} {:.5f} {:.5f}\n", swing.frequency_radps, swing.measured.mean, swing.linear_gain);
        }
        text += "\n\n";
    }
    return text;
}

// The curve of the linear model at more frequencies than those of the swings.
std::string linear_data(const StringReport& report) {
    constexpr int kPoints = 300;
    std::string text = "# frequency_radps gain_linear, one block for each population\n";
    for (const StringResult& result : report.populations) {
        text += "0.1 NaN\n";
        if (result.model) {
            const Follower follower(*result.model);
            for (int k = 0; k <= kPoints; ++k) {
                const double frequency_radps = 0.1 * std::pow(100.0, static_cast<double>(k) / kPoints);
                text += fmt::format("{:.5f} {:.5f}\n", frequency_radps,
                                    std::abs(follower.response(frequency_radps).to_leader));
            }
        }
        text += "\n\n";
    }
    return text;
}

struct NamedMeasures {
    std::string name;
    const StringMeasures* measures;
};

std::vector<NamedMeasures> manoeuvres_of(const StringResult& result) {
    std::vector<NamedMeasures> all;
    if (const SwingResult* const worst = result.worst_swing()) {
        all.push_back({fmt::format("swing, {:.2f} rad/s", worst->frequency_radps), &worst->measures});
    }
    for (const ManoeuvreResult& one : result.manoeuvres) all.push_back({manoeuvre_name(one.kind), &one.measures});
    return all;
}

std::string positions_data(const StringReport& report) {
    std::string text = "# position linf_from_head gap_error_m, one block for each population and manoeuvre\n";
    for (const StringResult& result : report.populations) {
        for (const NamedMeasures& one : manoeuvres_of(result)) {
            text += fmt::format("# {}: {}\n", result.population, one.name);
            for (std::size_t k = 1; k < one.measures->positions.size(); ++k) {
                const PositionMeasures& p = one.measures->positions[k];
                text += fmt::format("{} {:.5f} {:.5f}\n", k, p.linf_from_head, p.gap_error_m);
            }
            text += "\n\n";
        }
    }
    return text;
}

// Returns the positions that get a curve: dense at the front, sparse behind.
std::vector<std::size_t> shown_positions_of(const PlatoonMotion& motion) {
    std::vector<std::size_t> shown;
    for (const std::size_t position : {0U, 1U, 2U, 5U, 10U, 15U, 20U, 30U, 40U, 60U}) {
        if (position + 1 < motion.vehicles) shown.push_back(position);
    }
    shown.push_back(motion.vehicles - 1);
    return shown;
}

// Returns the line style of population k, which is the same in all figures.
LineStyle style_in(const StringReport& report, std::size_t k) {
    std::vector<std::string> names;
    for (const StringResult& population : report.populations) names.push_back(population.population);
    return line_style(style_index(names, names[k]));
}

}  // namespace

Figure string_gain_figure(const StringReport& report) {
    Figure figure;
    figure.name = "gain";
    if (report.populations.empty() || report.populations[0].swings.empty()) {
        figure.nothing = "there are no swings";
        return figure;
    }
    figure.data = {{"gain.dat", gain_data(report)}, {"gain_linear.dat", linear_data(report)}};
    std::string curves;
    double largest = 0.0;
    for (std::size_t k = 0; k < report.populations.size(); ++k) {
        const LineStyle style = style_in(report, k);
        curves += fmt::format(
            " 'gain_linear.dat' index {0} using 1:2 with lines dt 1 lw 1.8 lc rgb '{1}' notitle, "
            "'gain.dat' index {0} using 1:2 with points pt {2} ps 1.2 lc rgb '{1}' title {3},",
            k, style.colour, style.hollow_point, gnuplot_text(report.populations[k].population));
        largest = std::max(largest, report.populations[k].worst_swing()->measured.mean);
    }
    curves.back() = '\n';
    figure.height_px = 860;
    figure.body =
        "set multiplot layout 2,1 title 'Gain of the acceleration from vehicle to vehicle' font ',15'\nunset title\n"
        "set logscale x\nset xrange [0.1:10]\nset yrange [0:*]\nset ylabel '|Gamma|'\nset rmargin 18\n"
        "set xlabel 'angular frequency [rad/s]    (lines: linear analysis, points: full dynamics)'\n"
        "set key at graph 1.02,1 left top\n"
        "set arrow from graph 0,first 1 to graph 1,first 1 nohead dt 2 lc rgb '#808080'\nplot" +
        curves + "unset key\n" +
        fmt::format("set title 'detail' offset 0,-0.6\nset yrange [0.96:{:.3f}]\nplot",
                    std::max(1.04, 0.01 + largest)) +
        curves + "unset multiplot\n";
    return figure;
}

Figure string_positions_figure(const StringReport& report) {
    Figure figure;
    figure.name = "positions";
    figure.height_px = 760;
    figure.data = {{"positions.dat", positions_data(report)}};
    std::array<std::string, 2> curves;
    std::size_t block = 0;
    for (std::size_t k = 0; k < report.populations.size(); ++k) {
        int dash = 1;
        for (const NamedMeasures& one : manoeuvres_of(report.populations[k])) {
            for (std::size_t panel = 0; panel < curves.size(); ++panel) {
                const std::string title =
                    panel == 0 ? "title " + gnuplot_text(report.populations[k].population + ", " + one.name)
                               : "notitle";
                curves[panel] +=
                    fmt::format(" 'positions.dat' index {} using 1:{} with lines lw 2 dt {} lc rgb '{}' {},", block,
                                panel + 2, dash, style_in(report, k).colour, title);
            }
            ++block;
            ++dash;
        }
    }
    for (std::string& text : curves) text.back() = '\n';
    figure.body =
        "set multiplot layout 2,1 title 'Manoeuvres of the platoon leader' font ',15'\n"
        "set xlabel 'position behind the platoon leader'\nset yrange [0:*]\nset rmargin 42\n"
        "set key at graph 1.02,1 left top\nset ylabel 'largest acceleration, relative to the platoon leader'\n"
        "set arrow from graph 0,first 1 to graph 1,first 1 nohead dt 2 lc rgb '#808080'\nplot" +
        curves[0] + "unset arrow\nunset key\nset ylabel 'largest gap error [m]'\nplot" + curves[1] +
        "unset multiplot\n";
    return figure;
}

Figure string_motion_figure(const StringResult& result, const ManoeuvreResult& manoeuvre, std::size_t population) {
    constexpr double kInterval_s = 0.1;
    const PlatoonMotion& motion = manoeuvre.motion;
    const std::string name = manoeuvre_name(manoeuvre.kind);
    Figure figure;
    figure.name = fmt::format("{}_{}", name, population + 1);
    figure.height_px = 760;
    const std::string file = figure.name + ".dat";
    const auto stride = static_cast<std::size_t>(std::max(1L, std::lround(kInterval_s / motion.step_s)));
    const std::vector<std::size_t> shown = shown_positions_of(motion);
    std::string data = "# time_s speed_kmh acceleration_mps2 net_gap_m, one block for each position\n";
    std::array<std::string, 2> curves;
    for (std::size_t k = 0; k < shown.size(); ++k) {
        data += fmt::format("# position {}\n", shown[k]);
        for (std::size_t sample = 0; sample < motion.samples; sample += stride) {
            const double gap_m = motion.value(motion.gap_m, sample, shown[k]);
            data += fmt::format("{:.2f} {:.4f} {:.4f} {}\n", static_cast<double>(sample + 1) * motion.step_s,
                                motion.value(motion.speed_mps, sample, shown[k]) * kKmhPerMps,
                                motion.value(motion.acceleration_mps2, sample, shown[k]),
                                shown[k] == 0 ? "NaN" : fmt::format("{:.4f}", gap_m));
        }
        data += "\n\n";
        const std::string colour = ordered_colour(k, shown.size());
        curves[0] += fmt::format(" '{}' index {} using 1:3 with lines dt 1 lw 1.8 lc rgb '{}' title '{}',", file, k,
                                 colour, shown[k]);
        if (shown[k] == 0) continue;
        curves[1] +=
            fmt::format(" '{}' index {} using 1:4 with lines dt 1 lw 1.8 lc rgb '{}' notitle,", file, k, colour);
    }
    for (std::string& text : curves) text.back() = '\n';
    figure.data = {{file, data}};
    figure.body = fmt::format("set multiplot layout 2,1 title {} font ',15'\n",
                              gnuplot_text(fmt::format("{}: the platoon leader {}", result.population,
                                                       name == "brake" ? "brakes hard" : "starts from rest"))) +
                  "set rmargin 14\nset key at graph 1.02,1 left top title 'position'\n"
                  "set xlabel 'time since the beginning of the manoeuvre [s]'\nset yrange [*:*]\n"
                  "set ylabel 'acceleration [m/s^2]'\nplot" +
                  curves[0] + "unset key\nset yrange [0:*]\nset ylabel 'net gap [m]'\nplot" + curves[1] +
                  "unset multiplot\n";
    return figure;
}

Figure string_border_figure(const StringSweep& sweep) {
    constexpr double kLimit = 1.0 + kSwingTolerance;
    Figure figure;
    figure.name = "border";
    std::string points = "# v2v_delay_ms time_gap_s grows gain\n";
    for (const StringSweepPoint& one : sweep.points) {
        points += fmt::format("{:.3f} {:.3f} {} {:.5f}\n", kMillisecondsPerSecond * one.v2v_delay_s, one.time_gap_s,
                              one.measured_gain > kLimit ? 1 : 0, one.measured_gain);
    }
    std::string border = "# v2v_delay_ms measured_s linear_s\n";
    for (const StringBorder& one : sweep.border) {
        border += fmt::format("{:.3f} {:.4f} {:.4f}\n", kMillisecondsPerSecond * one.v2v_delay_s,
                              one.measured_time_gap_s, one.linear_time_gap_s);
    }
    figure.data = {{"border_points.dat", points}, {"border.dat", border}};
    figure.body = fmt::format(
        "set title {}\nset xlabel 'V2V delay [ms]'\nset ylabel 'time gap [s]'\nset xrange [0:*]\nset yrange [0:*]\n"
        "set key outside right\n"
        "plot 'border.dat' using 1:3 with lines dt 2 lw 2.2 lc rgb '#0072B2' title 'border, linear analysis', "
        "'border.dat' using 1:2 with lines dt 1 lw 2.2 lc rgb '#D55E00' title 'border, full dynamics', "
        "'border_points.dat' using 1:($3 == 1 ? $2 : NaN) with points pt 7 ps 1 lc rgb '#D55E00' title 'grows', "
        "'border_points.dat' using 1:($3 == 0 ? $2 : NaN) with points pt 6 ps 1 lc rgb '#009E73' title 'does not grow'\n",
        gnuplot_text("Border of string stability of " + sweep.population));
    return figure;
}

std::vector<Figure> string_figures(const StringReport& report) {
    std::vector<Figure> figures;
    if (!report.options.frequencies_radps.empty()) figures.push_back(string_gain_figure(report));
    figures.push_back(string_positions_figure(report));
    for (std::size_t k = 0; k < report.populations.size(); ++k) {
        for (const ManoeuvreResult& one : report.populations[k].manoeuvres) {
            figures.push_back(string_motion_figure(report.populations[k], one, k));
        }
    }
    return figures;
}

}  // namespace stopline
