// Several threads share the work of a step only while that is faster than one thread. The durations of steps are made
// up.
#include <gtest/gtest.h>

#include <chrono>

#include "sim/performance/threading_heuristic.h"

namespace stopline {
namespace {

using std::chrono::nanoseconds;

constexpr int kVehicles = 5000;

struct Totals {
    int threaded_steps = 0;
    int steps = 0;
    double duration_s = 0.0;

    double threaded_share() const { return static_cast<double>(threaded_steps) / steps; }
};

// Records steps that take the given time with one thread or with all threads, as the heuristic decides.
Totals run_steps(ThreadingHeuristic& heuristic, int steps, nanoseconds one_thread, nanoseconds all_threads) {
    Totals totals;
    for (totals.steps = 0; totals.steps < steps; ++totals.steps) {
        const nanoseconds duration = heuristic.use_threads() ? all_threads : one_thread;
        totals.threaded_steps += heuristic.use_threads() ? 1 : 0;
        totals.duration_s += 1e-9 * static_cast<double>(duration.count());
        heuristic.record_step(duration, kVehicles);
    }
    return totals;
}

constexpr nanoseconds kOneThread(50'000);
constexpr nanoseconds kFasterThreads(30'000);
constexpr nanoseconds kStalledThreads(8'000'000);  // other programs use the processors

TEST(ThreadingHeuristic, KeepsThreadsWhileTheyAreFaster) {
    ThreadingHeuristic heuristic;
    EXPECT_GT(run_steps(heuristic, 100'000, kOneThread, kFasterThreads).threaded_share(), 0.98);
}

TEST(ThreadingHeuristic, TrialsCostLittleWhileThreadsStall) {
    ThreadingHeuristic heuristic;
    const int steps = 200'000;
    const Totals totals = run_steps(heuristic, steps, kOneThread, kStalledThreads);
    EXPECT_GT(totals.threaded_steps, 0) << "threads are tried";
    EXPECT_LT(totals.duration_s, 1.02 * steps * 50e-6);
}

TEST(ThreadingHeuristic, DropsStalledThreadsAndResumesThemLater) {
    ThreadingHeuristic heuristic;
    EXPECT_GT(run_steps(heuristic, 20'000, kOneThread, kFasterThreads).threaded_share(), 0.95);
    const Totals stalled = run_steps(heuristic, 100'000, kOneThread, kStalledThreads);
    EXPECT_LT(stalled.duration_s - 100'000 * 50e-6, 0.5) << "time lost until the threads are dropped";
    run_steps(heuristic, 100'000, kOneThread, kFasterThreads);
    EXPECT_GT(run_steps(heuristic, 50'000, kOneThread, kFasterThreads).threaded_share(), 0.95);
}

TEST(ThreadingHeuristic, DropsThreadsThatAreSlightlySlower) {
    ThreadingHeuristic heuristic;
    EXPECT_LT(run_steps(heuristic, 100'000, kOneThread, nanoseconds(55'000)).threaded_share(), 0.02);
}

}  // namespace
}  // namespace stopline
