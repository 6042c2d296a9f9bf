#include "figures/hcm_figure.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace stopline {

namespace {

constexpr int kMinHeadways = 8;  // fewest headways from which a point is computed

// Returns the mean headways by position over all lanes of a population, and the last position with enough headways.
std::string mean_headways_data(const PopulationHcm& one, std::size_t& last) {
    std::string text = "# position headway_s\n";
    bool is_empty = true;
    for (std::size_t n = 0;; ++n) {
        double sum_s = 0.0;
        int samples = 0;
        for (const HcmRow& row : one.rows) {
            if (row.discharge.saturated_greens == 0 || n >= row.discharge.samples.size()) continue;
            sum_s += row.discharge.headway_s[n] * row.discharge.samples[n];
            samples += row.discharge.samples[n];
        }
        if (samples < kMinHeadways) break;
        text += fmt::format("{} {:.4f}\n", n + 1, sum_s / samples);
        last = std::max(last, n + 1);
        is_empty = false;
    }
    return is_empty ? text + "NaN NaN\n" : text;
}

// Returns the delays of the lanes. Oversaturated lanes are left out, because their delay has no steady value.
std::string delays_data(const PopulationHcm& one, double& longest_s) {
    std::string text = "# formula_delay_s control_delay_s\n";
    bool is_empty = true;
    for (const HcmRow& row : one.rows) {
        if (row.scope != HcmRow::Scope::lane || row.state == HcmState::oversaturated) continue;
        if (std::isnan(row.control_delay_s) || std::isnan(row.formula_delay_s())) continue;
        text += fmt::format("{:.3f} {:.3f}\n", row.formula_delay_s(), row.control_delay_s);
        longest_s = std::max({longest_s, row.formula_delay_s(), row.control_delay_s});
        is_empty = false;
    }
    return is_empty ? text + "NaN NaN\n" : text;
}

}  // namespace

std::optional<Figure> hcm_figure(const std::vector<PopulationHcm>& populations) {
    Figure figure;
    figure.name = "hcm";
    figure.width_px = 1200;
    std::string headways;
    std::string delays;
    std::size_t last = 0;
    double longest_s = 0.0;
    for (std::size_t k = 0; k < populations.size(); ++k) {
        const std::string headways_file = fmt::format("hcm_headways_{}.dat", k);
        const std::string delays_file = fmt::format("hcm_delays_{}.dat", k);
        figure.data.emplace_back(headways_file, mean_headways_data(populations[k], last));
        figure.data.emplace_back(delays_file, delays_data(populations[k], longest_s));
        const std::string style = fmt::format("lc rgb '{}' pt {}", line_style(k).colour, line_style(k).hollow_point);
        const std::string title = gnuplot_text(populations[k].population);
        headways +=
            fmt::format("{}'{}' with linespoints lw 2 {} title {}", k == 0 ? "" : ", ", headways_file, style, title);
        delays += fmt::format(", '{}' with points ps 1.2 lw 2 {} title {}", delays_file, style, title);
    }
    if (last == 0 && longest_s == 0.0) return std::nullopt;
    const double end_s = longest_s > 0.0 ? 1.1 * longest_s : 1.0;
    if (last == 0) headways = "-1 notitle";  // no headways: an empty panel
    figure.body = fmt::format(
        "set multiplot layout 1,2\nset title 'Mean headway of all lanes'\nset xlabel 'position in the queue (1: time from the start of green)'\n"
        "set ylabel 'headway at the stop line [s]'\nset xrange [0.5:{:.6g}]\nset yrange [0:{}]\nset key top right\nplot {}\n"
        "set title 'Control delay of each lane'\nset xlabel 'HCM formula [s]'\nset ylabel 'measured [s]'\n"
        "set xrange [0:{:.6g}]\nset yrange [0:{:.6g}]\nset key top left\nplot x with lines lc rgb '#888888' dt 2 title 'equal'{}\nunset multiplot\n",
        static_cast<double>(std::max<std::size_t>(last, 1)) + 0.5, last == 0 ? "1" : "*", headways, end_s, end_s,
        delays);
    return figure;
}

}  // namespace stopline
