// Counts of vehicle fronts that pass a line over time, and the comparison of two such counts. A count is a whole number
// of vehicles; interpolation refines it.
#pragma once

#include <vector>

namespace stopline {

class Counter {
public:
    // Takes the times at which fronts pass, in s from the start of counting and in any order.
    explicit Counter(std::vector<double> times_s);

    // Returns the number of vehicles that have passed up to and including `time_s`.
    int passed(double time_s) const;

    // Returns the interpolated count. It is k at the time of the k-th passage, grows linearly between passages (from 0
    // at time 0), and is constant after the final passage. The interpolated count can distinguish two policies whose
    // whole counts are equal.
    double interpolated(double time_s) const;

    int total() const { return static_cast<int>(times_s_.size()); }
    const std::vector<double>& times_s() const { return times_s_; }

private:
    std::vector<double> times_s_;
};

// Returns the increase of `passed` over `baseline` in percent, or NaN if the baseline is not positive.
double improvement_percent(double passed, double baseline);

// Returns the improvement of a counter over the baseline in percent, averaged over the time from `from_s` to `to_s`
// (Fig. 6 of the paper). The function uses interpolated counts, because rounding both counts down to whole vehicles
// would exaggerate the improvement. Returns NaN if the interval is empty or the count of the baseline is 0 at the start
// of the interval.
double mean_improvement_percent(const Counter& counter, const Counter& baseline, double from_s, double to_s);

}  // namespace stopline
