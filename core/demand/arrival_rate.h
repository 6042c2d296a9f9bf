// A rate of arrivals that changes with time. The rate is piecewise linear.
#pragma once

#include <vector>

namespace stopline {

class ArrivalRate {
public:
    // Appends a piece that ends at `until_s`, on which the rate changes linearly. The first piece begins at 0 s. Rates
    // must not be below 0, and `until_s` must be above end_s().
    void append(double until_s, double begin_1ps, double end_1ps);

    double end_s() const { return pieces_.empty() ? 0.0 : pieces_.back().to_s; }
    // Returns the rate at a time. The rate is 0 before 0 s and from end_s() on.
    double rate_1ps(double time_s) const;
    double highest_1ps() const;
    // Returns the expected number of arrivals before a time: the integral of the rate.
    double expected(double time_s) const;
    // Returns the inverse of expected(): the first time at which that many arrivals are expected. Returns infinity if
    // fewer arrivals are expected before end_s().
    double time_of_s(double expected) const;

private:
    struct Piece {
        double from_s = 0.0;
        double to_s = 0.0;
        double begin_1ps = 0.0;
        double end_1ps = 0.0;
        double expected_before = 0.0;  // arrivals expected before from_s

        double slope_1ps2() const { return (end_1ps - begin_1ps) / (to_s - from_s); }
        double expected_within(double time_s) const;
    };
    std::vector<Piece> pieces_;
};

}  // namespace stopline
