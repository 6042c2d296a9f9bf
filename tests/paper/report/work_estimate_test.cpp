// Estimates of the share done and of the remaining time of a list of jobs.
#include "paper/report/work_estimate.h"

#include <gtest/gtest.h>

namespace stopline {
namespace {

TEST(WorkEstimate, StartsFromTheExpectedDurations) {
    const WorkEstimate estimate({60.0, 40.0}, 2);
    EXPECT_DOUBLE_EQ(estimate.share(), 0.0);
    EXPECT_NEAR(estimate.remaining_s(0.0), 50.0, 1e-9);  // 100 s of work on two threads
}

TEST(WorkEstimate, IsExactAtTheExpectedPace) {
    WorkEstimate estimate({60.0, 40.0}, 1);
    estimate.begin(0, 0.0);
    estimate.progress(0.5);
    EXPECT_NEAR(estimate.share(), 0.3, 1e-9);
    EXPECT_NEAR(estimate.remaining_s(30.0), 70.0, 1e-9);
    estimate.end(60.0);
    estimate.begin(1, 60.0);
    estimate.progress(1.0);
    estimate.end(100.0);
    EXPECT_DOUBLE_EQ(estimate.share(), 1.0);
    EXPECT_NEAR(estimate.remaining_s(100.0), 0.0, 1e-9);
}

TEST(WorkEstimate, AdaptsToASlowMachine) {
    WorkEstimate estimate({1000.0, 1000.0}, 1);
    estimate.begin(0, 0.0);
    estimate.progress(1.0);
    estimate.end(3000.0);
    EXPECT_NEAR(estimate.remaining_s(3000.0), 3000.0, 100.0);
}

// A job that takes longer than expected says little about the other jobs.
TEST(WorkEstimate, CorrectsMostlyTheCurrentJob) {
    WorkEstimate estimate({100.0, 900.0}, 1);
    estimate.begin(0, 0.0);
    estimate.progress(0.5);
    const double remaining_s = estimate.remaining_s(200.0);  // four times slower than expected
    EXPECT_GT(remaining_s, 50.0 * 3.0 + 900.0);
    EXPECT_LT(remaining_s, 1000.0 * 4.5);
}

// Results that an earlier session has stored are no work of this session, and they say nothing about its speed.
TEST(WorkEstimate, ExcludesWorkOfEarlierSessions) {
    WorkEstimate estimate({500.0, 100.0, 100.0}, 1);
    estimate.skip(0);
    EXPECT_NEAR(estimate.remaining_s(0.0), 200.0, 1e-9);
    estimate.begin(1, 0.0);
    estimate.stored(0.9);
    EXPECT_DOUBLE_EQ(estimate.share(), 0.0);
    EXPECT_NEAR(estimate.remaining_s(0.0), 110.0, 1e-9);
    estimate.progress(0.95);
    EXPECT_NEAR(estimate.share(), 5.0 / 110.0, 1e-9);
    EXPECT_NEAR(estimate.remaining_s(5.0), 105.0, 1e-9);
}

// The share that a job reports can drop when the job reaches a part with fewer stored results. The estimated share must
// not drop.
TEST(WorkEstimate, NeverDecreases) {
    WorkEstimate estimate({100.0}, 1);
    estimate.begin(0, 0.0);
    estimate.progress(0.6);
    estimate.progress(0.2);
    EXPECT_NEAR(estimate.share(), 0.6, 1e-9);
    estimate.stored(0.1);
    EXPECT_NEAR(estimate.share(), 0.6, 1e-9);
}

}  // namespace
}  // namespace stopline
