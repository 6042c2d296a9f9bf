#include "figures/driving_figures.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "figures/population_style.h"

namespace stopline {

namespace {

// A kind of energy and its texts in the figure.
struct EnergyKind {
    const char* bars;    // title of the axis of the bars
    const char* series;  // title of the axis of the curves
    double scale;        // from EnergyResult to the unit of the curves
    EnergySums EnergyTotals::*sums;
    std::vector<double> EnergyResult::*rates;
};
constexpr EnergyKind kFuel{"fuel [g/km]", "fuel rate [g/s]", 1.0, &EnergyTotals::fuel, &EnergyResult::fuel_g_per_s};
constexpr EnergyKind kBattery{"electric energy [Wh/km]", "battery power [kW]", 1e-3, &EnergyTotals::battery,
                              &EnergyResult::battery_W};

bool has_vehicles(const PopulationDriving& population, const EnergyKind& kind) {
    return (population.driving.energy.totals.*kind.sums).vehicles > 0;
}

std::string series_text(const EnergyResult& energy, const EnergyKind& kind) {
    std::string text = "# minutes rate\n";
    const std::vector<double>& rates = energy.*kind.rates;
    for (std::size_t k = 0; k < rates.size(); ++k) {
        text += fmt::format("{:.4f} {:.5f}\n", (static_cast<double>(k) + 0.5) * energy.interval_s / 60.0,
                            kind.scale * rates[k]);
    }
    return text;
}

// Appends a row of two panels: bars of the energy for each km, and the total rate over time.
void add_panels(const Scenario& scenario, const std::vector<PopulationDriving>& populations, const EnergyKind& kind,
                const char* file, Figure& figure) {
    std::string bars = "# index value population\n";
    std::string ticks;
    for (std::size_t k = 0; k < populations.size(); ++k) {
        const double value = (populations[k].driving.energy.totals.*kind.sums).per_km();
        bars += fmt::format("{} {}\n", k, std::isnan(value) ? "NaN" : fmt::format("{:.4f}", value));
        ticks += fmt::format("{}{} {}", k == 0 ? "" : ", ", gnuplot_text(populations[k].population), k);
        figure.data.emplace_back(fmt::format("{}_{}.dat", file, k), series_text(populations[k].driving.energy, kind));
    }
    figure.data.emplace_back(fmt::format("{}.dat", file), bars);
    figure.body += fmt::format(
        "unset key\nunset xlabel\nset ylabel '{}'\nset xrange [-0.6:{:.1f}]\nset yrange [0:*]\nset xtics rotate by -35 "
        "left ({})\nset boxwidth 0.7\nset style fill solid 0.85\nplot ",
        kind.bars, static_cast<double>(populations.size()) - 0.4, ticks);
    for (std::size_t k = 0; k < populations.size(); ++k) {
        figure.body += fmt::format("{}'{}.dat' every ::{}::{} using 1:2 with boxes lc rgb '{}'", k == 0 ? "" : ", ",
                                   file, k, k, style_of(scenario, populations[k].population).colour);
    }
    figure.body += fmt::format(
        "\nset key outside right top\nset xtics norotate center autofreq\nset autoscale x\nset autoscale y\nset xlabel 'time [min]'\nset "
        "ylabel '{}'\nplot ",
        kind.series);
    const char* separator = "";
    for (std::size_t k = 0; k < populations.size(); ++k) {
        if (!has_vehicles(populations[k], kind)) continue;
        const LineStyle style = style_of(scenario, populations[k].population);
        figure.body += fmt::format("{}'{}_{}.dat' using 1:2 with lines lw 2 lc rgb '{}' dt {} title {}", separator,
                                   file, k, style.colour, style.dash, gnuplot_text(populations[k].population));
        separator = ", ";
    }
    figure.body += "\n";
}

Figure energy_figure(const Scenario& scenario, const std::vector<PopulationDriving>& populations) {
    Figure figure;
    figure.name = "energy";
    figure.width_px = 1150;
    std::vector<std::pair<const EnergyKind*, const char*>> kinds;
    for (const auto& [kind, file] : {std::pair{&kFuel, "energy_fuel"}, std::pair{&kBattery, "energy_battery"}}) {
        const auto has = [kind = kind](const PopulationDriving& p) { return has_vehicles(p, *kind); };
        if (std::any_of(populations.begin(), populations.end(), has)) kinds.emplace_back(kind, file);
    }
    if (kinds.empty()) figure.nothing = "no vehicle has left the network in the measured window";
    figure.height_px = 440 * static_cast<int>(std::max<std::size_t>(kinds.size(), 1));
    figure.body = fmt::format("set multiplot layout {},2\n", std::max<std::size_t>(kinds.size(), 1));
    for (const auto& [kind, file] : kinds) add_panels(scenario, populations, *kind, file, figure);
    figure.body += "unset multiplot\n";
    return figure;
}

std::string distribution_text(const SafetyAxis& axis, const SafetyDistribution& distribution) {
    std::string text = "# value share_per_unit\n";
    if (distribution.count() == 0) return text + "NaN NaN\n";
    for (std::size_t bin = 0; bin < distribution.samples().size(); ++bin) {
        const double share =
            static_cast<double>(distribution.samples()[bin]) / static_cast<double>(distribution.count());
        if (share > 0.0) {
            text += fmt::format("{:.3f} {:.6g}\n", axis.from + axis.width * (static_cast<double>(bin) + 0.5),
                                100.0 * share);
        }
    }
    return text;
}

// Returns commands for a panel of a multiplot without data.
std::string empty_panel_text() {
    return "set xrange [0:1]\nset yrange [0.1:1]\nset label 1 'no samples' at graph 0.5,0.5 center\n"
           "plot 2 notitle\nunset label 1\nset autoscale x\nset autoscale y\n";
}

Figure safety_figure(const Scenario& scenario, const std::vector<PopulationDriving>& populations) {
    Figure figure;
    figure.name = "safety";
    figure.width_px = 1250;
    figure.height_px = 760;
    figure.body = "set multiplot layout 2,3\nset logscale y\nset format y '%g'\nset key right top samplen 2\n";
    for (std::size_t k = 0; k < kSafetyMeasures; ++k) {
        const SafetyAxis& axis = kSafetyAxes[k];
        figure.body += fmt::format("set xlabel '{}'\nset ylabel 'time in a bin of {:g} [%]'\n{}", axis.label,
                                   axis.width, k == 1 ? "unset key\n" : "");
        const auto has_samples = [k](const PopulationDriving& p) {
            return p.driving.safety.distributions[k].count() > 0;
        };
        if (std::none_of(populations.begin(), populations.end(), has_samples)) {
            figure.body += empty_panel_text();
            continue;
        }
        figure.body += "plot ";
        for (std::size_t p = 0; p < populations.size(); ++p) {
            const LineStyle style = style_of(scenario, populations[p].population);
            const std::string file = fmt::format("safety_{}_{}.dat", axis.name, p);
            figure.data.emplace_back(file, distribution_text(axis, populations[p].driving.safety.distributions[k]));
            figure.body +=
                fmt::format("{}'{}' using 1:2 with lines lw 2 lc rgb '{}' dt {} title {}", p == 0 ? "" : ", ", file,
                            style.colour, style.dash, gnuplot_text(populations[p].population));
        }
        figure.body += "\n";
    }
    figure.body += "unset multiplot\n";
    return figure;
}

}  // namespace

std::vector<Figure> driving_figures(const Scenario& scenario, const std::vector<PopulationDriving>& populations) {
    std::vector<Figure> figures;
    if (scenario.measure.energy == "on") figures.push_back(energy_figure(scenario, populations));
    if (scenario.measure.surrogate_safety == "on") figures.push_back(safety_figure(scenario, populations));
    return figures;
}

}  // namespace stopline
