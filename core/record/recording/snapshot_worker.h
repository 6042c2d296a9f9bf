// Processes snapshots (copies of the state of a run) in order on a second thread while the run continues.
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
    // Discards the snapshots in the queue, waits until `process` has returned, and ends the thread.
    ~SnapshotWorker();

    // Returns a snapshot to fill in and submit. Waits while all snapshots are in use. If `process` has thrown an
    // exception, acquire() throws it again, and no further snapshot is processed.
    Snapshot& acquire();
    // Puts the acquired snapshot into the queue.
    void submit();
    // Waits until all submitted snapshots are processed. If `process` has thrown an exception, finish() throws it
    // again. Do not call submit() afterwards.
    void finish();

private:
    void run();
    void stop();
    void rethrow();

    // Number of snapshots in memory. The run waits only while all of them are in use, for example if compression is
    // slow.
    static constexpr std::size_t kSnapshots = 24;
    // The worker thread polls the queue every kPollInterval. Waking the thread would cost the run more time than
    // copying a snapshot. So submit() wakes the thread only when the queue has grown to kWakeSize snapshots.
    static constexpr std::chrono::milliseconds kPollInterval{2};
    static constexpr std::size_t kWakeSize = kSnapshots / 2;
    std::array<Snapshot, kSnapshots> snapshots_;
    // Snapshots that are not in use. The snapshot that was processed last is reused first, because its memory is still
    // in the processor's cache.
    std::vector<Snapshot*> free_;
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
