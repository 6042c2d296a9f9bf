// Whether several threads share a step: while that is faster than one alone. Where other work runs beside them, or fewer processors are to be had
// than there seem to be, threads that wait for each other without sleep take many times as long. Results are the same either way.
//
// Some steps are made either way and timed, and the faster way is kept. It is tried again after a time that a trial cannot have cost more
// than a small part of.
#pragma once

#include <chrono>

namespace stopline {

class Sharing {
public:
    // Before a step, and after it with what it took and how many vehicles there were.
    bool shares() const { return shares_; }
    void made(std::chrono::nanoseconds took, int vehicles);

private:
    // Steps of one way.
    struct Trial {
        int steps = 0;
        double ns = 0.0;
        double vehicles = 0.0;

        double ns_a_vehicle() const { return ns / vehicles; }
    };
    void decide();

    bool shares_ = false;  // in the next step
    bool trying_ = true;   // the steps alone first, then those that are shared
    Trial alone_;
    Trial shared_;
    double rest_ns_ = 0.0;  // until the next trial
};

}  // namespace stopline
