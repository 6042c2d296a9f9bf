// When threads share a step: while it is faster, on clocks that are made up here.
#include <gtest/gtest.h>

#include <chrono>

#include "sim/performance/threading_heuristic.h"

namespace stopline {
namespace {

using std::chrono::nanoseconds;

constexpr int kVehicles = 5000;

struct Shares {
    int shared = 0;
    int steps = 0;
    double s = 0.0;  // in all

    double share() const { return static_cast<double>(shared) / steps; }
};

// Makes steps that take so long, shared or alone.
Shares make(ThreadingHeuristic& sharing, int steps, nanoseconds alone, nanoseconds shared) {
    Shares all;
    for (all.steps = 0; all.steps < steps; ++all.steps) {
        const nanoseconds took = sharing.use_threads() ? shared : alone;
        all.shared += sharing.use_threads() ? 1 : 0;
        all.s += 1e-9 * static_cast<double>(took.count());
        sharing.record_step(took, kVehicles);
    }
    return all;
}

constexpr nanoseconds kAlone(50'000);
constexpr nanoseconds kFaster(30'000);
constexpr nanoseconds kBusy(8'000'000);

TEST(Sharing, GoesOnWhileItIsFaster) {
    ThreadingHeuristic sharing;
    EXPECT_GT(make(sharing, 100'000, kAlone, kFaster).share(), 0.98);
}

TEST(Sharing, CostsLittleWhereItIsHopeless) {
    ThreadingHeuristic sharing;
    const int steps = 200'000;
    const Shares all = make(sharing, steps, kAlone, kBusy);
    EXPECT_GT(all.shared, 0) << "it is tried";
    EXPECT_LT(all.s, 1.02 * steps * 50e-6);
}

TEST(Sharing, StopsWhenOtherWorkComesAndBeginsAgainWhenItGoes) {
    ThreadingHeuristic sharing;
    EXPECT_GT(make(sharing, 20'000, kAlone, kFaster).share(), 0.95);
    const Shares busy = make(sharing, 100'000, kAlone, kBusy);
    EXPECT_LT(busy.s - 100'000 * 50e-6, 0.5) << "until it notices";
    make(sharing, 100'000, kAlone, kFaster);
    EXPECT_GT(make(sharing, 50'000, kAlone, kFaster).share(), 0.95);
}

TEST(Sharing, IsLeftWhereItIsALittleSlower) {
    ThreadingHeuristic sharing;
    EXPECT_LT(make(sharing, 100'000, kAlone, nanoseconds(55'000)).share(), 0.02);
}

}  // namespace
}  // namespace stopline
