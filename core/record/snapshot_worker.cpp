#include "record/snapshot_worker.h"

#include <utility>

namespace stopline {

SnapshotWorker::SnapshotWorker(std::function<void(const Snapshot&)> work) : work_(std::move(work)) {
    for (Snapshot& shot : shots_) blank_.push_back(&shot);
    thread_ = std::thread([this] { run(); });
}

SnapshotWorker::~SnapshotWorker() {
    {
        const std::scoped_lock lock(mutex_);
        due_.clear();
    }
    stop();
}

void SnapshotWorker::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        if (due_.empty()) {
            if (no_more_) return;
            changed_.wait_for(lock, kNap, [this] { return no_more_ || due_.size() >= kManyDue; });
            continue;
        }
        Snapshot* const shot = due_.front();
        due_.pop_front();
        std::exception_ptr error;
        lock.unlock();
        try {
            work_(*shot);
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        blank_.push_back(shot);
        error_ = error;
        changed_.notify_all();
        if (error) return;
    }
}

Snapshot& SnapshotWorker::blank() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !blank_.empty() || error_; });
    rethrow();
    filled_in_ = blank_.back();
    blank_.pop_back();
    return *filled_in_;
}

void SnapshotWorker::submit() {
    bool enough = false;
    {
        const std::scoped_lock lock(mutex_);
        due_.push_back(filled_in_);
        enough = due_.size() == kManyDue;
    }
    if (enough) changed_.notify_all();
}

void SnapshotWorker::finish() {
    stop();
    const std::scoped_lock lock(mutex_);
    rethrow();
}

void SnapshotWorker::stop() {
    {
        const std::scoped_lock lock(mutex_);
        no_more_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void SnapshotWorker::rethrow() {
    if (error_) std::rethrow_exception(error_);
}

}  // namespace stopline
