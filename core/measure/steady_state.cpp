#include "measure/steady_state.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/arithmetic.h"

namespace stopline {

namespace {

// Sums of values and squares from the beginning.
struct Sums {
    std::vector<double> one{0.0};
    std::vector<double> two{0.0};

    explicit Sums(std::span<const double> values) {
        for (const double value : values) {
            one.push_back(one.back() + value);
            two.push_back(two.back() + square(value));
        }
    }
    double mean(std::size_t from, std::size_t to) const {
        return (one[to] - one[from]) / static_cast<double>(to - from);
    }
    // Sum of squared differences from the mean; 0 where it is no more than rounding.
    double spread(std::size_t from, std::size_t to) const {
        constexpr double kRounding = 1e-12;
        const double sum = two[to] - two[from] - square(one[to] - one[from]) / static_cast<double>(to - from);
        return sum > kRounding * two[to] ? sum : 0.0;
    }
};

}  // namespace

std::size_t warm_up(std::span<const double> values) {
    constexpr std::size_t kBatch = 5;
    std::vector<double> means;
    for (std::size_t k = 0; k + kBatch <= values.size(); k += kBatch) {
        double sum = 0.0;
        for (std::size_t i = 0; i < kBatch; ++i) sum += values[k + i];
        means.push_back(sum / static_cast<double>(kBatch));
    }
    const Sums sums(means);
    double best = std::numeric_limits<double>::infinity();
    std::size_t cut = 0;
    for (std::size_t k = 0; 2 * k < means.size(); ++k) {
        const auto rest = static_cast<double>(means.size() - k);
        const double score = sums.spread(k, means.size()) / square(rest);
        if (score < best) {
            best = score;
            cut = k;
        }
    }
    return cut * kBatch;
}

std::size_t first_full(std::span<const double> values) {
    constexpr double kFull = 0.9;
    const double highest = values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
    const auto full = std::find_if(values.begin(), values.end(), [&](double v) { return v >= kFull * highest; });
    return static_cast<std::size_t>(full - values.begin());
}

std::optional<Collapse> find_collapse(std::span<const double> values, double share) {
    constexpr std::size_t kFewest = kCollapseNeeds / 2;  // values on either side
    if (values.size() < kCollapseNeeds) return std::nullopt;
    const Sums sums(values);
    double least = std::numeric_limits<double>::infinity();
    std::size_t cut = kFewest;
    for (std::size_t k = kFewest; k + kFewest <= values.size(); ++k) {
        const double unexplained = sums.spread(0, k) + sums.spread(k, values.size());
        if (unexplained < least) {
            least = unexplained;
            cut = k;
        }
    }
    const Collapse found{cut, sums.mean(0, cut), sums.mean(cut, values.size())};
    const double variance = least / static_cast<double>(values.size() - 2);
    const double error =
        std::sqrt(variance / static_cast<double>(cut) + variance / static_cast<double>(values.size() - cut));
    const double drop = found.before - found.after;
    if (drop < share * found.before || drop <= 3.0 * error) return std::nullopt;
    const std::size_t last = std::max(kFewest, values.size() / 10);
    if (sums.mean(values.size() - last, values.size()) > (1.0 - share) * found.before) return std::nullopt;
    return found;
}

}  // namespace stopline
