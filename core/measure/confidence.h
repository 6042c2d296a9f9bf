// Confidence bands of a mean from a few runs, at 95 %.
//
//   student   mean -+ t(0.975, n - 1) s / sqrt(n): the two-sided interval of the textbooks
//   paper     mean -+ t(0.95, n) s / sqrt(n / 2 - 1): equation (2) of the paper as printed, with nu = n runs; for six runs
//             1.31 times as wide
//
// n runs, s their sample standard deviation, t(p, nu) the quantile of Student's distribution (MATLAB's tinv).
#pragma once

#include <span>

namespace stopline {

enum class Band { student, paper };

struct Interval {
    double low = 0.0;
    double high = 0.0;
    bool contains(double value) const { return value >= low && value <= high; }
};

double mean_of(std::span<const double> values);

// Needs two values or more (student), three or more (paper); throws InputError for fewer.
Interval confidence_interval(std::span<const double> values, Band band);

}  // namespace stopline
