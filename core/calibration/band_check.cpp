#include "calibration/band_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "base/io/csv.h"
#include "base/nearest_name.h"
#include "runs/metrics/metric_groups.h"
#include "runs/run_metrics.h"
#include "scenario/files/field_place.h"
#include "sweeps/sweep_results.h"

namespace stopline {

namespace {

constexpr int kMinRepetitions = 3;  // for the band of the paper, see confidence_interval()

// Returns one result column, in the order of the runs in the sweep. The value is NaN if a run lacks this result.
std::vector<double> column_of(const RunStore& store, const std::string& column, std::size_t points) {
    std::vector<double> values(points, std::nan(""));
    store.for_each_run([&](std::size_t point, const std::string& result) {
        const std::string text = value_in(result, column);
        if (!text.empty()) values.at(point) = std::strtod(text.c_str(), nullptr);
    });
    return values;
}

const Interval& interval_of(const BandPoint& point, Band band) {
    return band == Band::paper ? point.paper : point.student;
}

// Returns true if the mean of the mesoscale mode lies in the band. If all runs of full dynamics give the same value,
// the band has no width, so a tolerance allows for rounding.
bool inside(const BandPoint& point, Band band) {
    const double rounding = 1e-9 * std::max(1.0, std::abs(point.full_mean));
    const Interval& interval = interval_of(point, band);
    return point.meso_mean >= interval.low - rounding && point.meso_mean <= interval.high + rounding;
}

}  // namespace

double MetricBands::share_inside(Band band) const {
    const auto count = std::count_if(points.begin(), points.end(), [&](const BandPoint& p) { return inside(p, band); });
    return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(points.size(), 1));
}

double MetricBands::mean_relative_difference() const {
    double sum = 0.0;
    for (const BandPoint& p : points) sum += std::abs(p.meso_mean / p.full_mean - 1.0);
    return sum / static_cast<double>(std::max<std::size_t>(points.size(), 1));
}

double MetricBands::mean_relative_bias() const {
    double sum = 0.0;
    for (const BandPoint& p : points) sum += p.meso_mean / p.full_mean - 1.0;
    return sum / static_cast<double>(std::max<std::size_t>(points.size(), 1));
}

double MetricBands::median_relative_half_width() const {
    std::vector<double> widths;
    for (const BandPoint& p : points) widths.push_back(0.5 * (p.paper.high - p.paper.low) / p.full_mean);
    if (widths.empty()) return 0.0;
    const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
    std::nth_element(widths.begin(), middle, widths.end());
    return *middle;
}

double BandCheck::share_inside(Band band) const {
    std::size_t all_inside = 0;
    for (std::size_t k = 0; k < permutations; ++k) {
        const auto mean_is_inside = [&](const MetricBands& metric) { return inside(metric.points[k], band); };
        if (std::all_of(metrics.begin(), metrics.end(), mean_is_inside)) ++all_inside;
    }
    return static_cast<double>(all_inside) / static_cast<double>(std::max<std::size_t>(permutations, 1));
}

std::vector<std::string> band_metrics(const Sweep& sweep, const std::vector<std::string>& named) {
    const SweepSettings& settings = sweep.settings();
    if (settings.repetitions < kMinRepetitions) {
        throw InputError(
            fmt::format("{}: field 'repetitions': value {} is too small: a confidence band needs at least {} "
                        "runs with different seeds",
                        field_place(settings.file, {}, "repetitions"), settings.repetitions, kMinRepetitions));
    }
    std::vector<std::string> columns = result_columns(sweep.scenario(0));
    std::erase_if(columns, [](const std::string& column) { return !has_mean(column); });
    std::vector<std::string> chosen = named;
    for (const char* begin : {"throughput_veh_h", "density_", "travel_time_"}) {
        if (!named.empty()) break;
        const auto found = std::find_if(columns.begin(), columns.end(),
                                        [&](const std::string& column) { return column.starts_with(begin); });
        if (found != columns.end()) chosen.push_back(*found);
    }
    for (const std::string& metric : chosen) {
        if (std::find(columns.begin(), columns.end(), metric) != columns.end()) continue;
        throw InputError(fmt::format("--metric: the runs have no result '{}'{}", shortened(metric),
                                     known_names_hint(metric, columns)));
    }
    if (chosen.empty()) {
        throw InputError(fmt::format("the results to compare are unknown; name them with --metric, from: {}",
                                     fmt::join(columns, ", ")));
    }
    return chosen;
}

BandCheck check_bands(const Sweep& sweep, const RunStore& full, const RunStore& meso,
                      const std::vector<std::string>& metrics) {
    const auto repetitions = static_cast<std::size_t>(sweep.settings().repetitions);
    BandCheck check;
    check.permutations = sweep.points() / repetitions;
    for (const std::string& metric : metrics) {
        const std::vector<double> full_values = column_of(full, metric, sweep.points());
        const std::vector<double> meso_values = column_of(meso, metric, sweep.points());
        MetricBands bands{metric, {}};
        for (std::size_t k = 0; k < check.permutations; ++k) {
            const std::span<const double> full_runs(full_values.data() + k * repetitions, repetitions);
            const std::span<const double> meso_runs(meso_values.data() + k * repetitions, repetitions);
            const std::string text = sweep.describe(k * repetitions);
            bands.points.push_back({text.substr(0, text.rfind(", seed")), mean_of(full_runs), mean_of(meso_runs),
                                    confidence_interval(full_runs, Band::paper),
                                    confidence_interval(full_runs, Band::student)});
        }
        check.metrics.push_back(std::move(bands));
    }
    return check;
}

std::string bands_csv(const BandCheck& check) {
    CsvWriter csv({"permutation", "metric", "full_mean", "meso_mean", "paper_low", "paper_high", "student_low",
                   "student_high", "inside_paper", "inside_student"});
    for (const MetricBands& metric : check.metrics) {
        for (const BandPoint& p : metric.points) {
            csv.row({p.permutation, metric.metric, fixed(p.full_mean, 4), fixed(p.meso_mean, 4), fixed(p.paper.low, 4),
                     fixed(p.paper.high, 4), fixed(p.student.low, 4), fixed(p.student.high, 4),
                     inside(p, Band::paper) ? "1" : "0", inside(p, Band::student) ? "1" : "0"});
        }
    }
    return csv.text();
}

}  // namespace stopline
