#include "sweeps/seed_means.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/io/csv.h"
#include "measure/confidence.h"
#include "runs/metrics/metric_groups.h"

namespace stopline {

namespace {

using Row = const std::vector<std::string>*;

// All runs with the same axis values. These runs differ only in their seed.
struct Combination {
    std::vector<std::string> axes;    // axis values, including the population
    std::map<std::string, Row> runs;  // seed -> row of the result table
};

std::vector<std::string> axes_of(const CsvTable& results, const std::vector<std::string>& row) {
    const std::size_t seed = results.column("seed");
    return {row.begin() + 1, row.begin() + static_cast<std::ptrdiff_t>(seed)};
}

std::vector<Combination> combinations_of(const CsvTable& results) {
    const std::size_t seed = results.column("seed");
    std::vector<Combination> all;
    std::map<std::vector<std::string>, std::size_t> known;
    for (const std::vector<std::string>& row : results.rows) {
        const std::vector<std::string> axes = axes_of(results, row);
        const auto [found, fresh] = known.try_emplace(axes, all.size());
        if (fresh) all.push_back({axes, {}});
        all[found->second].runs[row[seed]] = &row;
    }
    return all;
}

struct Interval95 {
    double mean = std::numeric_limits<double>::quiet_NaN();
    double low = std::numeric_limits<double>::quiet_NaN();
    double high = std::numeric_limits<double>::quiet_NaN();
};

Interval95 interval_of(const std::vector<double>& values) {
    if (values.size() < 2) return {};
    const Interval interval = confidence_interval(values, Band::student);
    return {mean_of(values), interval.low, interval.high};
}

void add_cells(const Interval95& interval, std::vector<std::string>& row) {
    for (const double value : {interval.mean, interval.low, interval.high}) row.push_back(fixed(value, 4));
}

// Returns the combination with which `one` is compared. All its axis values except the population equal those of `one`,
// and its population is `baseline`. If there is none, returns the first combination in the table with these axis
// values. `population` is the index of the population in Combination::axes.
const Combination& baseline_of(const std::vector<Combination>& all, const Combination& one, std::size_t population,
                               const std::string& baseline) {
    const auto has_same_axes = [&](const Combination& other) {
        for (std::size_t k = 0; k < one.axes.size(); ++k) {
            if (k != population && other.axes[k] != one.axes[k]) return false;
        }
        return true;
    };
    const auto is_baseline = [&](const Combination& other) {
        return other.axes[population] == baseline && has_same_axes(other);
    };
    const auto found = std::find_if(all.begin(), all.end(), is_baseline);
    return found != all.end() ? *found : *std::find_if(all.begin(), all.end(), has_same_axes);
}

}  // namespace

bool has_seeds(const CsvTable& results) {
    if (std::find(results.columns.begin(), results.columns.end(), "seed") == results.columns.end()) return false;
    const std::vector<Combination> all = combinations_of(results);
    return std::any_of(all.begin(), all.end(), [](const Combination& c) { return c.runs.size() > 1; });
}

std::string seed_means_csv(const CsvTable& results, const std::string& population_column, const std::string& baseline) {
    const std::size_t seed = results.column("seed");
    const std::size_t population = results.column(population_column) - 1;
    std::vector<std::string> columns(results.columns.begin() + 1,
                                     results.columns.begin() + static_cast<std::ptrdiff_t>(seed));
    for (const char* const name : {"metric", "runs", "mean", "ci95_low", "ci95_high", "difference",
                                   "difference_ci95_low", "difference_ci95_high"}) {
        columns.emplace_back(name);
    }
    CsvWriter csv(columns);
    const std::vector<Combination> all = combinations_of(results);
    for (const Combination& one : all) {
        const Combination& base = baseline_of(all, one, population, baseline);
        for (std::size_t metric = seed + 1; metric < results.columns.size(); ++metric) {
            if (!has_mean(results.columns[metric])) continue;
            std::vector<double> values;
            std::vector<double> differences;
            for (const auto& [number, row] : one.runs) {
                const std::optional<double> value = parse_number((*row)[metric]);
                if (!value) continue;
                values.push_back(*value);
                const auto other = base.runs.find(number);
                if (&base == &one || other == base.runs.end()) continue;
                if (const std::optional<double> before = parse_number((*other->second)[metric])) {
                    differences.push_back(*value - *before);
                }
            }
            if (values.empty()) continue;
            std::vector<std::string> row = one.axes;
            row.push_back(results.columns[metric]);
            row.push_back(std::to_string(values.size()));
            add_cells(interval_of(values), row);
            add_cells(interval_of(differences), row);
            csv.row(row);
        }
    }
    return csv.text();
}

}  // namespace stopline
