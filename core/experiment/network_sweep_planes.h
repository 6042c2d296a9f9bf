// The table of results of a sweep over several intersections, as its figures take it: one plane for each combination of the axes that are
// not drawn over, in it a value for each place on the drawn axes, population and seed.
//
// Drawn over are green (across) and offset (a line each), as in the paper, where both are axes and one of them has two values; else the first
// one or two axes of numbers. An axis of one value is not drawn over: it stands in the title.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiment/csv.h"
#include "experiment/sweep.h"

namespace stopline {

inline constexpr const char* kGreenColumn = "green_s";
inline constexpr const char* kOffsetColumn = "offset_s";

struct SweepMetric {
    const char* column;
    const char* name;
    const char* unit;
    const char* change;  // {}: the population that is compared with
    double sign;         // of the change that these words count as positive
    bool improves;       // with a positive change; not so density: there may just be less traffic

    std::string label() const { return std::string(name) + " [" + unit + "]"; }
};
inline constexpr std::array<SweepMetric, 3> kSweepMetrics{
    SweepMetric{"throughput_veh_h", "throughput", "veh/h", "throughput: higher than with {} by [%]", 1.0, true},
    SweepMetric{"travel_time_s", "travel time", "s", "travel time: shorter than with {} by [%]", -1.0, true},
    SweepMetric{"density_percent", "density", "%", "density: change from {} [%]", 1.0, false}};

// An axis that figures are drawn over.
struct DrawnAxis {
    std::string column;                  // empty: there is none, and one value stands for it
    std::string name;                    // green
    std::string unit;                    // s; empty: plain numbers
    std::vector<double> values = {0.0};  // ascending
    std::vector<std::string> words;      // [value] "green 15 s"; empty where there is none

    bool there() const { return !column.empty(); }
    std::string label() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

// By index: on the axis across, on that of the lines, of the population.
struct SweepPlace {
    std::size_t across = 0;
    std::size_t line = 0;
    std::size_t population = 0;
    auto operator<=>(const SweepPlace&) const = default;
};

// Mean, least and greatest of the seeds.
struct SeedSpread {
    double mean;
    double least;
    double greatest;
};

class SweepPlane {
public:
    std::string title;  // what sets it apart: the other axes

    void add(std::size_t metric, const SweepPlace& place, const std::string& seed, double value) {
        values_[{metric, place}][seed] = value;
    }
    void add_stability(const SweepPlace& place, std::size_t stability) { stability_[place].push_back(stability); }

    bool has(std::size_t metric) const;
    std::optional<SeedSpread> value(std::size_t metric, const SweepPlace& place) const;
    // In percent of the first population: of means; least and greatest are of runs with the same seed.
    std::optional<SeedSpread> change(std::size_t metric, const SweepPlace& place) const;
    // How many seeds are stable, semi-stable and unstable.
    std::array<std::size_t, 3> stabilities(const SweepPlace& place) const;

private:
    using Seeds = std::map<std::string, double>;
    const Seeds* seeds(std::size_t metric, const SweepPlace& place) const;

    std::map<std::pair<std::size_t, SweepPlace>, Seeds> values_;
    std::map<SweepPlace, std::vector<std::size_t>> stability_;
};

struct SweepPlanes {
    DrawnAxis across;
    DrawnAxis lines;
    std::vector<std::string> populations;
    std::size_t seeds = 1;
    std::vector<SweepPlane> planes;

    // Of a figure; empty where there is nothing to say. `of_seeds`: what it shows of several seeds, {} of them.
    std::string title(const SweepPlane& plane, const std::string& of_seeds) const;
    std::string change_label(const SweepMetric& metric) const;  // with whom it is compared
};

// Whether the table has the metrics of several intersections.
bool has_network_metrics(const CsvTable& results, const std::string& population_column);

// Columns of the axes but that of the populations.
std::vector<std::string> axis_columns(const CsvTable& results, const std::string& population_column);

// Of other axes than green and offset no more are drawn.
inline constexpr std::size_t kMostPlanes = 24;

// Nothing where there is no axis of numbers to draw over, or there would be too many planes.
std::optional<SweepPlanes> sweep_planes(const CsvTable& results, const CellTitles& titles,
                                        const std::string& population_column);

}  // namespace stopline
