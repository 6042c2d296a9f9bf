#include "record/snapshot_worker.h"

#include <utility>

namespace stopline {

SnapshotWorker::SnapshotWorker(std::function<void(const Snapshot&)> work)
    : work_(std::move(work)), thread_([this] { run(); }) {}

SnapshotWorker::~SnapshotWorker() {
    {
        const std::scoped_lock lock(mutex_);
        submitted_ = done_;
    }
    stop();
}

void SnapshotWorker::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return no_more_ || submitted_ > done_; });
        if (submitted_ == done_) return;
        const Snapshot& shot = shots_[done_ % shots_.size()];
        std::exception_ptr error;
        lock.unlock();
        try {
            work_(shot);
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        if (error) {
            error_ = error;
            done_ = submitted_;
            changed_.notify_all();
            return;
        }
        if (submitted_ > done_) ++done_;
        changed_.notify_all();
    }
}

Snapshot& SnapshotWorker::blank() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return submitted_ - done_ < shots_.size(); });
    rethrow();
    return shots_[submitted_ % shots_.size()];
}

void SnapshotWorker::submit() {
    {
        const std::scoped_lock lock(mutex_);
        ++submitted_;
    }
    changed_.notify_all();
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
