#include "sim/performance/threading_heuristic.h"

#include <algorithm>

namespace stopline {

namespace {

constexpr int kTrialSteps = 16;          // a trial times this many steps with one thread, then as many with all threads
constexpr double kHopelessFactor = 3.0;  // a trial is aborted if all threads take this many times as long as one thread
constexpr int kMinSteps = 3;             // number of steps with all threads after which a trial may be aborted
constexpr double kPauseFactor = 100.0;   // ratio of the pause after a trial to the duration of the trial
constexpr double kMinPause_ns = 0.2e9;

}  // namespace

void ThreadingHeuristic::record_step(std::chrono::nanoseconds duration, int vehicles) {
    const auto ns = static_cast<double>(duration.count());
    if (!in_trial_) {
        pause_ns_ -= ns;
        if (pause_ns_ > 0.0) return;
        in_trial_ = true;
        use_threads_ = false;
        one_thread_ = all_threads_ = {};
        return;
    }
    Timing& timing = use_threads_ ? all_threads_ : one_thread_;
    ++timing.steps;
    timing.ns += ns;
    timing.vehicles += std::max(vehicles, 1);
    if (!use_threads_) {
        use_threads_ = timing.steps == kTrialSteps;
        return;
    }
    const bool hopeless =
        timing.steps >= kMinSteps && timing.ns_per_vehicle() > kHopelessFactor * one_thread_.ns_per_vehicle();
    if (timing.steps == kTrialSteps || hopeless) finish_trial();
}

void ThreadingHeuristic::finish_trial() {
    use_threads_ = all_threads_.ns_per_vehicle() < one_thread_.ns_per_vehicle();
    in_trial_ = false;
    pause_ns_ = std::max(kPauseFactor * (one_thread_.ns + all_threads_.ns), kMinPause_ns);
}

}  // namespace stopline
