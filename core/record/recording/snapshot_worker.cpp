#include "record/recording/snapshot_worker.h"

#include <utility>

namespace stopline {

SnapshotWorker::SnapshotWorker(std::function<void(const Snapshot&)> process) : process_(std::move(process)) {
    for (Snapshot& snapshot : snapshots_) free_.push_back(&snapshot);
    thread_ = std::thread([this] { run(); });
}

SnapshotWorker::~SnapshotWorker() {
    {
        const std::scoped_lock lock(mutex_);
        queue_.clear();
    }
    stop();
}

void SnapshotWorker::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        if (queue_.empty()) {
            if (finishing_) return;
            changed_.wait_for(lock, kPollInterval, [this] { return finishing_ || queue_.size() >= kWakeSize; });
            continue;
        }
        Snapshot* const snapshot = queue_.front();
        queue_.pop_front();
        std::exception_ptr error;
        lock.unlock();
        try {
            process_(*snapshot);
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        free_.push_back(snapshot);
        error_ = error;
        changed_.notify_all();
        if (error) return;
    }
}

Snapshot& SnapshotWorker::acquire() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !free_.empty() || error_; });
    rethrow();
    acquired_ = free_.back();
    free_.pop_back();
    return *acquired_;
}

void SnapshotWorker::submit() {
    bool wake = false;
    {
        const std::scoped_lock lock(mutex_);
        queue_.push_back(acquired_);
        wake = queue_.size() == kWakeSize;
    }
    if (wake) changed_.notify_all();
}

void SnapshotWorker::finish() {
    stop();
    const std::scoped_lock lock(mutex_);
    rethrow();
}

void SnapshotWorker::stop() {
    {
        const std::scoped_lock lock(mutex_);
        finishing_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void SnapshotWorker::rethrow() {
    if (error_) std::rethrow_exception(error_);
}

}  // namespace stopline
