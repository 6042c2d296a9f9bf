#include "experiment/network_sweep_figures.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include <fmt/format.h>

#include "experiment/network_run.h"
#include "experiment/targets.h"

namespace stopline {

namespace {

struct Metric {
    const char* column;
    const char* label;
    bool less_is_better;
};
constexpr std::array<Metric, 3> kMetrics{Metric{"throughput_veh_h", "throughput [veh/h]", false},
                                         Metric{"travel_time_s", "travel time [s]", true},
                                         Metric{"density_percent", "density [%]", true}};

bool has(const CsvTable& table, const std::string& name) {
    return std::find(table.columns.begin(), table.columns.end(), name) != table.columns.end();
}

template <class T>
void add_new(std::vector<T>& all, const T& one) {
    if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
}

// One combination of the other axes.
struct Plane {
    std::string title;
    std::map<std::tuple<std::string, double, double, std::string>, std::pair<double, int>>
        sums;  // metric, green, offset, population
    std::map<std::tuple<double, double, std::string>, std::size_t> stability;

    std::optional<double> value(const char* metric, double green_s, double offset_s,
                                const std::string& population) const {
        const auto found = sums.find({metric, green_s, offset_s, population});
        if (found == sums.end()) return std::nullopt;
        return found->second.first / found->second.second;
    }
    bool has(const char* metric) const {
        return std::any_of(sums.begin(), sums.end(), [&](const auto& sum) { return std::get<0>(sum.first) == metric; });
    }
};

struct Planes {
    std::vector<double> greens_s;
    std::vector<double> offsets_s;
    std::vector<std::string> populations;
    std::vector<Plane> planes;
};

// What sets a plane apart: the axes but green, offset and population.
std::string other_axes(const CsvTable& results, const std::vector<std::string>& row, const CellTitles& titles) {
    std::string text;
    for (std::size_t k = 0; k < results.columns.size() && results.columns[k] != "seed"; ++k) {
        const std::string& name = results.columns[k];
        if (name == "point" || name == "green_s" || name == "offset_s" || name == "population") continue;
        text += (text.empty() ? "" : "; ") + titles.at({name, row[k]});
    }
    return text;
}

Planes planes_of(const CsvTable& results, const CellTitles& titles) {
    Planes all;
    const std::size_t green = results.column("green_s");
    const std::size_t offset = results.column("offset_s");
    const std::size_t population = results.column("population");
    const std::size_t stability = results.column("stability");
    for (const std::vector<std::string>& row : results.rows) {
        const double green_s = parse_number(row[green]).value_or(0.0);
        const double offset_s = parse_number(row[offset]).value_or(0.0);
        add_new(all.greens_s, green_s);
        add_new(all.offsets_s, offset_s);
        add_new(all.populations, row[population]);
        const std::string title = other_axes(results, row, titles);
        auto plane =
            std::find_if(all.planes.begin(), all.planes.end(), [&](const Plane& p) { return p.title == title; });
        if (plane == all.planes.end()) plane = all.planes.insert(all.planes.end(), Plane{title, {}, {}});
        for (const Metric& metric : kMetrics) {
            const std::optional<double> value = parse_number(row[results.column(metric.column)]);
            if (!value) continue;
            auto& [sum, count] = plane->sums[{metric.column, green_s, offset_s, row[population]}];
            sum += *value;
            ++count;
        }
        const auto known = std::find(kStabilityNames.begin(), kStabilityNames.end(), row[stability]);
        std::size_t& worst = plane->stability[{green_s, offset_s, row[population]}];
        worst = std::max(worst, static_cast<std::size_t>(known - kStabilityNames.begin()));
    }
    std::sort(all.greens_s.begin(), all.greens_s.end());
    std::sort(all.offsets_s.begin(), all.offsets_s.end());
    return all;
}

// Lines over green: colour by population, dashes by offset. Upper row: values; lower row: improvement over the first population.
Figure plane_figure(const Planes& all, const Plane& plane, std::size_t number) {
    Figure figure;
    figure.name = fmt::format("network_{}", number);
    figure.width_px = 1300;
    figure.height_px = 760;
    std::string data = "# green_s; for each population and offset: three metrics, then three improvements in percent\n";
    for (const double green_s : all.greens_s) {
        data += fmt::format("{:g}", green_s);
        for (const std::string& population : all.populations) {
            for (const double offset_s : all.offsets_s) {
                std::string gains;
                for (const Metric& metric : kMetrics) {
                    const std::optional<double> here = plane.value(metric.column, green_s, offset_s, population);
                    const std::optional<double> base =
                        plane.value(metric.column, green_s, offset_s, all.populations[0]);
                    data += here ? fmt::format(" {:.4f}", *here) : " NaN";
                    const double sign = metric.less_is_better ? -100.0 : 100.0;
                    gains += here && base ? fmt::format(" {:.3f}", sign * (*here / *base - 1.0)) : " NaN";
                }
                data += gains;
            }
        }
        data += "\n";
    }
    figure.data.emplace_back(figure.name + ".dat", data);
    std::string body = fmt::format(
        "set multiplot layout 2,3 title {} margins 0.075,0.86,0.08,0.90 spacing 0.065,0.10\nset xlabel 'green [s]'\n"
        "set xrange [{:g}:{:g}]\nset xtics 5\n",
        gnuplot_text(plane.title), all.greens_s.front() - 1.0, all.greens_s.back() + 1.0);
    const std::size_t offsets = all.offsets_s.size();
    for (std::size_t panel = 0; panel < 6; ++panel) {
        const bool gain = panel >= 3;
        const Metric& metric = kMetrics[panel % 3];
        body +=
            fmt::format("set ylabel '{}'\n",
                        gain ? fmt::format("{}: better by [%]",
                                           std::string(metric.label).substr(0, std::string(metric.label).find(" [")))
                             : metric.label);
        // gnuplot finds no range where no value is a number.
        body += gain ? "set yrange [*:*]\n" : plane.has(metric.column) ? "set yrange [0:*]\n" : "set yrange [0:1]\n";
        body += panel == 2 ? "set key at screen 0.995,0.90 right top width -2\n" : "unset key\n";
        body += "plot ";
        for (std::size_t p = gain ? 1 : 0; p < all.populations.size(); ++p) {
            for (std::size_t o = 0; o < offsets; ++o) {
                const std::size_t column = 2 + (p * offsets + o) * 6 + panel % 3 + (gain ? 3 : 0);
                body += fmt::format(
                    "'{0}.dat' using 1:{1} with linespoints lw 2 dt {2} pt {3} ps 0.7 lc rgb '{4}' title {5}, ",
                    figure.name, column, o + 1, line_style(p).hollow_point, line_style(p).colour,
                    gnuplot_text(fmt::format("{}, {:g} s", all.populations[p], all.offsets_s[o])));
            }
        }
        body += gain ? "0 with lines lc rgb '#888888' notitle\n" : "NaN notitle\n";
    }
    figure.body = body + "unset multiplot\n";
    return figure;
}

Figure stability_figure(const Planes& all, const Plane& plane, std::size_t number) {
    constexpr std::array<const char*, 3> kColours{"#009e73", "#e69f00", "#d55e00"};
    constexpr std::array<int, 3> kPoints{7, 5, 9};  // so that they can be told apart without colours too
    Figure figure;
    figure.name = fmt::format("stability_{}", number);
    figure.width_px = 1100;
    figure.height_px = 420;
    std::string body = fmt::format(
        "set multiplot layout 1,{} title {} margins 0.07,0.86,0.15,0.82 spacing 0.04\nset xlabel 'green [s]'\nset xrange "
        "[{:g}:{:g}]\nset yrange [{:g}:{:g}]\nset xtics 5\nset ytics 5\n",
        all.populations.size(), gnuplot_text(plane.title), all.greens_s.front() - 4.0, all.greens_s.back() + 4.0,
        all.offsets_s.front() - 4.0, all.offsets_s.back() + 4.0);
    for (std::size_t p = 0; p < all.populations.size(); ++p) {
        std::string data = "# green_s offset_s stability\n";
        for (const double green_s : all.greens_s) {
            for (const double offset_s : all.offsets_s) {
                const auto found = plane.stability.find({green_s, offset_s, all.populations[p]});
                if (found != plane.stability.end()) {
                    data += fmt::format("{:g} {:g} {}\n", green_s, offset_s, found->second);
                }
            }
        }
        const std::string file = fmt::format("{}_{}.dat", figure.name, p);
        figure.data.emplace_back(file, data);
        body += fmt::format(
            "set title {}\n{}{}plot ", gnuplot_text(all.populations[p]),
            p == 0 ? "set ylabel 'offset [s]'\n" : "unset ylabel\n",
            p + 1 == all.populations.size() ? "set key at screen 0.99,0.80 right top spacing 2.4\n" : "unset key\n");
        for (std::size_t k = 0; k < kStabilityNames.size(); ++k) {
            body += fmt::format("{}'{}' using 1:($3=={}?$2:NaN) with points pt {} ps 2.5 lc rgb '{}' title '{}'",
                                k == 0 ? "" : ", ", file, k, kPoints[k], kColours[k], kStabilityNames[k]);
        }
        body += ", -1000 notitle\n";
    }
    figure.body = body + "unset multiplot\n";
    return figure;
}

}  // namespace

bool is_network_sweep(const CsvTable& results) {
    return has(results, "green_s") && has(results, "offset_s") && has(results, "population") &&
           has(results, "stability") && !results.rows.empty();
}

std::vector<Figure> network_sweep_figures(const CsvTable& results, const CellTitles& titles) {
    const Planes all = planes_of(results, titles);
    std::vector<Figure> figures;
    for (std::size_t k = 0; k < all.planes.size(); ++k) {
        figures.push_back(plane_figure(all, all.planes[k], k + 1));
        figures.push_back(stability_figure(all, all.planes[k], k + 1));
    }
    return figures;
}

}  // namespace stopline
