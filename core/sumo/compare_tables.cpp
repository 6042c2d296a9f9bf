// Passages by stop line, and figures, of a comparison.
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "experiment/csv.h"
#include "sumo/compare.h"

namespace stopline {

namespace {

double passages(const RunFacts& facts, const std::string& lane, double from_s, double to_s) {
    const auto times = facts.passed_s.find(lane);
    if (times == facts.passed_s.end()) return 0.0;
    return static_cast<double>(std::count_if(times->second.begin(), times->second.end(),
                                             [&](double time_s) { return time_s > from_s && time_s <= to_s; }));
}

// A quantity of a run at every full second from 0 on, to `seconds`.
using Course = std::vector<double> (*)(const RunFacts& facts, std::size_t seconds);

std::vector<double> counted(std::vector<double> times_s, std::size_t seconds) {
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
    return counted(std::move(times_s), seconds);
}

std::vector<double> arrivals_of(const RunFacts& facts, std::size_t seconds) {
    std::vector<double> times_s;
    for (const RunFacts::Trip& trip : facts.trips) times_s.push_back(trip.arrival_s);
    return counted(std::move(times_s), seconds);
}

// What is not known of a second is as in the one before: SUMO ends a step before the end.
std::vector<double> standing_of(const RunFacts& facts, std::size_t seconds) {
    std::vector<double> standing;
    std::size_t next = 0;
    for (std::size_t second = 0; second <= seconds; ++second) {
        const double until_s = static_cast<double>(second) + 0.5;
        while (next < facts.instants.size() && facts.instants[next].time_s < until_s) ++next;
        standing.push_back(next > 0 ? facts.instants[next - 1].halting : 0.0);
    }
    return standing;
}

struct Curves {
    std::string rows;
    double most = 0.0;  // of both means
    double high = 0.0;  // of the band
};

// Means of the seeds, and the band of SUMO's mean.
Curves curves_of(const Comparison& comparison, Course course) {
    const auto seconds = static_cast<std::size_t>(comparison.to_s);
    std::vector<std::vector<double>> ours;
    std::vector<std::vector<double>> sumo;
    for (const ComparedRun& run : comparison.runs) {
        ours.push_back(course(run.ours, seconds));
        sumo.push_back(course(run.sumo, seconds));
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
            curves.high = std::max(curves.high, band.high);
        }
        curves.most = std::max({curves.most, mean_of(own), mean_of(other)});
        csv.row({std::to_string(second), fixed(mean_of(own), 3), fixed(mean_of(other), 3), fixed(band.low, 3),
                 fixed(band.high, 3)});
    }
    curves.rows = csv.text();
    return curves;
}

Figure course_figure(const Comparison& comparison, const std::string& title, const std::string& name,
                     const std::string& y, Course course) {
    Curves curves = curves_of(comparison, course);
    const std::size_t seeds = comparison.runs.size();
    const std::string which =
        seeds == 1 ? fmt::format("seed {}", comparison.runs[0].seed) : fmt::format("mean of {} seeds", seeds);
    const std::string file = name + ".csv";
    // A band of two seeds would leave little of the lines: it may be cut off.
    constexpr double kOfLines = 1.6;
    const double top = std::max(1.0, 1.05 * std::max(curves.most, std::min(curves.high, kOfLines * curves.most)));
    Figure figure;
    figure.name = name;
    figure.data = {{file, std::move(curves.rows)}};
    figure.body = fmt::format(
        "set datafile separator ','\nset title {}\nset xlabel 'time (s)'\nset ylabel '{}'\nset xrange [0:{:g}]\nset yrange [0:{:g}]\n"
        "set key outside bottom center horizontal\nplot ",
        gnuplot_text(fmt::format("{}, {}, {}", title, comparison.population, which)), y, comparison.to_s, top);
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
    const auto add = [&](const std::string& name, const std::string& y, Course course) {
        figures.push_back(course_figure(comparison, title, name, y, course));
    };
    if (comparison.has_stop_lines) add("passages", "vehicles past all stop lines (veh)", passages_of);
    add("arrivals", "trips that have ended (veh)", arrivals_of);
    add("standing", "vehicles that stand (veh)", standing_of);
    return figures;
}

}  // namespace stopline
