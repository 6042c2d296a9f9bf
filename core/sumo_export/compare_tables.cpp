// Tables and figures of a comparison with SUMO.
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "sumo_export/compare.h"

namespace stopline {

namespace {

// Returns how many vehicles pass a stop line after `from_s` and not later than `to_s`.
double passages(const RunFacts& facts, const std::string& lane, double from_s, double to_s) {
    const auto times = facts.passed_s.find(lane);
    if (times == facts.passed_s.end()) return 0.0;
    return static_cast<double>(std::count_if(times->second.begin(), times->second.end(),
                                             [&](double time_s) { return time_s > from_s && time_s <= to_s; }));
}

// A function that returns a quantity of a run at every full second from 0 to `seconds`.
using TimeSeries = std::vector<double> (*)(const RunFacts& facts, std::size_t seconds);

// Returns, for every full second from 0 to `seconds`, how many of the given times are at or before this second.
std::vector<double> cumulative(std::vector<double> times_s, std::size_t seconds) {
    std::sort(times_s.begin(), times_s.end());
    std::vector<double> counts;
    std::size_t passed = 0;
    for (std::size_t second = 0; second <= seconds; ++second) {
        while (passed < times_s.size() && times_s[passed] <= static_cast<double>(second)) ++passed;
        counts.push_back(static_cast<double>(passed));
    }
    return counts;
}

std::vector<double> passages_of(const RunFacts& facts, std::size_t seconds) {
    std::vector<double> times_s;
    for (const auto& [lane, passed_s] : facts.passed_s) times_s.insert(times_s.end(), passed_s.begin(), passed_s.end());
    return cumulative(std::move(times_s), seconds);
}

std::vector<double> arrivals_of(const RunFacts& facts, std::size_t seconds) {
    std::vector<double> times_s;
    for (const RunFacts::Trip& trip : facts.trips) times_s.push_back(trip.arrival_s);
    return cumulative(std::move(times_s), seconds);
}

// Returns the number of stopped vehicles at every full second. SUMO writes no data for the end of the run, so a second
// without data gets the value of the second before.
std::vector<double> stopped_of(const RunFacts& facts, std::size_t seconds) {
    std::vector<double> stopped;
    std::size_t next = 0;
    for (std::size_t second = 0; second <= seconds; ++second) {
        const double until_s = static_cast<double>(second) + 0.5;
        while (next < facts.instants.size() && facts.instants[next].time_s < until_s) ++next;
        stopped.push_back(next > 0 ? facts.instants[next - 1].stopped : 0.0);
    }
    return stopped;
}

struct Curves {
    std::string rows;       // the curves as CSV
    double max_mean = 0.0;  // maximum of the two mean curves
    double max_band = 0.0;  // highest value of the confidence band
};

// Returns, at every full second, the means of our runs and of SUMO's runs, and the confidence band of SUMO's mean.
Curves curves_of(const Comparison& comparison, TimeSeries series) {
    const auto seconds = static_cast<std::size_t>(comparison.to_s);
    std::vector<std::vector<double>> ours;
    std::vector<std::vector<double>> sumo;
    for (const ComparedRun& run : comparison.runs) {
        ours.push_back(series(run.ours, seconds));
        sumo.push_back(series(run.sumo, seconds));
    }
    Curves curves;
    CsvWriter csv({"time_s", "ours", "sumo", "sumo_low", "sumo_high"});
    for (std::size_t second = 0; second <= seconds; ++second) {
        std::vector<double> own;
        std::vector<double> other;
        for (std::size_t k = 0; k < ours.size(); ++k) {
            own.push_back(ours[k][second]);
            other.push_back(sumo[k][second]);
        }
        Interval band{std::nan(""), std::nan("")};
        if (other.size() > 1) {
            band = confidence_interval(other, Band::student);
            band.low = std::max(band.low, 0.0);
            curves.max_band = std::max(curves.max_band, band.high);
        }
        curves.max_mean = std::max({curves.max_mean, mean_of(own), mean_of(other)});
        csv.row({std::to_string(second), fixed(mean_of(own), 3), fixed(mean_of(other), 3), fixed(band.low, 3),
                 fixed(band.high, 3)});
    }
    curves.rows = csv.text();
    return curves;
}

Figure time_series_figure(const Comparison& comparison, const std::string& title, const std::string& name,
                          const std::string& y, TimeSeries series) {
    Curves curves = curves_of(comparison, series);
    const std::size_t seeds = comparison.runs.size();
    const std::string seeds_text =
        seeds == 1 ? fmt::format("seed {}", comparison.runs[0].seed) : fmt::format("mean of {} seeds", seeds);
    const std::string file = name + ".csv";
    // With few seeds the confidence band can be so wide that the mean curves would look flat. So the plot shows the
    // band only up to the largest mean times this factor.
    constexpr double kMaxBandToMean = 1.6;
    const double top =
        std::max(1.0, 1.05 * std::max(curves.max_mean, std::min(curves.max_band, kMaxBandToMean * curves.max_mean)));
    Figure figure;
    figure.name = name;
    figure.data = {{file, std::move(curves.rows)}};
    figure.body = fmt::format(
        "set datafile separator ','\nset title {}\nset xlabel 'time (s)'\nset ylabel '{}'\nset xrange [0:{:g}]\nset yrange [0:{:g}]\n"
        "set key outside bottom center horizontal\nplot ",
        gnuplot_text(fmt::format("{}, {}, {}", title, comparison.population, seeds_text)), y, comparison.to_s, top);
    if (seeds > 1) {
        figure.body += fmt::format(
            "'{}' using 1:4:5 skip 1 with filledcurves fs transparent solid 0.25 noborder lc rgb '{}' title 'SUMO, 95 % "
            "band of the mean', ",
            file, line_style(6).colour);
    }
    figure.body += fmt::format(
        "'{}' using 1:3 skip 1 with lines lt 7 dt (10,3) title 'SUMO', '{}' using 1:2 skip 1 with lines lt 1 title 'Stopline, mesoscale mode'",
        file, file);
    return figure;
}

}  // namespace

std::string stop_lines_csv(const Comparison& comparison) {
    std::set<std::string> lanes;
    for (const ComparedRun& run : comparison.runs) {
        for (const RunFacts* const facts : {&run.ours, &run.sumo}) {
            for (const auto& [lane, times_s] : facts->passed_s) lanes.insert(lane);
        }
    }
    CsvWriter csv({"lane", "ours_veh", "sumo_veh"});
    const auto runs = static_cast<double>(comparison.runs.size());
    for (const std::string& lane : lanes) {
        double ours = 0.0;
        double sumo = 0.0;
        for (const ComparedRun& run : comparison.runs) {
            ours += passages(run.ours, lane, comparison.from_s, comparison.to_s) / runs;
            sumo += passages(run.sumo, lane, comparison.from_s, comparison.to_s) / runs;
        }
        csv.row({lane, fixed(ours, 2), fixed(sumo, 2)});
    }
    return csv.text();
}

std::vector<Figure> comparison_figures(const Comparison& comparison, const std::string& title) {
    std::vector<Figure> figures;
    const auto add = [&](const std::string& name, const std::string& y, TimeSeries series) {
        figures.push_back(time_series_figure(comparison, title, name, y, series));
    };
    if (comparison.has_stop_lines) add("passages", "stop-line passages (veh)", passages_of);
    add("arrivals", "completed trips (veh)", arrivals_of);
    add("stopped", "stopped vehicles (veh)", stopped_of);
    return figures;
}

}  // namespace stopline
