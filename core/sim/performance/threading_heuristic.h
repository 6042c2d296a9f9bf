// Decides whether the next step uses one thread or all threads. If other programs use the processors, threads that wait
// for each other are much slower than a single thread. The results of a step do not depend on this choice.
//
// A trial times some steps with one thread, then some steps with all threads. The faster choice is kept until the next
// trial. The pause between two trials is so long that trials take only a small share of the run time.
#pragma once

#include <chrono>

namespace stopline {

class ThreadingHeuristic {
public:
    // Returns true if the next step should use all threads.
    bool use_threads() const { return use_threads_; }
    // Records the duration of a step and the number of vehicles that it moved.
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
    bool in_trial_ = true;  // a run begins with a trial
    Timing one_thread_;
    Timing all_threads_;
    double pause_ns_ = 0.0;  // remaining time until the next trial
};

}  // namespace stopline
