// Decides whether threads share the next step. Threads that wait for each other are much slower than one thread if
// other programs use the processors. Results are the same either way.
//
// A trial times some steps with one thread and some with all threads. The faster way is kept until the next trial,
// which begins after a pause. The pause is so long that trials take a small share of the time.
#pragma once

#include <chrono>

namespace stopline {

class ThreadingHeuristic {
public:
    // Returns true if threads should share the next step.
    bool use_threads() const { return use_threads_; }
    // Records the duration of a step and the number of vehicles in it.
    void record_step(std::chrono::nanoseconds duration, int vehicles);

private:
    struct Timing {
        int steps = 0;
        double ns = 0.0;
        double vehicles = 0.0;

        double ns_per_vehicle() const { return ns / vehicles; }
    };
    void finish_trial();

    bool use_threads_ = false;
    bool in_trial_ = true;  // a trial times one thread first
    Timing one_thread_;
    Timing all_threads_;
    double pause_ns_ = 0.0;  // time until the next trial
};

}  // namespace stopline
