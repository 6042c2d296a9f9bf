// Processes snapshots in order on a second thread while the run continues.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "record/recording/snapshot.h"

namespace stopline {

class SnapshotWorker {
public:
    // Starts the thread, which calls `process` for every submitted snapshot.
    explicit SnapshotWorker(std::function<void(const Snapshot&)> process);
    SnapshotWorker(const SnapshotWorker&) = delete;
    SnapshotWorker& operator=(const SnapshotWorker&) = delete;
    SnapshotWorker(SnapshotWorker&&) = delete;
    SnapshotWorker& operator=(SnapshotWorker&&) = delete;
    // Drops the snapshots that are not processed yet.
    ~SnapshotWorker();

    // Returns a snapshot to fill in and submit. Waits while all snapshots are in the queue. Rethrows an exception of
    // `process`; no further snapshot is processed after it.
    Snapshot& acquire();
    // Puts the acquired snapshot into the queue.
    void submit();
    // Waits until all snapshots are processed. Rethrows an exception of `process`. Submit nothing afterwards.
    void finish();

private:
    void run();
    void stop();
    void rethrow();

    // Enough that the run seldom waits while a section is compressed.
    static constexpr std::size_t kSnapshots = 24;
    // The worker polls the queue. Waking it costs the run more than copying a snapshot, so the run wakes it only when
    // the queue has reached kWakeSize.
    static constexpr std::chrono::milliseconds kPollInterval{2};
    static constexpr std::size_t kWakeSize = kSnapshots / 2;
    std::array<Snapshot, kSnapshots> snapshots_;
    std::vector<Snapshot*> free_;  // the last processed one at the back, because its memory is still in the cache
    Snapshot* acquired_ = nullptr;
    std::deque<Snapshot*> queue_;
    std::function<void(const Snapshot&)> process_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool finishing_ = false;
    std::exception_ptr error_;
    std::thread thread_;
};

}  // namespace stopline
