#include "paper/sections/sweep_means.h"

#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "measure/confidence.h"
#include "paper/sections/scorecard_sweeps.h"
#include "runs/run_metrics.h"

namespace stopline {

Measurements measure_means(const ScorecardOptions& options, const char* sweep, std::span<const char* const> columns,
                           const NameOfRuns& name_of) {
    const SweepRuns runs =
        run_sweep(options, fmt::format("{}.yaml", sweep).c_str(), {}, sweep, run_metrics, {0.0, 1.0});
    std::map<std::string, std::vector<double>> values;
    runs.store.for_each_run([&](std::size_t point, const std::string& text) {
        const Scenario scenario = runs.sweep.scenario(runs.sweep.combination(point));
        for (const char* const column : columns) {
            values[fmt::format("{} {}", column, name_of(scenario, runs.sweep.population(point)))].push_back(
                parse_number(value_in(text, column)).value_or(std::nan("")));
        }
    });
    Measurements measured;
    for (const auto& [name, of_seeds] : values) measured.set(name, mean_of(of_seeds));
    measured.set("violations", static_cast<double>(runs.totals.runs_with_violations));
    return measured;
}

std::optional<double> mean_of_column(const Measurements& measured, const std::string& column, const std::string& runs) {
    return measured.find(column + " " + runs);
}

std::optional<Answer> percent_answer(std::optional<double> value, std::optional<double> reference, double subtracted) {
    if (!value || !reference) return std::nullopt;
    return number_answer(100.0 * *value / *reference - subtracted);
}

}  // namespace stopline
