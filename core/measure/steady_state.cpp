#include "measure/steady_state.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/simd/arithmetic.h"

namespace stopline {

namespace {

// Cumulative sums of the values and of their squares.
struct Sums {
    std::vector<double> values{0.0};
    std::vector<double> squares{0.0};

    explicit Sums(std::span<const double> series) {
        for (const double value : series) {
            values.push_back(values.back() + value);
            squares.push_back(squares.back() + square(value));
        }
    }
    double mean(std::size_t from, std::size_t to) const {
        return (values[to] - values[from]) / static_cast<double>(to - from);
    }
    // Returns the sum of squared deviations from the mean, or 0 if it is only a rounding error.
    double squared_deviations(std::size_t from, std::size_t to) const {
        constexpr double kRounding = 1e-12;
        const double sum =
            squares[to] - squares[from] - square(values[to] - values[from]) / static_cast<double>(to - from);
        return sum > kRounding * squares[to] ? sum : 0.0;
    }
};

}  // namespace

std::size_t warm_up(std::span<const double> values) {
    constexpr std::size_t kBatch = 5;
    if (values.size() < kMinWarmUpValues) return 0;
    std::vector<double> means;
    for (std::size_t k = 0; k + kBatch <= values.size(); k += kBatch) {
        double sum = 0.0;
        for (std::size_t i = 0; i < kBatch; ++i) sum += values[k + i];
        means.push_back(sum / static_cast<double>(kBatch));
    }
    const Sums sums(means);
    double lowest_score = std::numeric_limits<double>::infinity();
    std::size_t cut = 0;
    for (std::size_t k = 0; 2 * k < means.size(); ++k) {
        const auto rest = static_cast<double>(means.size() - k);
        const double score = sums.squared_deviations(k, means.size()) / square(rest);
        if (score < lowest_score) {
            lowest_score = score;
            cut = k;
        }
    }
    return cut * kBatch;
}

std::size_t rise_end(std::span<const double> values) {
    constexpr double kRisenShare = 0.9;
    const double highest = values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
    const auto risen = std::find_if(values.begin(), values.end(), [&](double v) { return v >= kRisenShare * highest; });
    return static_cast<std::size_t>(risen - values.begin());
}

std::optional<Collapse> find_collapse(std::span<const double> values, double share) {
    constexpr std::size_t kMinSide = kMinCollapseValues / 2;  // fewest values on each side of the cut
    if (values.size() < kMinCollapseValues) return std::nullopt;
    const Sums sums(values);
    double smallest = std::numeric_limits<double>::infinity();
    std::size_t cut = kMinSide;
    for (std::size_t k = kMinSide; k + kMinSide <= values.size(); ++k) {
        const double deviations = sums.squared_deviations(0, k) + sums.squared_deviations(k, values.size());
        if (deviations < smallest) {
            smallest = deviations;
            cut = k;
        }
    }
    const Collapse found{cut, sums.mean(0, cut), sums.mean(cut, values.size())};
    const double variance = smallest / static_cast<double>(values.size() - 2);
    const double error =
        std::sqrt(variance / static_cast<double>(cut) + variance / static_cast<double>(values.size() - cut));
    const double drop = found.before - found.after;
    if (drop < share * found.before || drop <= 3.0 * error) return std::nullopt;
    const std::size_t last_tenth = std::max(kMinSide, values.size() / 10);
    if (sums.mean(values.size() - last_tenth, values.size()) > (1.0 - share) * found.before) return std::nullopt;
    return found;
}

}  // namespace stopline
