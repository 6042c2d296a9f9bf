// Step II of the calibration (Section V.B): whether the mesoscale mode's means lie in the confidence bands of full dynamics,
// permutation by permutation. Both are sweeps over the same axes, with the same seeds.
#pragma once

#include <string>
#include <vector>

#include "experiment/gnuplot.h"
#include "experiment/run_store.h"
#include "experiment/sweep.h"
#include "measure/confidence.h"

namespace stopline {

// One metric of one permutation.
struct BandPoint {
    std::string permutation;  // values of the axes
    double full_mean = 0.0;
    double meso_mean = 0.0;
    Interval paper;
    Interval student;
};

struct MetricBands {
    std::string metric;  // column of the results
    std::vector<BandPoint> points;

    double share_inside(Band band) const;
    double mean_difference_share() const;    // mean of |meso / full - 1|
    double mean_shift_share() const;         // the same with its sign
    double median_half_width_share() const;  // of the paper's bands, over the mean
};

struct BandCheck {
    std::vector<MetricBands> metrics;
    std::size_t permutations = 0;

    // Share of the permutations with all metrics inside.
    double share_inside(Band band) const;
};

// The columns to be checked: throughput, density and travel time of the first zone of an intersection; throws InputError where
// the runs have no such results and none are named.
std::vector<std::string> band_metrics(const RunStore& full, const std::vector<std::string>& named);

// Stores with all points of sweeps over the same axes. Throws InputError for fewer than three repetitions.
BandCheck check_bands(const Sweep& sweep, const RunStore& full, const RunStore& meso,
                      const std::vector<std::string>& metrics);

std::string bands_csv(const BandCheck& check);

}  // namespace stopline
