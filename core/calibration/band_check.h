// Step II of the calibration (Section V.B of the paper). It checks for each permutation (combination of axis values of
// a sweep) whether the mean of the mesoscale mode lies in the confidence band of full dynamics. Both modes run the same
// sweep with the same seeds.
#pragma once

#include <string>
#include <vector>

#include "measure/confidence.h"
#include "sweeps/run_store.h"
#include "sweeps/sweep.h"

namespace stopline {

// One metric in one permutation. Means and confidence bands are over all seeds.
struct BandPoint {
    std::string permutation;  // axis values as text
    double full_mean = 0.0;
    double meso_mean = 0.0;
    Interval paper;    // band of full dynamics, by the formula of the paper
    Interval student;  // band of full dynamics, by Student's distribution
};

struct MetricBands {
    std::string metric;  // name of the result column
    std::vector<BandPoint> points;

    double share_inside(Band band) const;
    double mean_relative_difference() const;  // mean of |meso / full - 1|
    double mean_relative_bias() const;        // mean of (meso / full - 1), with its sign
    // For each point, the relative half width is half the width of the paper's band divided by full_mean. Returns the
    // median of this ratio over all points.
    double median_relative_half_width() const;
};

struct BandCheck {
    std::vector<MetricBands> metrics;
    std::size_t permutations = 0;

    // Returns the share of permutations in which every metric is inside its band.
    double share_inside(Band band) const;
};

// Returns the result columns to check: the columns in `named` or, if `named` is empty, the throughput, the first
// density and the first travel time that the results of the sweep have. Needs no run. Throws InputError if a named
// column does not exist or has no mean, if `named` is empty and the results lack all three, or if the sweep has fewer
// than three repetitions.
std::vector<std::string> band_metrics(const Sweep& sweep, const std::vector<std::string>& named);

// Compares two stores that hold all runs of `sweep`. Throws InputError for fewer than three repetitions.
BandCheck check_bands(const Sweep& sweep, const RunStore& full, const RunStore& meso,
                      const std::vector<std::string>& metrics);

std::string bands_csv(const BandCheck& check);

}  // namespace stopline
