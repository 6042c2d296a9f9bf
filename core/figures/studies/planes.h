// The results of a sweep over several intersections, arranged for its figures. Each figure has an x axis. If two axes
// vary, it also has a line axis, with one line for each value. All other axes are constant in a figure. The results for
// one combination of the values of these other axes are called a plane. Each plane has figures of its own.
//
// As in the paper, the x axis is the axis `green` (green time) and the line axis is the axis `offset`, provided that
// the sweep has both axes and at least one of them varies. Otherwise the first one or two numeric axes that vary are
// used. If no numeric axis varies, the x axis is the last axis of texts that varies. An axis with a single value
// appears in the title only.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/io/csv.h"
#include "runs/metrics/metric_groups.h"
#include "sweeps/sweep.h"

namespace stopline {

inline constexpr const char* kGreenColumn = "green_s";
inline constexpr const char* kOffsetColumn = "offset_s";

struct SweepMetric {
    std::string column;
    std::string name;
    std::string unit;
    std::string change;  // axis label of the change; {} is replaced by the name of the baseline
    Better better = Better::higher;

    std::string label() const { return name + " [" + unit + "]"; }
    // 1: the change is positive if the metric rises; -1: it is positive if the metric falls.
    double sign() const { return better == Better::lower ? -1.0 : 1.0; }
    // True if a positive change is an improvement.
    bool improves() const { return better != Better::neither; }
};

// Returns the metrics that the figures of a sweep show, one for each column of panels. Takes the first group for which
// the table has a column for every metric with SweepPanels. Returns nothing if there is no such group.
std::vector<SweepMetric> sweep_metrics(const CsvTable& results, const std::string& population_column,
                                       const std::vector<MetricGroup>& groups = metric_groups());

// The x axis or the line axis of a figure.
struct PlotAxis {
    std::string column;                     // name of the results column; empty if there is no such axis
    std::string name;                       // such as "green"
    std::string unit;                       // such as "s"; empty: the values have no unit
    std::vector<double> values = {0.0};     // ascending; a single 0 if there is no such axis
    std::vector<std::string> value_titles;  // [value] text such as "green 15 s"; empty if there is no such axis
    // [value] The values of an axis without numbers, such as "off" and "cooperative". `values` are then 0, 1, 2 and so
    // on. Empty for an axis with numbers.
    std::vector<std::string> texts;

    bool exists() const { return !column.empty(); }
    bool has_numbers() const { return texts.empty(); }
    std::string label() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

// Place of a result in a plane: index of the x value, of the value on the line axis, and of the population.
struct PlanePoint {
    std::size_t x = 0;
    std::size_t line = 0;
    std::size_t population = 0;
    auto operator<=>(const PlanePoint&) const = default;
};

// The mean over the seeds and its 95 % confidence interval (Student). With fewer than three seeds, low and high equal
// the mean.
struct SeedSpread {
    double mean;
    double low;
    double high;
};

class SweepPlane {
public:
    std::string title;  // values of the axes that are constant in the plane

    void add(std::size_t metric, const PlanePoint& point, const std::string& seed, double value) {
        values_[{metric, point}][seed] = value;
    }
    void add_stability(const PlanePoint& point, std::size_t stability) { stability_[point].push_back(stability); }

    bool has(std::size_t metric) const;
    std::optional<SeedSpread> value(std::size_t metric, const PlanePoint& point) const;
    // Returns the change against the baseline (population 0) in percent of the mean of the baseline. It is the mean of
    // the differences between runs with the same seed, with its confidence interval. `sign` is SweepMetric::sign().
    std::optional<SeedSpread> change(std::size_t metric, const PlanePoint& point, double sign) const;
    // Returns the numbers of seeds that are stable, semi-stable and unstable.
    std::array<std::size_t, 3> stabilities(const PlanePoint& point) const;

private:
    using Seeds = std::map<std::string, double>;
    const Seeds* seeds(std::size_t metric, const PlanePoint& point) const;

    std::map<std::pair<std::size_t, PlanePoint>, Seeds> values_;
    std::map<PlanePoint, std::vector<std::size_t>> stability_;
};

struct SweepPlanes {
    PlotAxis x_axis;
    PlotAxis line_axis;
    std::vector<SweepMetric> metrics;         // one for each column of panels
    std::vector<std::string> populations;     // the first one is the baseline
    std::vector<std::string> names_in_order;  // the populations in the order of the results
    std::size_t seeds = 1;
    bool has_stability = false;  // true: the results say whether each run is stable
    std::vector<SweepPlane> planes;

    // Returns the title of the figures of a plane, which may be empty. `seed_note` is appended if there are several
    // seeds; its {} is replaced by their number.
    std::string title(const SweepPlane& plane, const std::string& seed_note) const;
    std::string change_label(const SweepMetric& metric) const;  // contains the name of the baseline
};

// Returns true if the table has the metrics of runs over several intersections.
bool has_network_metrics(const CsvTable& results, const std::string& population_column);

// Returns the columns of all axes except the population axis.
std::vector<std::string> axis_columns(const CsvTable& results, const std::string& population_column);

// Highest number of planes that get figures. A plane is one combination of values of the axes that are constant in a
// figure. A sweep with more planes gets figures only if its x axis is the axis `green` and its line axis is the axis
// `offset`.
inline constexpr std::size_t kMaxPlanes = 24;

// Arranges the results in planes. `baseline` is the population with which the others are compared. If the results do
// not have it, the first population of the results takes its place. Returns nothing if no axis of the sweep can be the
// x axis, or if there are too many planes (see kMaxPlanes).
std::optional<SweepPlanes> sweep_planes(const CsvTable& results, const CellTitles& titles,
                                        const std::string& population_column, const std::string& baseline,
                                        const std::vector<MetricGroup>& groups = metric_groups());

}  // namespace stopline
