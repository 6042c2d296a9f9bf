#include "measure/counters.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/nan.h"

namespace stopline {

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
    return baseline > 0.0 ? 100.0 * (passed / baseline - 1.0) : kNan;
}

double mean_improvement_percent(const Counter& counter, const Counter& baseline, double from_s, double to_s) {
    constexpr double kStep_s = 0.05;
    if (!(to_s > from_s) || !(baseline.interpolated(from_s) > 0.0)) return kNan;
    const auto steps = static_cast<int>(std::ceil((to_s - from_s) / kStep_s));
    double sum = 0.0;
    for (int k = 0; k < steps; ++k) {
        const double time_s = from_s + (k + 0.5) / steps * (to_s - from_s);
        sum += improvement_percent(counter.interpolated(time_s), baseline.interpolated(time_s));
    }
    return sum / steps;
}

}  // namespace stopline
