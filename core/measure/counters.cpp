#include "measure/counters.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace stopline {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

void add_times_within(const Counter& counter, double from_s, double to_s, std::vector<double>& times_s) {
    for (const double time_s : counter.times_s()) {
        if (time_s > from_s && time_s < to_s) times_s.push_back(time_s);
    }
}

}  // namespace

Counter::Counter(std::vector<double> times_s) : times_s_(std::move(times_s)) {
    std::sort(times_s_.begin(), times_s_.end());
}

int Counter::passed(double time_s) const {
    return static_cast<int>(std::upper_bound(times_s_.begin(), times_s_.end(), time_s) - times_s_.begin());
}

double Counter::interpolated(double time_s) const {
    const auto next = std::upper_bound(times_s_.begin(), times_s_.end(), time_s);
    const auto count = static_cast<double>(next - times_s_.begin());
    if (next == times_s_.end()) return count;
    const double before_s = next == times_s_.begin() ? 0.0 : *(next - 1);
    return count + std::max(0.0, time_s - before_s) / (*next - before_s);
}

double improvement_percent(double passed, double baseline) {
    return baseline > 0.0 ? 100.0 * (passed / baseline - 1.0) : kNone;
}

double mean_improvement_percent(const Counter& counter, const Counter& baseline, double from_s, double to_s) {
    if (!(to_s > from_s) || baseline.passed(from_s) == 0) return kNone;
    std::vector<double> edges_s{from_s, to_s};
    add_times_within(counter, from_s, to_s, edges_s);
    add_times_within(baseline, from_s, to_s, edges_s);
    std::sort(edges_s.begin(), edges_s.end());
    double integral = 0.0;
    for (std::size_t k = 0; k + 1 < edges_s.size(); ++k) {
        const double now = improvement_percent(counter.passed(edges_s[k]), baseline.passed(edges_s[k]));
        integral += now * (edges_s[k + 1] - edges_s[k]);
    }
    return integral / (to_s - from_s);
}

}  // namespace stopline
