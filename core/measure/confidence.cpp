#include "measure/confidence.h"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <boost/math/distributions/students_t.hpp>

#include "base/input_error.h"
#include "base/simd/arithmetic.h"

namespace stopline {

namespace {

double quantile(double probability, double degrees_of_freedom) {
    return boost::math::quantile(boost::math::students_t(degrees_of_freedom), probability);
}

}  // namespace

double mean_of(std::span<const double> values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

double variance_of(std::span<const double> values) {
    const double mean = mean_of(values);
    double sum = 0.0;
    for (const double value : values) sum += square(value - mean);
    return sum / static_cast<double>(values.size() - 1);
}

Interval confidence_interval(std::span<const double> values, Band band) {
    const std::size_t min_runs = band == Band::paper ? 3 : 2;
    if (values.size() < min_runs) {
        throw InputError(
            fmt::format("a confidence interval needs at least {} runs (repetitions), not {}", min_runs, values.size()));
    }
    const auto n = static_cast<double>(values.size());
    const double factor =
        band == Band::paper ? quantile(0.95, n) / std::sqrt(0.5 * n - 1.0) : quantile(0.975, n - 1.0) / std::sqrt(n);
    const double mean = mean_of(values);
    const double half_width = factor * std::sqrt(variance_of(values));
    return {mean - half_width, mean + half_width};
}

}  // namespace stopline
