// A vehicle counter at a line: how many fronts have passed by a time, and what two counters say of each other. Counts are
// whole vehicles, and one vehicle is the resolution of an experiment with one queue.
#pragma once

#include <vector>

namespace stopline {

class Counter {
public:
    // Times at which fronts pass, in seconds from the moment that counting starts; in any order.
    explicit Counter(std::vector<double> times_s);

    // Vehicles that have passed at `time_s`, the one that passes just then included.
    int passed(double time_s) const;

    // The same as a line instead of steps: k at the k-th passage, growing evenly between two passages (from 0 at time 0).
    // Tells two policies with equal counts apart. It stays at the last count after the last passage.
    double interpolated(double time_s) const;

    int total() const { return static_cast<int>(times_s_.size()); }
    const std::vector<double>& times_s() const { return times_s_; }

private:
    std::vector<double> times_s_;
};

// By how much `passed` is more than `baseline`, in percent; NaN for a baseline of zero.
double improvement_percent(double passed, double baseline);

// The improvement of one counter over another as a function of time (Fig. 6), averaged over the time from `from_s` to `to_s`.
// Of interpolated counts: rounding both down to whole vehicles would raise the ratio. NaN where the interval is empty or the
// baseline has nothing at its beginning.
double mean_improvement_percent(const Counter& counter, const Counter& baseline, double from_s, double to_s);

}  // namespace stopline
