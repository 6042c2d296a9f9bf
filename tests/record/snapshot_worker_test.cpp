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

TEST(SnapshotWorker, ProcessesEachSnapshotOnceInOrder) {
    std::vector<std::int64_t> ticks;
    SnapshotWorker worker([&](const Snapshot& snapshot) {
        if (snapshot.tick % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        ticks.push_back(snapshot.tick);
    });
    for (std::int64_t tick = 0; tick < 100; ++tick) submit(worker, tick);
    worker.finish();
    ASSERT_EQ(ticks.size(), 100U);
    for (std::int64_t tick = 0; tick < 100; ++tick) EXPECT_EQ(ticks[static_cast<std::size_t>(tick)], tick);
}

TEST(SnapshotWorker, RethrowsTheErrorAndStopsWorking) {
    int calls = 0;
    const auto fail = [&](const Snapshot& snapshot) {
        ++calls;
        if (snapshot.tick == 3) throw std::runtime_error("the disk is full");
    };
    SnapshotWorker worker(fail);
    EXPECT_THROW(
        {
            for (std::int64_t tick = 0; tick < 1000; ++tick) submit(worker, tick);
        },
        std::runtime_error);
    EXPECT_THROW(worker.finish(), std::runtime_error);
    EXPECT_EQ(calls, 4);
}

TEST(SnapshotWorker, FinishRethrowsTheLastError) {
    SnapshotWorker worker([](const Snapshot&) { throw std::runtime_error("the disk is full"); });
    submit(worker, 0);
    EXPECT_THROW(worker.finish(), std::runtime_error);
}

TEST(SnapshotWorker, CanBeDestroyedUnfinished) {
    SnapshotWorker worker([](const Snapshot&) { std::this_thread::sleep_for(std::chrono::milliseconds(5)); });
    for (std::int64_t tick = 0; tick < 5; ++tick) submit(worker, tick);
}

}  // namespace
}  // namespace stopline
