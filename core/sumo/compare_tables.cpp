// Passages by stop line, and figures, of a comparison.
#include <algorithm>
#include <set>

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

std::string counter_rows(const RunFacts& facts) {
    std::vector<double> times_s;
    for (const auto& [lane, passed_s] : facts.passed_s) times_s.insert(times_s.end(), passed_s.begin(), passed_s.end());
    std::sort(times_s.begin(), times_s.end());
    CsvWriter csv({"time_s", "vehicles"});
    for (std::size_t k = 0; k < times_s.size(); ++k) csv.row({fixed(times_s[k], 2), std::to_string(k + 1)});
    return csv.text();
}

std::string standing_rows(const RunFacts& facts) {
    CsvWriter csv({"time_s", "standing", "present", "mean_speed_mps"});
    for (const RunFacts::Instant& instant : facts.instants) {
        csv.row({fixed(instant.time_s, 1), std::to_string(instant.halting), std::to_string(instant.present),
                 fixed(instant.mean_speed_mps, 3)});
    }
    return csv.text();
}

Figure two_lines(const std::string& name, const std::string& title, const std::string& y, std::string ours,
                 std::string sumo) {
    Figure figure;
    figure.name = name;
    figure.data = {{name + "_ours.csv", std::move(ours)}, {name + "_sumo.csv", std::move(sumo)}};
    figure.body = fmt::format(
        "set datafile separator ','\nset title {}\nset xlabel 'time (s)'\nset ylabel '{}'\nset key outside bottom center horizontal\n"
        "plot '{}_ours.csv' using 1:2 skip 1 with lines lt 1 title 'Stopline, mesoscale mode', "
        "'{}_sumo.csv' using 1:2 skip 1 with lines lt 7 title 'SUMO'",
        gnuplot_text(title), y, name, name);
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
    const ComparedRun& run = comparison.runs.front();
    const std::string whole = fmt::format("{}, {}, seed {}", title, comparison.population, run.seed);
    Figure counters =
        two_lines("passages", whole, "vehicles past all stop lines", counter_rows(run.ours), counter_rows(run.sumo));
    Figure standing =
        two_lines("standing", whole, "vehicles that stand", standing_rows(run.ours), standing_rows(run.sumo));
    return {counters, standing};
}

}  // namespace stopline
