#include "measure/confidence.h"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <boost/math/distributions/students_t.hpp>

#include "base/arithmetic.h"
#include "base/input_error.h"

namespace stopline {

namespace {

double sample_deviation(std::span<const double> values) {
    const double mean = mean_of(values);
    double sum = 0.0;
    for (const double value : values) sum += square(value - mean);
    return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double quantile(double share, double freedom) { return boost::math::quantile(boost::math::students_t(freedom), share); }

}  // namespace

double mean_of(std::span<const double> values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

Interval confidence_interval(std::span<const double> values, Band band) {
    const std::size_t least = band == Band::paper ? 3 : 2;
    if (values.size() < least) {
        throw InputError(
            fmt::format("a confidence band needs at least {} runs (repetitions), not {}", least, values.size()));
    }
    const auto n = static_cast<double>(values.size());
    const double factor =
        band == Band::paper ? quantile(0.95, n) / std::sqrt(0.5 * n - 1.0) : quantile(0.975, n - 1.0) / std::sqrt(n);
    const double mean = mean_of(values);
    const double half = factor * sample_deviation(values);
    return {mean - half, mean + half};
}

}  // namespace stopline
