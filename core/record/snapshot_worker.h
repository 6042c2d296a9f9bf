// A thread that works off snapshots in the order in which they were taken, while the run that they are of goes on.
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

#include "record/snapshot.h"

namespace stopline {

class SnapshotWorker {
public:
    explicit SnapshotWorker(std::function<void(const Snapshot&)> work);
    SnapshotWorker(const SnapshotWorker&) = delete;
    SnapshotWorker& operator=(const SnapshotWorker&) = delete;
    SnapshotWorker(SnapshotWorker&&) = delete;
    SnapshotWorker& operator=(SnapshotWorker&&) = delete;
    // What has been submitted and not worked off is dropped.
    ~SnapshotWorker();

    // One to be filled in and submitted; waits while all are still to be worked off. What the work has thrown comes out here or
    // in finish; nothing is worked on after it.
    Snapshot& blank();
    void submit();
    // Waits until all is done; nothing can be submitted after it.
    void finish();

private:
    void run();
    void stop();
    void rethrow();

    // So many that the run seldom waits while a section is compressed.
    static constexpr std::size_t kShots = 24;
    // The worker looks by itself now and then: waking it costs the run more than the copy of a snapshot does, so it is woken
    // only when so many are due.
    static constexpr std::chrono::milliseconds kNap{2};
    static constexpr std::size_t kManyDue = kShots / 2;
    std::array<Snapshot, kShots> shots_;
    std::vector<Snapshot*> blank_;  // the one worked off last, whose memory is nearest, at the back
    Snapshot* filled_in_ = nullptr;
    std::deque<Snapshot*> due_;
    std::function<void(const Snapshot&)> work_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool no_more_ = false;
    std::exception_ptr error_;
    std::thread thread_;
};

}  // namespace stopline
