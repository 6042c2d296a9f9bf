#include "figures/studies/timing_figure.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "measure/confidence.h"

namespace stopline {

namespace {

double y_of(const SignalTimes& times, bool over_offset) { return over_offset ? times.offset_s : times.green_s[1]; }

std::string tics(const std::set<double>& values) {
    std::string text;
    int place = 0;
    for (const double value : values) text += fmt::format("{}'{:g}' {}", place == 0 ? "" : ", ", value, place), ++place;
    return text;
}

int place_in(const std::set<double>& values, double value) {
    return static_cast<int>(std::distance(values.begin(), values.find(value)));
}

}  // namespace

Figure timing_figure(const TimingSearch& search) {
    std::set<double> greens;
    std::set<double> cross_greens;
    std::set<double> offsets;
    for (const SearchedTimes& one : search.all) {
        greens.insert(one.times.green_s[0]);
        cross_greens.insert(one.times.green_s[1]);
        offsets.insert(one.times.offset_s);
    }
    const bool over_offset = offsets.size() > 1;
    const std::set<double>& rows = over_offset ? offsets : cross_greens;
    const bool is_delay = search.objective == Objective::delay;
    std::map<std::pair<double, double>, double> cells;
    for (const SearchedTimes& one : search.all) {
        const double value = mean_of(one.values(search.objective));
        const auto [cell, is_new] = cells.try_emplace({one.times.green_s[0], y_of(one.times, over_offset)}, value);
        if (!is_new) cell->second = is_delay ? std::min(cell->second, value) : std::max(cell->second, value);
    }
    std::string data = "# green_s y_s x_place y_place value\n";
    for (const auto& [place, value] : cells) {
        data += fmt::format("{:g} {:g} {} {} {:.4f}\n", place.first, place.second, place_in(greens, place.first),
                            place_in(rows, place.second), value);
    }
    const SignalTimes& start = search.all[search.start].times;
    const std::string file = "search_" + search.population + ".dat";
    Figure figure;
    figure.name = "search_" + search.population;
    figure.width_px = 220 + 110 * static_cast<int>(greens.size());
    figure.height_px = 190 + 60 * static_cast<int>(rows.size());
    figure.data = {{file, data}};
    const std::string title =
        fmt::format("{}: {}{}", search.population, is_delay ? "mean delay [s]" : "throughput [veh/h]",
                    over_offset && cross_greens.size() > 1 ? ", best green of the streets from south to north" : "");
    figure.body = fmt::format(
        "set title {}\nset xlabel 'green, west-east [s]'\nset ylabel '{}'\n"
        "set xrange [-0.5:{}.5]\nset yrange [-0.5:{}.5]\nset xtics ({})\nset ytics ({})\nunset key\nunset grid\n"
        "set palette defined (0 '{}', 1 '{}')\nset object rectangle center {},{} size 0.96,0.94 fs empty border lc rgb "
        "'#d55e00' lw 4 front\n"
        "plot '{}' using 3:4:(0.5):(0.5):5 with boxxyerror fs solid noborder lc palette, '{}' using 3:4:(sprintf('%.{}f', $5)) with labels\n",
        gnuplot_text(title), over_offset ? "offset [s]" : "green, south-north [s]", greens.size() - 1, rows.size() - 1,
        tics(greens), tics(rows), is_delay ? "#ffffff" : "#7fb8e6", is_delay ? "#7fb8e6" : "#ffffff",
        place_in(greens, start.green_s[0]), place_in(rows, y_of(start, over_offset)), file, file, is_delay ? 1 : 0);
    return figure;
}

}  // namespace stopline
