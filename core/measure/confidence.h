// Confidence intervals of 95 % for the mean of a few runs.
//
//   student   mean -+ t(0.975, n - 1) s / sqrt(n): the usual two-sided interval
//   paper     mean -+ t(0.95, n) s / sqrt(n / 2 - 1): equation (2) of the paper as printed, with nu = n. For six runs
//             this interval is 1.31 times as wide as the student interval.
//
// Here n is the number of runs, s their sample standard deviation, and t(p, nu) the quantile of Student's distribution.
#pragma once

#include <span>

namespace stopline {

enum class Band { student, paper };

struct Interval {
    double low = 0.0;
    double high = 0.0;
    bool contains(double value) const { return value >= low && value <= high; }
};

// Returns the mean of at least one value.
double mean_of(std::span<const double> values);

// Returns the sample variance (with n - 1) of at least two values.
double variance_of(std::span<const double> values);

// Returns the confidence interval of the mean. Throws InputError for fewer than two values (student) or three (paper).
Interval confidence_interval(std::span<const double> values, Band band);

}  // namespace stopline
