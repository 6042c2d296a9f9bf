#include "record/recording/snapshot_worker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace stopline {
namespace {

void submit(SnapshotWorker& worker, std::int64_t tick) {
    worker.acquire().tick = tick;
    worker.submit();
}

TEST(SnapshotWorker, WorksOffEachSnapshotOnceInOrderThoughItIsSlower) {
    std::vector<std::int64_t> seen;
    SnapshotWorker worker([&](const Snapshot& shot) {
        if (shot.tick % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        seen.push_back(shot.tick);
    });
    for (std::int64_t tick = 0; tick < 100; ++tick) submit(worker, tick);
    worker.finish();
    ASSERT_EQ(seen.size(), 100U);
    for (std::int64_t tick = 0; tick < 100; ++tick) EXPECT_EQ(seen[static_cast<std::size_t>(tick)], tick);
}

TEST(SnapshotWorker, HandsOnWhatTheWorkThrowsAndDoesNoMore) {
    int worked = 0;
    const auto fail = [&](const Snapshot& shot) {
        ++worked;
        if (shot.tick == 3) throw std::runtime_error("the disk is full");
    };
    SnapshotWorker worker(fail);
    EXPECT_THROW(
        {
            for (std::int64_t tick = 0; tick < 1000; ++tick) submit(worker, tick);
        },
        std::runtime_error);
    EXPECT_THROW(worker.finish(), std::runtime_error);
    EXPECT_EQ(worked, 4);
}

TEST(SnapshotWorker, FinishSaysThatTheLastOneFailed) {
    SnapshotWorker worker([](const Snapshot&) { throw std::runtime_error("the disk is full"); });
    submit(worker, 0);
    EXPECT_THROW(worker.finish(), std::runtime_error);
}

TEST(SnapshotWorker, EndsWithoutBeingFinished) {
    SnapshotWorker worker([](const Snapshot&) { std::this_thread::sleep_for(std::chrono::milliseconds(5)); });
    for (std::int64_t tick = 0; tick < 5; ++tick) submit(worker, tick);
}

}  // namespace
}  // namespace stopline
